#include "collision/body/feasible_poses.h"

#include <algorithm>

#include "baker/core/check.h"

namespace ft::inline collision {

FeasiblePoses::FeasiblePoses(std::shared_ptr<const Trajectory> body, const FeasibleSettings& settings,
                             std::size_t most_bytes)
    : body_(std::move(body)),
      settings_(settings),
      collider_(body_->surface(), bind_pose_apart_of(*body_), settings),
      most_bytes_(most_bytes) {}

const FeasiblePoses::Carved* FeasiblePoses::kept(double time) const {
  const std::lock_guard lock(mutex_);
  const auto found = poses_.find(time);
  return found == poses_.end() ? nullptr : &found->second;
}

CarveReport FeasiblePoses::evaluate(double time, std::span<const Vec3> drawn, std::span<Vec3> positions,
                                    std::span<char> absent) const {
  const Carved* carved = kept(time);
  if (carved == nullptr) return collider_.evaluate(drawn, positions, absent);
  collider_.refine(drawn, positions);
  for (std::size_t i = 0; i < carved->vertices.size(); ++i) positions[at(carved->vertices[i])] = carved->positions[i];
  if (absent.empty()) return carved->report;
  std::fill(absent.begin(), absent.end(), 0);
  for (const int v : carved->absent) absent[at(v)] = 1;
  return carved->report;
}

CarveReport FeasiblePoses::keep(double time, std::span<const Vec3> drawn, std::span<Vec3> positions,
                                std::span<char> absent) {
  if (kept(time) != nullptr) return evaluate(time, drawn, positions, absent);
  Carved carved;
  std::vector<char> own;
  if (absent.empty()) own.resize(positions.size()), absent = own;
  carved.report = collider_.evaluate(drawn, positions, absent);
  std::vector<Vec3> refined(positions.size());
  collider_.refine(drawn, refined);
  for (std::size_t v = 0; v < refined.size(); ++v) {
    if (absent[v] != 0) carved.absent.push_back(static_cast<int>(v));
    if (positions[v] == refined[v]) continue;
    carved.vertices.push_back(static_cast<int>(v));
    carved.positions.push_back(positions[v]);
  }
  const CarveReport report = carved.report;
  carved.vertices.shrink_to_fit();
  carved.positions.shrink_to_fit();
  carved.absent.shrink_to_fit();
  const std::size_t bytes =
      sizeof(Carved) + carved.vertices.size() * (sizeof(int) + sizeof(Vec3)) + carved.absent.size() * sizeof(int);
  const std::lock_guard lock(mutex_);
  if (bytes_ + bytes <= most_bytes_ && poses_.emplace(time, std::move(carved)).second) bytes_ += bytes;
  return report;
}

std::size_t FeasiblePoses::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

}  // namespace ft::inline collision
