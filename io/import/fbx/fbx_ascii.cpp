// FBX as text: `Name: value, value { children }`, arrays as `*count { a: 1,2,3 }`, comments from ";" to the line's end.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "io/import/fbx/fbx_tree.h"

namespace ft::inline io {
namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_word(char c) {
  return is_letter(c) || is_digit(c) || c == '-' || c == '(' || c == ')' || c == '|' || c == '.';
}
bool starts_number(char c) {
  return is_digit(c) || c == '-' || c == '+' || c == '.';
}

/// "inf", "nan" and what old runtime libraries print for them: 1.#INF, -1.#IND, 1.#QNAN, nan(ind).
double odd_number(std::string_view word) {
  std::string low;
  for (const char c : word) low += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  const double sign = low.starts_with('-') ? -1 : 1;
  return low.find("inf") != std::string::npos ? sign * std::numeric_limits<double>::infinity()
                                              : std::numeric_limits<double>::quiet_NaN();
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  std::string out;
  std::size_t done = 0;
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, done)) {
    out.append(text, done, at - done).append(to);
    done = at + from.size();
  }
  if (done > 0) text = out.append(text, done);
}

class TextParser {
 public:
  explicit TextParser(std::string_view text) : text_(text) {}

  Status read_children(FbxNode& parent, int depth) {
    for (;;) {
      skip_space();
      if (at_end()) return depth == 0 ? Status{} : Status{cut(parent)};
      if (peek() == '}') {
        if (depth == 0) return damaged("a \"}\" too many");
        ++at_;
        return {};
      }
      FbxNode node;
      if (Status s = read_name(node.name); !s) return s;
      if (depth >= k_max_fbx_depth) return damaged("nodes are more than " + std::to_string(k_max_fbx_depth) + " deep");
      if (Status s = read_values(node); !s) return s;
      skip_space();
      if (!at_end() && peek() == '{') {
        ++at_;
        if (Status s = read_children(node, depth + 1); !s) return s;
      }
      if (!is_fbx_decoration(node.name)) parent.children.push_back(std::move(node));
    }
  }

 private:
  bool at_end() const { return at_ >= text_.size(); }
  char peek() const { return text_[at_]; }

  void skip_space() {
    while (!at_end()) {
      if (is_space(peek()))
        ++at_;
      else if (peek() == ';')
        at_ = std::min(text_.find('\n', at_), text_.size());
      else
        break;
    }
  }

  Error damaged(const std::string& what) const {
    const auto before = text_.substr(0, at_);
    return input_error(
        "is damaged: " + what + " in line " + std::to_string(1 + std::count(before.begin(), before.end(), '\n')), "",
        "copy or export it again");
  }
  static Error cut(const FbxNode& node) {
    return input_error("is cut: the end of node \"" + node.name + "\" is missing", "", "copy or export it again");
  }

  Status read_name(std::string& name) {
    if (peek() == '"') {
      if (Status s = read_string(name); !s) return s;
    } else if (is_letter(peek()) || is_digit(peek())) {
      const std::size_t start = at_;
      while (!at_end() && is_word(peek())) ++at_;
      name = text_.substr(start, at_ - start);
    } else {
      return damaged("a node's name is expected");
    }
    skip_space();
    if (at_end() || peek() != ':') return damaged("\":\" is missing behind \"" + name + "\"");
    ++at_;
    return {};
  }

  Status read_values(FbxNode& node) {
    skip_space();
    if (!at_end() && peek() == ',') ++at_;  // `Content: , "..."`
    for (;;) {
      skip_space();
      if (at_end()) return {};
      const char c = peek();
      if (c == '"') {
        std::string text;
        if (Status s = read_string(text); !s) return s;
        node.properties.emplace_back(std::move(text));
      } else if (c == '*') {
        if (Status s = read_array(node); !s) return s;
      } else if (starts_number(c)) {
        std::int64_t whole = 0;
        double value = 0;
        bool is_whole = false;
        if (!read_number(whole, value, is_whole)) return damaged("a number cannot be read");
        if (is_whole)
          node.properties.emplace_back(whole);
        else
          node.properties.emplace_back(value);
      } else if (is_letter(c)) {
        const std::size_t start = at_;
        while (!at_end() && is_word(peek())) ++at_;
        const std::string_view word = text_.substr(start, at_ - start);
        skip_space();
        if (!at_end() && peek() == ':') {  // no value: the next node begins
          at_ = start;
          return {};
        }
        // A bare letter (T, Y, W, L) stands for itself; "inf" and "nan" for numbers.
        if (word.size() > 1 && (word[0] == 'i' || word[0] == 'I' || word[0] == 'n' || word[0] == 'N'))
          node.properties.emplace_back(odd_number(word));
        else
          node.properties.emplace_back(static_cast<std::int64_t>(word[0]));
      } else {
        return {};
      }
      skip_space();
      if (at_end() || peek() != ',') return {};
      ++at_;
    }
  }

  Status read_string(std::string& out) {
    const std::size_t close = text_.find('"', at_ + 1);
    if (close == std::string_view::npos) {
      at_ = std::min(at_ + 1, text_.size());
      return damaged("a text is not closed");
    }
    out = text_.substr(at_ + 1, close - at_ - 1);
    at_ = close + 1;
    if (out.find('&') != std::string::npos)
      for (const auto& [code, letter] : {std::pair{"&quot;", "\""}, {"&cr;", "\r"}, {"&lf;", "\n"}})
        replace_all(out, code, letter);
    return {};
  }

  /// Whole numbers stay whole; what is larger than 64 bits becomes a fraction.
  bool read_number(std::int64_t& whole, double& value, bool& is_whole) {
    const char* begin = text_.data() + at_;
    const char* end = text_.data() + text_.size();
    if (*begin == '+') ++begin;
    if (begin == end) return false;
    auto result = std::from_chars(begin, end, whole);
    const bool goes_on = result.ptr < end && (*result.ptr == '.' || *result.ptr == 'e' || *result.ptr == 'E' ||
                                              *result.ptr == '#' || is_letter(*result.ptr));
    const bool minus_zero = whole == 0 && *begin == '-';
    is_whole = result.ec == std::errc() && !goes_on && !minus_zero;
    if (!is_whole) {
      value = 0;
      result = std::from_chars(begin, end, value);
      if (result.ec == std::errc::result_out_of_range)
        value = std::strtod(std::string(begin, result.ptr).c_str(), nullptr);
      if (result.ptr < end && result.ptr != begin &&
          (is_letter(*result.ptr) || *result.ptr == '#' || *result.ptr == '(')) {
        const char* stop = begin;
        while (stop < end && (is_word(*stop) || *stop == '#' || *stop == '+')) ++stop;
        value = odd_number({begin, static_cast<std::size_t>(stop - begin)});
        result.ptr = stop;
      }
    }
    if (result.ptr == begin) return false;
    at_ = static_cast<std::size_t>(result.ptr - text_.data());
    return true;
  }

  /// `*count { a: 1,2,3 }`; the count is not needed, and not believed.
  Status read_array(FbxNode& node) {
    ++at_;
    std::int64_t claimed = 0;
    double value = 0;
    bool is_whole = false;
    skip_space();
    if (at_end() || !starts_number(peek()) || !read_number(claimed, value, is_whole))
      return damaged("an array has no count");
    skip_space();
    if (at_end() || peek() != '{') {
      node.properties.emplace_back(std::vector<std::int64_t>{});
      return {};
    }
    ++at_;
    skip_space();
    if (!at_end() && is_letter(peek())) {
      std::string name;
      if (Status s = read_name(name); !s) return s;
    }
    const bool kept = !is_fbx_decoration(node.name);
    std::vector<std::int64_t> wholes;
    std::vector<double> numbers;
    bool fraction = false;
    // What the claim says is a good guess where the text that is left could hold it.
    if (kept && claimed > 0 && static_cast<std::uint64_t>(claimed) <= (text_.size() - at_) / 2)
      wholes.reserve(static_cast<std::size_t>(claimed));
    for (;;) {
      skip_space();
      if (at_end()) return cut(node);
      if (peek() == '}') break;
      std::int64_t whole = 0;
      if (starts_number(peek())) {
        if (!read_number(whole, value, is_whole)) return damaged("a number cannot be read");
      } else if (is_letter(peek())) {
        const std::size_t start = at_;
        while (!at_end() && is_word(peek())) ++at_;
        value = odd_number(text_.substr(start, at_ - start)), is_whole = false;
      } else if (peek() == '"') {
        std::string ignored;
        if (Status s = read_string(ignored); !s) return s;
        whole = 0, is_whole = true;
      } else {
        return damaged("a number is expected");
      }
      if (kept) {
        if (!is_whole && !fraction) {
          fraction = true;
          numbers.reserve(wholes.capacity());
          numbers.assign(wholes.begin(), wholes.end());
          wholes = {};
        }
        if (fraction)
          numbers.push_back(is_whole ? static_cast<double>(whole) : value);
        else
          wholes.push_back(whole);
      }
      skip_space();
      if (!at_end() && peek() == ',') ++at_;
    }
    ++at_;
    if (fraction)
      node.properties.emplace_back(std::move(numbers));
    else
      node.properties.emplace_back(std::move(wholes));
    return {};
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

/// From the comment in the first line: "; FBX 7.4.0 project file"; 0 when there is none.
int version_of_comment(std::string_view text) {
  const std::size_t at = text.substr(0, 200).find("FBX ");
  if (!text.starts_with(';') || at == std::string_view::npos) return 0;
  int major = 0, minor = 0;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data() + at + 4, end, major);
  if (first.ec != std::errc() || major > 99 || first.ptr >= end || *first.ptr != '.') return 0;
  std::from_chars(first.ptr + 1, end, minor);
  return 1000 * major + 100 * std::min(std::max(minor, 0), 9);
}

}  // namespace

Result<FbxTree> read_fbx_text(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  FbxTree tree;
  tree.text = true;
  tree.version = version_of_comment(text);
  if (tree.version > 0 && tree.version < 7000) return old_fbx_error(tree.version);
  if (Status s = TextParser(text).read_children(tree.root, 0); !s) return s.error();
  if (const FbxNode* header = tree.root.child("FBXHeaderExtension"); header != nullptr && tree.version == 0)
    if (const FbxNode* version = header->child("FBXVersion"); version != nullptr)
      tree.version = static_cast<int>(std::min<std::int64_t>(fbx_integer(*version, 0), 99'999));
  if (tree.version > 0 && tree.version < 7000) return old_fbx_error(tree.version);
  if (tree.version == 0) tree.version = 7400;  // it says nothing: what most programs write
  return tree;
}

}  // namespace ft::inline io
