// [follow.NAME] of the shot file: what jiggles without a solver.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/shot/secondary.h"

namespace ft::inline baker {

struct FollowSpec final : SecondarySpec {
  std::vector<std::string> bones;  ///< patterns (* and ?) of joints that turn
  std::filesystem::path weights;   ///< or vertices that are displaced: a number from 0 to 1 for each of the primary's
  std::string column;              ///< of `weights`; empty: the only one
  double frequency = 3;            ///< of the spring [Hz]
  double damping_ratio = 0.3;      ///< 1: back without overshoot
  double amount = 1;               ///< of the lag that is taken on [1]
  double max_angle = 60;           ///< of a joint, from the animation [degrees]
  double max_distance = 0.1;       ///< of vertices, from the animation [m]
};

}  // namespace ft::inline baker
