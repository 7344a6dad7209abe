// Crossings of garments in a state that no solver has reported on: the first one, where there is no pre-roll.
#include <fmt/format.h>

#include "baker/systems/cloth/cloth_group.h"
#include "collision/check/crossings.h"

namespace ft::inline baker {

void ClothGroup::add_certificate(const BakePlan& plan, const Solver& solver, const State& state,
                                 FrameReport& report) const {
  std::vector<Vec3> collider;
  solver.collider_positions(state, collider);
  std::vector<Vec3> cloth;
  std::vector<Triangle> triangles;
  std::vector<std::vector<char>> absent;  // of each system
  std::vector<int> system_of;             // of each vertex
  for (int s = 0; s < solver.system_count(); ++s) {
    const Mesh& mesh = solver.system_mesh(s);
    const int first = static_cast<int>(cloth.size());
    cloth.resize(cloth.size() + mesh.positions.size());
    solver.system_positions(state, s, std::span(cloth).subspan(at(first)));
    for (const Triangle& t : triangulate(mesh)) triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    absent.push_back(solver.collider_absent(state, s));
    system_of.resize(cloth.size(), s);
  }
  auto body = crossings_between(cloth, triangles, collider, solver.collider_triangles());
  report.crossings_absent += static_cast<int>(std::erase_if(body, [&](const Crossing& c) {
    return second_is_marked(c, absent[at(system_of[at(c.edge_of_first ? c.edge[0] : c.triangle[0])])]);
  }));
  report.crossings_body += static_cast<int>(body.size());
  report.crossings_self += static_cast<int>(crossings_within(cloth, triangles).size());
  if (body.empty()) return;
  Incident incident;
  incident.kind = Incident::Kind::k_start_inside;
  incident.frame = report.frame;
  incident.system = plan.primaries[primary].name;
  incident.place = cloth[at(body[0].edge_of_first ? body[0].edge[0] : body[0].triangle[0])];
  incident.text = fmt::format("{} crossings with the body where the bake starts", body.size());
  report.incidents.push_back(std::move(incident));
}

}  // namespace ft::inline baker
