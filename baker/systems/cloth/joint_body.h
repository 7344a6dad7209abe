// Several primaries as one body, for cloth that meets them all: surfaces and parts one after another, each placed where
// it starts. Parts are named "primary.part", those of a primary that is one part as the primary.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "baker/core/trajectory.h"

namespace ft::inline baker {

class JointBody final : public Trajectory {
 public:
  struct Member {
    std::string name;
    std::shared_ptr<const Trajectory> trajectory;
    bool fixed = false;  ///< SurfacePart::fixed of all its parts
  };
  explicit JointBody(std::vector<Member> members);

  /// The bind poses as they are in their files: they may stand in each other.
  void bind_pose(std::span<Vec3> positions) const override;
  void bind_pose_apart(std::span<Vec3> positions) const override;
  const Surface& surface() const override { return surface_; }
  void sample(double time, std::span<Vec3> positions) const override;
  /// Of a member's garments its own trajectory's.
  Eigen::Isometry3d bind_to_start() const override { return Eigen::Isometry3d::Identity(); }
  double preroll() const override { return preroll_; }

  const std::vector<Member>& members() const { return members_; }
  /// First part of a member; of the number of members: how many parts there are.
  int first_part(std::size_t member) const { return first_part_[member]; }
  std::size_t member_of_part(int part) const;
  /// The members' names: "walker, chair and floor".
  std::string text() const;

 private:
  template <class Fill>
  void fill(std::span<Vec3> positions, Fill&& fill) const;

  std::vector<Member> members_;
  std::vector<int> first_vertex_, first_part_;  ///< one more than members
  Surface surface_;
  double preroll_ = 0;
};

}  // namespace ft::inline baker
