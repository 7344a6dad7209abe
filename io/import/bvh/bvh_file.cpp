#include "io/import/bvh/bvh_file.h"

#include <fmt/format.h>

#include "io/import/bvh/bvh_words.h"

namespace ft::inline io {
namespace {

/// Beyond these a "Frame Time" is another quantity: frames per second, or milliseconds [s].
constexpr double k_shortest_frame = 1e-4, k_longest_frame = 5;
constexpr std::size_t k_most_channels = 9, k_most_depth = 512, k_most_joints = 20'000, k_most_roots = 64;

Error fault_at(int line, const std::string& what, const std::string& hint = "") {
  return input_error(what, fmt::format("line {}", line), hint);
}

/// A word in a message: what a damaged file has there can be long.
std::string quoted(std::string_view word) {
  return word.empty() ? "the end of the file" : fmt::format("\"{}\"", utf8_name(word.substr(0, 40)));
}

class HierarchyReader {
 public:
  HierarchyReader(BvhWords& words, BvhFile& out) : words_(words), out_(out) {}

  Status read() {
    if (const auto word = words_.next(); !is_keyword(word, "hierarchy"))
      return fault("does not begin with HIERARCHY, but with " + quoted(word));
    for (std::string_view word = words_.next(); !is_keyword(word, "motion"); word = words_.next())
      if (Status s = read_word(word); !s) return s;
    if (!open_.empty()) return fault(joint_text() + " is not closed before MOTION");
    if (out_.joints.empty()) return fault("has no joint");
    int bare = 0;
    for (const char has : has_offset_) bare += has == 0;
    if (bare > 0) out_.notes.push_back(fmt::format("{} joints have no OFFSET; 0 is taken", bare));
    return {};
  }

 private:
  Error fault(const std::string& what, const std::string& hint = "") const {
    return fault_at(words_.line(), what, hint);
  }
  BvhJoint& top() { return out_.joints[at(open_.back())]; }
  bool in_end_site() { return !open_.empty() && top().name.empty(); }
  std::string joint_text() {
    return in_end_site() ? "the end site below joint \"" + out_.joints[at(top().parent)].name + "\""
                         : "joint \"" + top().name + "\"";
  }

  Status read_word(std::string_view word) {
    if (word == "}") {
      if (open_.empty()) return fault("has a \"}\" that closes nothing");
      open_.pop_back();
      return {};
    }
    const bool end_site = is_keyword(word, "end") || is_keyword(word, "endsite") || is_keyword(word, "end_site");
    if (is_keyword(word, open_.empty() ? "root" : "joint") || (end_site && !open_.empty())) return open_joint(end_site);
    if (!open_.empty() && is_keyword(word, "offset")) return read_offset();
    if (!open_.empty() && is_keyword(word, "channels")) return read_channels();
    if (word.empty()) return fault(open_.empty() ? "ends without MOTION" : "ends within " + joint_text());
    return fault(quoted(word) + " where a joint should be");
  }

  Status open_joint(bool end_site) {
    if (in_end_site()) return fault(joint_text() + " has a joint below it");
    if (open_.empty() && ++root_count_ > k_most_roots)
      return fault(fmt::format("has more than {} skeletons (ROOT)", k_most_roots));
    if (out_.joints.size() >= k_most_joints || open_.size() >= k_most_depth)
      return fault(fmt::format("has more than {} joints, or more than {} of them one below the other", k_most_joints,
                               k_most_depth));
    BvhJoint joint;
    joint.line = words_.line();
    joint.parent = open_.empty() ? -1 : open_.back();
    joint.first_value = out_.values_per_frame;
    const std::string_view name = words_.rest_of_line();
    std::string_view brace = words_.next();
    if (end_site && is_keyword(brace, "site")) brace = words_.next();
    if (!end_site && name.empty())
      return fault_at(joint.line, fmt::format("a {} has no name", joint.parent < 0 ? "ROOT" : "JOINT"));
    if (!end_site) joint.name = utf8_name(name);
    out_.joints.push_back(std::move(joint));
    has_offset_.push_back(0), has_channels_.push_back(0);
    open_.push_back(static_cast<int>(out_.joints.size()) - 1);
    if (brace != "{") return fault(joint_text() + " does not begin with \"{\", but with " + quoted(brace));
    return {};
  }

  Status read_offset() {
    if (has_offset_[at(open_.back())]++ != 0) return fault(joint_text() + " has a second OFFSET");
    for (int k = 0; k < 3; ++k)
      if (const auto word = words_.next(); !read_number(word, top().offset[k]))
        return fault(fmt::format("{}: its OFFSET has {} where a number should be", joint_text(), quoted(word)));
    return {};
  }

  Status read_channels() {
    if (in_end_site()) return fault(joint_text() + " has channels");
    if (has_channels_[at(open_.back())]++ != 0) return fault(joint_text() + " has a second list of channels");
    std::size_t count = 0;
    if (!read_number(words_.next(), count) || count > k_most_channels)
      return fault(fmt::format("{} has no number of channels from 0 to {}", joint_text(), k_most_channels));
    for (std::size_t c = 0; c < count; ++c) {
      const std::string_view word = words_.next();
      BvhChannel channel;
      const char axis = word.empty() ? '\0' : static_cast<char>(word[0] | 0x20);
      const std::string_view path = word.empty() ? word : word.substr(1);
      channel.axis = axis - 'x';
      channel.path = is_keyword(path, "rotation") ? BvhPath::k_rotation
                     : is_keyword(path, "scale")  ? BvhPath::k_scale
                                                  : BvhPath::k_position;
      if (channel.axis < 0 || channel.axis > 2 ||
          (channel.path == BvhPath::k_position && !is_keyword(path, "position")))
        return fault(fmt::format("{}: {} is no channel", joint_text(), quoted(word)));
      for (const BvhChannel& other : top().channels)
        if (other.path == channel.path && other.axis == channel.axis && channel.path != BvhPath::k_rotation)
          return fault(fmt::format("{} has the channel {} twice", joint_text(), quoted(word)));
      top().channels.push_back(channel);
    }
    out_.values_per_frame += count;
    return {};
  }

  BvhWords& words_;
  BvhFile& out_;
  std::vector<int> open_;  // into joints
  std::vector<char> has_offset_, has_channels_;
  std::size_t root_count_ = 0;
};

Status read_header(BvhWords& words, BvhFile& out) {
  if (const auto word = words.next_before_colon();
      !is_keyword(word, "frames") || !read_number(words.next_before_colon(), out.frame_count))
    return fault_at(words.line(), "has no number of frames behind MOTION");
  const std::string_view word = words.next_before_colon();
  const bool named =
      is_keyword(word, "frametime") || (is_keyword(word, "frame") && is_keyword(words.next_before_colon(), "time"));
  if (!named || !read_number(words.next_before_colon(), out.frame_time))
    return fault_at(words.line(), "has no frame time behind its number of frames");
  const double time = out.frame_time;
  if (time >= k_shortest_frame && time <= k_longest_frame) return {};
  if (out.frame_count <= 1 && !(time < 0)) {
    out.frame_time = 0;
    return {};
  }
  const bool rate = time > k_longest_frame && time <= 1 / k_shortest_frame;
  return fault_at(
      words.line(),
      fmt::format("has no usable frame time: {} s, of {} to {} s", time, k_shortest_frame, k_longest_frame),
      rate ? fmt::format("it is the time from frame to frame: {} frames per second are written {:.7g}", time, 1 / time)
           : "30 frames per second are written 0.0333333");
}

/// Which joint's channel a value of a frame is for.
std::string channel_text(const BvhFile& file, std::size_t value) {
  for (const BvhJoint& joint : file.joints)
    if (value >= joint.first_value && value < joint.first_value + joint.channels.size())
      return fmt::format("joint \"{}\", channel {}", joint.name, value - joint.first_value + 1);
  return "no joint";
}

Status read_motion(BvhWords& words, BvhFile& out, BvhSpelling spelling, std::size_t most_numbers) {
  const std::size_t width = out.values_per_frame;
  if (width > 0 && out.frame_count < most_numbers / width + 1) {
    out.numbers.reserve(out.frame_count * width);
    if (spelling == BvhSpelling::k_keep) out.values.reserve(out.frame_count * width);
  }
  // Lines are frames in nearly all files. Where they are, the line that does not have a frame's numbers is named.
  std::size_t line_count = 0, line_start = 0, odd_size = 0;
  int line = 0, odd_line = 0;
  const auto end_line = [&] {
    const std::size_t size = out.numbers.size() - line_start;
    if (line_count > 0 && size != width && odd_line == 0) odd_line = line, odd_size = size;
  };
  const auto odd_fault = [&](const std::string& else_what) {
    if (odd_line == 0 || line_count * width > 2 * out.numbers.size()) return fault_at(words.line(), else_what);
    return fault_at(odd_line, fmt::format("has {} numbers, and a frame has {} ({})", odd_size, width, else_what));
  };
  std::size_t frame = 0, value = 0;
  for (;;) {
    const std::string_view word = words.next_number();
    if (word.empty()) break;
    if (words.line() != line) end_line(), line = words.line(), line_start = out.numbers.size(), ++line_count;
    double number = 0;
    if (!read_number(word, number)) {
      const bool comma = word.find(',') != std::string_view::npos;
      return fault_at(
          line, fmt::format("frame {}, {}: {} is no finite number", frame, channel_text(out, value), quoted(word)),
          comma ? "numbers are written with a point and parted by blanks" : "");
    }
    if (width == 0 || out.frame_count == 0)
      return fault_at(line, fmt::format("more numbers than its {} frames of {} have", out.frame_count, width));
    out.numbers.push_back(number);
    if (spelling == BvhSpelling::k_keep) out.values.push_back(word);
    if (++value == width) ++frame, value = 0;
  }
  end_line();
  if (width > 0 && frame < out.frame_count)
    return odd_fault(fmt::format("the file ends in frame {}, after {} of its {} numbers; {} frames were announced",
                                 frame, value, width, out.frame_count));
  if (frame > out.frame_count || (frame == out.frame_count && value > 0)) {
    if (value > 0) return odd_fault(fmt::format("more numbers than its {} frames of {} have", out.frame_count, width));
    out.notes.push_back(
        fmt::format("holds {} frames and announces {}; those beyond are left out", frame, out.frame_count));
    out.numbers.resize(out.frame_count * width);
    if (spelling == BvhSpelling::k_keep) out.values.resize(out.frame_count * width);
  }
  if (odd_line > 0 && line_count == frame) return odd_fault("the frames' numbers are shifted");
  return {};
}

Status check_encoding(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 1; };
  const bool marked = (byte(0) == 0xff && byte(1) == 0xfe) || (byte(0) == 0xfe && byte(1) == 0xff);
  if (marked || byte(0) == 0 || byte(1) == 0)
    return input_error("is in UTF-16 or UTF-32", "", "save it as UTF-8 or plain ASCII");
  return {};
}

}  // namespace

Result<BvhFile> read_bvh(std::string_view text, BvhSpelling spelling) {
  if (Status s = check_encoding(text); !s) return s.error();
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  while (!text.empty() && (text.back() == '\0' || text.back() == '\x1a')) text.remove_suffix(1);  // ends of old files
  BvhFile out;
  BvhWords words(text);
  if (Status s = HierarchyReader(words, out).read(); !s) return s.error();
  if (Status s = read_header(words, out); !s) return s.error();
  if (Status s = read_motion(words, out, spelling, text.size() / 2 + 1); !s) return s.error();
  return out;
}

}  // namespace ft::inline io
