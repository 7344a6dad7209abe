// Where bodies were, from the start of the pre-roll on: what leaves a wake. Known before the first frame.
#pragma once

#include <string>
#include <vector>

#include "baker/core/result.h"
#include "baker/core/trajectory.h"
#include "baker/core/types.h"

namespace ft::inline solvers {

struct BodyPath {
  std::string name;
  double drag_area = 0;          ///< C_d A [m2]
  std::vector<Vec3> centres;     ///< at each sample [m]
  std::vector<Vec3> velocities;  ///< at each sample [m/s]
};

class BodyPaths {
 public:
  /// Every path has as many samples; at least two. first_time: of the first [s from the shot's first frame].
  BodyPaths(std::vector<BodyPath> paths, double first_time, double interval);

  const std::vector<BodyPath>& paths() const { return paths_; }
  double first_time() const { return first_time_; }
  double interval() const { return interval_; }
  int samples() const { return static_cast<int>(paths_.front().centres.size()); }
  double time_of(int sample) const { return first_time_ + sample * interval_; }
  /// Between samples linear; before the first and after the last it stands.
  Vec3 centre(const BodyPath& path, double time) const;
  Vec3 velocity(const BodyPath& path, double time) const;
  double fastest() const { return fastest_; }  ///< m/s

 private:
  std::vector<BodyPath> paths_;
  double first_time_ = 0, interval_ = 1, fastest_ = 0;
};

struct PathRequest {
  double first_time = 0, last_time = 0;  ///< s from the shot's first frame
  double fps = 24;                       ///< two samples a frame
  std::vector<double> jumps;             ///< times at which the body is set down somewhere else: no velocity there [s]
  std::vector<int> parts;                ///< of the surface; empty: all
  double drag_area = 0;                  ///< of all together [m2]; 0: from their surfaces
};

/// Of the parts of a body. A part's drag area is, unless it is given, C_d = 1 times a fourth of its surface: what a
/// convex body shows on the average of all directions (Cauchy). The centre is that of its surface.
/// Usage error: the parts have no surface.
Result<BodyPaths> paths_of(const Trajectory& body, const PathRequest& request);

}  // namespace ft::inline solvers
