#include "io/shot/ranges.h"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include "io/shot/words.h"

namespace ft::inline io {
namespace {

constexpr long long k_last_frame = 9'999'999;
constexpr std::size_t k_most_vertices = 20'000'000;

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && (s.front() == ' ' || s.front() == '\t')) s.remove_prefix(1);
  while (!s.empty() && (s.back() == ' ' || s.back() == '\t')) s.remove_suffix(1);
  return s;
}

bool whole(std::string_view s, long long& out) {
  s = trimmed(s);
  const auto [end, fault] = std::from_chars(s.data(), s.data() + s.size(), out);
  return !s.empty() && fault == std::errc{} && end == s.data() + s.size();
}

/// Cuts "A-B" at the first of '-', ':', ".." that is not a sign; second is empty for a single number.
void cut_range(std::string_view s, std::string_view& first, std::string_view& second, bool& has_second) {
  s = trimmed(s);
  const std::size_t dash = s.find('-', 1), colon = s.find(':'), dots = s.find("..");
  const std::size_t cut = std::min({dash, colon, dots});
  has_second = cut != std::string_view::npos;
  first = s.substr(0, cut);
  if (has_second) second = s.substr(cut + (cut == dots ? 2 : 1));
}

std::string range_of(long long a, long long b) {
  return std::to_string(a).append("-").append(std::to_string(b));
}

}  // namespace

bool parse_frames(std::string_view text, FrameRange& range, std::string& fault) {
  std::string_view first, second;
  bool has_second = false;
  cut_range(text, first, second, has_second);
  long long a = 0, b = 0;
  if (!whole(first, a) || (has_second && !whole(second, b))) {
    fault = "is not a frame range; write \"1001-1121\" or one frame";
    return false;
  }
  if (!has_second) b = a;
  if (a < 0 || b < 0) {
    fault = "has a negative frame; frames count from 0, a run-up before the first frame is written preroll = ";
    fault.append(std::to_string(std::min<long long>(-std::min(a, b), 1000)));
    return false;
  }
  if (a > k_last_frame || b > k_last_frame) {
    fault = "is outside [0, 9999999]";
    return false;
  }
  if (b < a) {
    fault = std::string("runs backwards (").append(range_of(b, a)).append("?)");
    return false;
  }
  range = {static_cast<int>(a), static_cast<int>(b)};
  return true;
}

bool parse_vertices(std::string_view text, std::vector<int>& out, std::string& fault) {
  out.clear();
  while (true) {
    const std::size_t comma = text.find(',');
    const std::string_view part = trimmed(text.substr(0, comma));
    std::string_view first, second;
    bool has_second = false;
    cut_range(part, first, second, has_second);
    long long a = 0, b = 0;
    if (!whole(first, a) || (has_second && !whole(second, b))) {
      fault =
          std::string("has \"").append(printable(part, 24)).append("\" where a vertex or a range like 0-199 belongs");
      return false;
    }
    if (!has_second) b = a;
    if (a < 0 || b < a || b > 2'000'000'000) {
      fault = std::string("has \"").append(printable(part, 24));
      fault.append(b < a ? "\", which runs backwards" : "\"; vertices count from 0");
      return false;
    }
    if (out.size() + static_cast<std::size_t>(b - a + 1) > k_most_vertices) {
      fault = "names more than 20 million vertices";
      return false;
    }
    for (long long v = a; v <= b; ++v) out.push_back(static_cast<int>(v));
    if (comma == std::string_view::npos) break;
    text.remove_prefix(comma + 1);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return true;
}

std::string frames_text(const FrameRange& range) {
  return range.first == range.last ? std::to_string(range.first) : range_of(range.first, range.last);
}

std::string vertices_text(const std::vector<int>& ascending) {
  std::string out;
  for (std::size_t i = 0, end = 0; i < ascending.size(); i = end) {
    end = i + 1;
    while (end < ascending.size() && ascending[end] == ascending[end - 1] + 1) ++end;
    if (!out.empty()) out.append(", ");
    out.append(frames_text({ascending[i], ascending[end - 1]}));
  }
  return out;
}

}  // namespace ft::inline io
