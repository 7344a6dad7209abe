#include "io/export/bvh_file.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace ft::inline io {
namespace {

constexpr std::string_view k_blank = " \t\r\n\v\f";

class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}
  /// The next word; empty at the end.
  std::string_view next() {
    const std::size_t begin = text_.find_first_not_of(k_blank, at_);
    if (begin == std::string_view::npos) return at_ = text_.size(), std::string_view();
    at_ = std::min(text_.find_first_of(k_blank, begin), text_.size());
    return text_.substr(begin, at_ - begin);
  }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

template <class T>
bool parse(std::string_view word, T& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  return fault == std::errc() && end == word.data() + word.size();
}

Result<BvhChannel> channel(std::string_view word) {
  BvhChannel out;
  out.axis = word.empty() ? -1 : word[0] - 'X';
  out.is_rotation = word.ends_with("rotation");
  if (out.axis < 0 || out.axis > 2 || word.substr(1) != (out.is_rotation ? "rotation" : "position"))
    return input_error(fmt::format("\"{}\" is no channel", word));
  return out;
}

Result<BvhJoint> read_joint(Words& words, std::string_view kind, std::size_t first_value) {
  BvhJoint joint;
  const std::string_view name = words.next();
  const std::string where = fmt::format("joint \"{}\"", name);
  const bool end_site = kind == "End";
  if (!end_site) joint.name = name;
  joint.first_value = first_value;
  double offset = 0;
  bool good = words.next() == "{" && words.next() == "OFFSET";
  for (int k = 0; k < 3; ++k) good = parse(words.next(), offset) && good;
  if (!good) return input_error("does not begin with \"{ OFFSET\" and three numbers", where);
  if (end_site) return joint;
  int count = 0;
  if (words.next() != "CHANNELS" || !parse(words.next(), count) || count < 0 || count > 6)
    return input_error("has no list of up to six channels", where);
  for (int c = 0; c < count; ++c) {
    auto read = channel(words.next());
    if (!read) return input_error(read.error().what, where);
    joint.channels.push_back(*read);
  }
  return joint;
}

}  // namespace

Result<BvhFile> read_bvh(std::string_view text) {
  BvhFile out;
  Words words(text);
  if (words.next() != "HIERARCHY") return input_error("does not begin with HIERARCHY");
  int depth = 0;
  for (std::string_view word = words.next(); word != "MOTION"; word = words.next()) {
    if (word == "}" && depth > 0) {
      --depth;
      continue;
    }
    if (word != (depth == 0 ? "ROOT" : "JOINT") && (word != "End" || depth == 0))
      return input_error(fmt::format("\"{}\" where a joint should be", word));
    auto joint = read_joint(words, word, out.values_per_frame);
    if (!joint) return joint.error();
    out.values_per_frame += joint->channels.size();
    out.joints.push_back(std::move(*joint));
    ++depth;
  }
  if (depth != 0 || out.joints.empty()) return input_error("a joint is not closed, or there is none");
  if (words.next() != "Frames:" || !parse(words.next(), out.frame_count)) return input_error("has no number of frames");
  if (words.next() != "Frame" || words.next() != "Time:" || !parse(words.next(), out.frame_time) ||
      !(out.frame_time > 0) || !std::isfinite(out.frame_time))
    return input_error("has no frame time above 0");
  if (out.values_per_frame > 0 && out.frame_count > text.size() / out.values_per_frame)
    return input_error("has not as many numbers as its " + std::to_string(out.frame_count) + " frames need");
  out.values.reserve(out.frame_count * out.values_per_frame);
  for (std::size_t v = 0; v < out.frame_count * out.values_per_frame; ++v) {
    out.values.push_back(words.next());
    double value = 0;
    if (!parse(out.values.back(), value) || !std::isfinite(value))
      return input_error(fmt::format("\"{}\" is no number", out.values.back()),
                         fmt::format("frame {}", v / out.values_per_frame));
  }
  return out;
}

}  // namespace ft::inline io
