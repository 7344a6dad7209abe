// A BVH as text with its numbers found: which joint each is for, and where it stands, so that one number can be written
// over and all others stay as they are spelled.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "baker/core/result.h"

namespace ft::inline io {

struct BvhChannel {
  bool is_rotation = false;
  int axis = 0;  ///< 0, 1, 2: x, y, z
};

struct BvhJoint {
  std::string name;  ///< empty: an end site
  std::vector<BvhChannel> channels;
  std::size_t first_value = 0;  ///< of its channels in a frame
};

struct BvhFile {
  std::vector<BvhJoint> joints;  ///< in the order of the text, end sites among them
  std::size_t frame_count = 0, values_per_frame = 0;
  double frame_time = 0;                 ///< s
  std::vector<std::string_view> values;  ///< frame by frame, in the text that was read
};

/// The text has to outlive what is returned. Errors name the joint or the frame.
Result<BvhFile> read_bvh(std::string_view text);

}  // namespace ft::inline io
