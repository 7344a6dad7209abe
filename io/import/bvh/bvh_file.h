// A BVH as it is written: joints in the order of the text, and all numbers of the motion. A joint is its place in the
// hierarchy, so names may repeat and may have blanks. A number's place in the text can be kept, so that one can be
// written over and all others stay as they are spelled.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "baker/core/result.h"
#include "baker/core/types.h"

namespace ft::inline io {

enum class BvhPath { k_position, k_rotation, k_scale };

struct BvhChannel {
  BvhPath path = BvhPath::k_position;
  int axis = 0;  ///< 0, 1, 2: x, y, z
};

struct BvhJoint {
  std::string name;  ///< UTF-8; empty: an end site
  int parent = -1;   ///< -1: a root
  Vec3 offset = Vec3::Zero();
  std::vector<BvhChannel> channels;
  std::size_t first_value = 0;  ///< of its channels in a frame
  int line = 0;                 ///< of its first word, from 1
};

struct BvhFile {
  std::vector<BvhJoint> joints;  ///< in the order of the text, end sites among them
  std::size_t frame_count = 0, values_per_frame = 0;
  double frame_time = 0;                 ///< s; 0 only where there is at most one frame
  std::vector<double> numbers;           ///< frame by frame: lengths, degrees
  std::vector<std::string_view> values;  ///< the same as they are spelled, in the text that was read
  std::vector<std::string> notes;
};

enum class BvhSpelling { k_forget, k_keep };

/// The text has to outlive what is returned where the spelling is kept. Errors name the line, and the joint or frame.
Result<BvhFile> read_bvh(std::string_view text, BvhSpelling spelling = BvhSpelling::k_keep);

}  // namespace ft::inline io
