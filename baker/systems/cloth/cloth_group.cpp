#include "baker/systems/cloth/cloth_group.h"

#include <algorithm>

namespace ft::inline baker {

Result<std::unique_ptr<Solver>> ClothGroup::make_solver() {
  poses_ = setup.poses;
  return make_cloth_solver(std::move(setup));
}

std::vector<ColliderSlice> ClothGroup::slices(const BakePlan& plan, std::span<const std::string> taken) const {
  if (!joint) return {};
  const auto& poses = poses_ ? poses_ : setup.poses;
  CHECK(poses);
  const FeasibleCollider& collider = poses->collider();
  const auto parts = collider.part_of_vertex();
  std::vector<ColliderSlice> out(bodies.size());
  for (std::size_t m = 0; m < out.size(); ++m) {
    const std::string& body = plan.primaries[bodies[m]].cache_name();
    out[m].primary = bodies[m];
    out[m].fixed = joint->members()[m].fixed || has_sheets(joint->members()[m].trajectory->surface().parts);
    out[m].name = out[m].fixed ? body : body + ".collider";
    if (!out[m].fixed && std::find(taken.begin(), taken.end(), out[m].name) != taken.end())
      out[m].name += "." + plan.primaries[primary].cache_name();
  }
  std::vector<int> own(parts.size());
  for (std::size_t v = 0; v < parts.size(); ++v) {
    ColliderSlice& slice = out[joint->member_of_part(parts[v])];
    own[v] = static_cast<int>(slice.vertices.size());
    slice.vertices.push_back(static_cast<int>(v));
  }
  for (const Triangle& t : collider.triangles())
    out[joint->member_of_part(parts[at(t[0])])].triangles.push_back({own[at(t[0])], own[at(t[1])], own[at(t[2])]});
  return out;
}

}  // namespace ft::inline baker
