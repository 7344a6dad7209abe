#include "io/shot/words.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace ft::inline io {
namespace {

std::string folded(std::string_view word) {
  std::string out(word);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (c == '-' || c == ' ') c = '_';
  }
  return out;
}

}  // namespace

int edit_distance(std::string_view a_text, std::string_view b_text) {
  const std::string a = folded(a_text.substr(0, 64)), b = folded(b_text.substr(0, 64));
  // Three rows of the usual table: two back, one back, now.
  std::vector<int> two_back(b.size() + 1), back(b.size() + 1), now(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) back[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int same = a[i - 1] == b[j - 1] ? 0 : 1;
      now[j] = std::min({back[j] + 1, now[j - 1] + 1, back[j - 1] + same});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        now[j] = std::min(now[j], two_back[j - 2] + 1);
    }
    two_back.swap(back);
    back.swap(now);
  }
  return back[b.size()];
}

std::string nearest_word(std::string_view word, std::span<const std::string> candidates) {
  const std::string* best = nullptr;
  int best_distance = 1 + std::max(1, static_cast<int>(word.size()) / 3);
  for (const std::string& candidate : candidates) {
    const int distance = edit_distance(word, candidate);
    if (distance < best_distance && distance < static_cast<int>(std::max(word.size(), candidate.size())))
      best = &candidate, best_distance = distance;
  }
  if (best != nullptr) return *best;
  const std::string wanted = folded(word);
  if (wanted.size() >= 3)
    for (const std::string& candidate : candidates) {
      const std::string c = folded(candidate);
      if (c.size() >= 3 && (c.find(wanted) != std::string::npos || wanted.find(c) != std::string::npos))
        return candidate;
    }
  return {};
}

std::string suggestion(std::string_view word, std::span<const std::string> candidates) {
  if (candidates.empty()) return {};
  const std::string near = nearest_word(word, candidates);
  if (!near.empty()) return "did you mean \"" + near + "\"?";
  const std::size_t shown = std::min<std::size_t>(candidates.size(), 24);
  return "known: " + joined(candidates.first(shown)) + (candidates.size() > shown ? ", ..." : "");
}

bool matches(std::string_view pattern, std::string_view word) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  // Where the last star was, and the end of what it has swallowed.
  std::size_t p = 0, w = 0, star = std::string_view::npos, swallowed = 0;
  while (w < word.size()) {
    if (p < pattern.size() && pattern[p] == '*')
      star = p++, swallowed = w;
    else if (p < pattern.size() && (pattern[p] == '?' || lower(pattern[p]) == lower(word[w])))
      ++p, ++w;
    else if (star != std::string_view::npos)
      p = star + 1, w = ++swallowed;
    else
      return false;
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

std::string joined(std::span<const std::string> words, std::string_view separator) {
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) out.append(separator);
    out.append(words[i]);
  }
  return out;
}

std::string printable(std::string_view text, std::size_t longest) {
  std::string out;
  for (const char c : text.substr(0, longest)) out.push_back(static_cast<unsigned char>(c) < 32 || c == 127 ? '?' : c);
  if (text.size() > longest) out.append("...");
  return out;
}

std::string number_text(double value) {
  char digits[48];
  const double size = std::abs(value);
  if (value == 0 || (size >= 1e-4 && size < 1e7)) {
    const auto end = std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed).ptr;
    return {digits, end};
  }
  std::string out(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
  // 1e+06 is written 1e6, 1e-06 is written 1e-6.
  const std::size_t e = out.find('e');
  if (e == std::string::npos) return out;
  if (out[e + 1] == '+') out.erase(e + 1, 1);
  const std::size_t first = out[e + 1] == '-' ? e + 2 : e + 1;
  while (first + 1 < out.size() && out[first] == '0') out.erase(first, 1);
  return out;
}

}  // namespace ft::inline io
