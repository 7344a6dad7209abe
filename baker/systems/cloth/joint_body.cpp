#include "baker/systems/cloth/joint_body.h"

#include <algorithm>

namespace ft::inline baker {

JointBody::JointBody(std::vector<Member> members) : members_(std::move(members)) {
  for (const Member& member : members_) {
    const Surface& own = member.trajectory->surface();
    const int vertex = surface_.vertex_count(), part = static_cast<int>(surface_.parts.size());
    first_vertex_.push_back(vertex);
    first_part_.push_back(part);
    for (const Triangle& t : own.triangles) surface_.triangles.push_back({t[0] + vertex, t[1] + vertex, t[2] + vertex});
    for (const int p : own.part_of_vertex) surface_.part_of_vertex.push_back(p + part);
    for (SurfacePart p : own.parts) {
      p.name = own.parts.size() == 1 ? member.name : member.name + "." + p.name;
      if (p.parent >= 0) p.parent += part;
      p.fixed = member.fixed;
      surface_.parts.push_back(std::move(p));
    }
    preroll_ = std::max(preroll_, member.trajectory->preroll());
  }
  first_vertex_.push_back(surface_.vertex_count());
  first_part_.push_back(static_cast<int>(surface_.parts.size()));
}

template <class Fill>
void JointBody::fill(std::span<Vec3> positions, Fill&& fill) const {
  for (std::size_t m = 0; m < members_.size(); ++m) {
    const auto first = at(first_vertex_[m]);
    fill(*members_[m].trajectory, positions.subspan(first, at(first_vertex_[m + 1]) - first));
  }
}

void JointBody::bind_pose(std::span<Vec3> positions) const {
  fill(positions, [](const Trajectory& body, std::span<Vec3> x) { body.bind_pose(x); });
}

void JointBody::bind_pose_apart(std::span<Vec3> positions) const {
  fill(positions, [](const Trajectory& body, std::span<Vec3> x) {
    body.bind_pose(x);
    const Eigen::Isometry3d move = body.bind_to_start();
    for (Vec3& p : x) p = move * p;
  });
}

void JointBody::sample(double time, std::span<Vec3> positions) const {
  fill(positions, [&](const Trajectory& body, std::span<Vec3> x) { body.sample(time, x); });
}

std::string JointBody::text() const {
  std::string out;
  for (std::size_t m = 0; m < members_.size(); ++m)
    out += (m == 0 ? "" : m + 1 == members_.size() ? " and " : ", ") + members_[m].name;
  return out;
}

std::size_t JointBody::member_of_part(int part) const {
  const auto next = std::upper_bound(first_part_.begin(), first_part_.end(), part);
  return static_cast<std::size_t>(next - first_part_.begin()) - 1;
}

}  // namespace ft::inline baker
