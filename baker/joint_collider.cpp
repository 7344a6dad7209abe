#include "baker/joint_collider.h"

#include <algorithm>

#include "baker/absent_runs.h"

namespace ft {

std::vector<ColliderSlice> collider_slices(const BakePlan& plan, const GroupPlan& group,
                                           std::span<const std::string> taken) {
  CHECK(group.joint && group.poses);
  const FeasibleCollider& collider = group.poses->collider();
  const auto parts = collider.part_of_vertex();
  std::vector<ColliderSlice> out(group.bodies.size());
  for (std::size_t m = 0; m < out.size(); ++m) {
    const std::string& primary = plan.primaries[group.bodies[m]].name;
    out[m].primary = group.bodies[m];
    out[m].fixed = group.joint->members()[m].fixed;
    out[m].name = out[m].fixed ? primary : primary + ".collider";
    if (!out[m].fixed && std::find(taken.begin(), taken.end(), out[m].name) != taken.end())
      out[m].name += "." + plan.primaries[group.primary].name;
  }
  std::vector<int> own(parts.size());
  for (std::size_t v = 0; v < parts.size(); ++v) {
    ColliderSlice& slice = out[group.joint->member_of_part(parts[v])];
    own[v] = static_cast<int>(slice.vertices.size());
    slice.vertices.push_back(static_cast<int>(v));
  }
  for (const Triangle& t : collider.triangles())
    out[group.joint->member_of_part(parts[at(t[0])])].triangles.push_back(
        {own[at(t[0])], own[at(t[1])], own[at(t[2])]});
  return out;
}

std::vector<AbsentRuns> sliced(const AbsentRuns& runs, std::span<const ColliderSlice> slices, int vertex_count) {
  const std::vector<char> all = marks_of(runs, vertex_count);
  std::vector<AbsentRuns> out;
  for (const ColliderSlice& slice : slices) {
    std::vector<char> marks;
    for (const int v : slice.vertices) marks.push_back(all[at(v)]);
    AbsentRuns own = runs_of(runs.system, marks);
    own.collider = slice.name;
    if (!own.runs.empty()) out.push_back(std::move(own));
  }
  return out;
}

}  // namespace ft
