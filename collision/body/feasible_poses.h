// The feasible collider of a moving body, which remembers the poses that it is asked to keep: the clip is searched for
// room before the bake, and the bake meets the same poses at the end of every frame.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "baker/core/trajectory.h"
#include "collision/body/feasible_collider.h"

namespace ft::inline collision {

class FeasiblePoses {
 public:
  /// Keeps no more than `most_bytes`: hours of what carving moves, not of whole poses.
  FeasiblePoses(std::shared_ptr<const Trajectory> body, const FeasibleSettings& settings,
                std::size_t most_bytes = 64 << 20);

  const Trajectory& body() const { return *body_; }
  const FeasibleSettings& settings() const { return settings_; }
  const FeasibleCollider& collider() const { return collider_; }

  /// The collider at `time` [s], from the body as drawn then. Costs a refinement where it was kept. Thread-safe.
  /// absent: as FeasibleCollider's.
  CarveReport evaluate(double time, std::span<const Vec3> drawn, std::span<Vec3> positions,
                       std::span<char> absent = {}) const;
  /// As evaluate(), and keeps what was carved, while there is room for it.
  CarveReport keep(double time, std::span<const Vec3> drawn, std::span<Vec3> positions, std::span<char> absent = {});
  /// Of what is kept, about.
  std::size_t bytes() const;

 private:
  struct Carved {
    CarveReport report;
    std::vector<int> vertices;
    std::vector<Vec3> positions;  ///< of these vertices [m]
    std::vector<int> absent;
  };
  const Carved* kept(double time) const;

  std::shared_ptr<const Trajectory> body_;
  FeasibleSettings settings_;
  FeasibleCollider collider_;
  mutable std::mutex mutex_;        ///< of what follows; entries stay as they are
  std::map<double, Carved> poses_;  ///< by time
  std::size_t bytes_ = 0, most_bytes_;
};

}  // namespace ft::inline collision
