// What the swing and the child on it agree upon.
#pragma once

namespace ft::sets {

constexpr double k_hop = 0.25, k_seated = 0.85;  ///< s, when the child leaves the ground and when she sits
constexpr double k_let_go = 0.8;                 ///< s, when the swing is free
constexpr double k_pumping = 0.35;               ///< 1/s, growth of the swing's speed while it is small
constexpr double k_rope_side = 0.225;            ///< m, from the middle to a rope

}  // namespace ft::sets
