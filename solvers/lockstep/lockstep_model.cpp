#include "solvers/lockstep/lockstep_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solvers/cords/generators.h"

namespace ft::inline solvers {
namespace {

/// Springs that keep the prop's frame in shape, against its inertia in a step: it yields by so small a share of what
/// free flight would give way in that step [1].
constexpr double k_frame_yield = 1e-5;
/// Stiffness of contact against that of the cords' pieces: what presses gives way before what stretches [1].
constexpr double k_contact_share = 0.05;
/// Strands that turn by less than this between two pieces rest straight there [rad].
constexpr double k_straight = 0.35;

Status check(const CordSystem& c) {
  const auto fault = [&](std::string what) { return usage_error(std::move(what), "cords \"" + c.name + "\""); };
  if (c.graph.points.empty() || c.graph.cords.empty()) return fault("there are no cords");
  if (!all_finite(c.graph.points)) return fault("there are points that are not finite");
  for (const Edge& e : c.graph.cords) {
    if (e[0] < 0 || e[1] < 0 || at(e[0]) >= c.graph.points.size() || at(e[1]) >= c.graph.points.size())
      return fault("a cord ends at a point that does not exist");
    if (!((c.graph.points[at(e[0])] - c.graph.points[at(e[1])]).norm() > 0))
      return fault(fmt::format("the cord between points {} and {} has no length", e[0], e[1]));
  }
  for (const auto& [name, value] : {std::pair("mass", c.mass), {"stretch", c.stretch}, {"radius", c.radius}})
    if (!(value > 0 && std::isfinite(value))) return fault(std::string(name) + " has to be positive");
  for (const auto& [name, value] : {std::pair("bend", c.bend), {"damping", c.damping}, {"friction", c.friction}})
    if (!(value >= 0 && std::isfinite(value))) return fault(std::string(name) + " must not be negative");
  return {};
}

void add_bends(const CordSystem& c, int first, std::vector<CordBend>& out) {
  if (c.bend <= 0) return;
  for (const std::vector<int>& strand : c.graph.strands)
    for (std::size_t i = 1; i + 1 < strand.size(); ++i) {
      const auto point = [&](std::size_t k) { return c.graph.points[at(strand[k])]; };
      const Vec3 before = point(i) - point(i - 1), after = point(i + 1) - point(i);
      if (before.normalized().dot(after.normalized()) < std::cos(k_straight)) continue;
      const double length = 0.5 * (before.norm() + after.norm());
      const double stiffness = c.bend / std::pow(length, 3);
      out.push_back(
          {{first + strand[i - 1], first + strand[i], first + strand[i + 1]}, stiffness, c.damping * stiffness});
    }
}

}  // namespace

void LockstepModel::spread(std::span<const Vec3> nodes, std::vector<Vec3>& places) const {
  const std::size_t points = at(point_count());
  places.assign(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(points));
  for (const auto& w : skin_weights)
    places.push_back(w[0] * nodes[points] + w[1] * nodes[points + 1] + w[2] * nodes[points + 2] +
                     w[3] * nodes[points + 3]);
}

void LockstepModel::add_place(int place, double weight, NodeTerm& term) const {
  const int points = point_count();
  if (place < points) return term.add(place, weight);
  const auto& w = skin_weights[at(place - points)];
  for (int k = 0; k < 4; ++k) {
    // Both corners of an edge hang on the same nodes.
    const auto end = term.node.begin() + term.count;
    const auto known = std::find(term.node.begin(), end, points + k);
    if (known != end)
      term.weight[static_cast<std::size_t>(known - term.node.begin())] += weight * w[at(k)];
    else
      term.add(points + k, weight * w[at(k)]);
  }
}

Result<LockstepModel> build_lockstep_model(LockstepSetup setup) {
  LockstepModel m;
  m.setup = std::move(setup);
  if (!(m.setup.fps > 0 && m.setup.longest_step > 0)) return usage_error("fps and the step have to be positive");
  std::vector<double> piece_stiffness;
  m.elements.air = {m.setup.air_density, m.setup.wind};
  m.first_point.push_back(0);
  for (std::size_t c = 0; c < m.setup.cords.size(); ++c) {
    const CordSystem& cords = m.setup.cords[c];
    if (const Status checked = check(cords); !checked) return checked.error();
    const int first = m.first_point.back();
    const std::vector<double> masses = lumped_masses(cords.graph, cords.mass);
    m.start.insert(m.start.end(), cords.graph.points.begin(), cords.graph.points.end());
    m.mass.insert(m.mass.end(), masses.begin(), masses.end());
    m.system_of.insert(m.system_of.end(), masses.size(), static_cast<int>(c));
    for (const Edge& e : cords.graph.cords) {
      const double length = (cords.graph.points[at(e[0])] - cords.graph.points[at(e[1])]).norm();
      const double stiffness = cords.stretch / length;
      m.elements.springs.push_back({first + e[0], first + e[1], length, stiffness, cords.damping * stiffness, false});
      m.elements.drags.push_back({first + e[0], first + e[1], length * 2 * cords.radius});
      m.cords.push_back({first + e[0], first + e[1], first + e[1]});
      m.rest_length.push_back(length);
      piece_stiffness.push_back(stiffness);
    }
    add_bends(cords, first, m.elements.bends);
    for (const int held : cords.graph.held)
      m.elements.holds.push_back({first + held, cords.graph.points[at(held)], cords.hold_stiffness});
    m.first_point.push_back(first + static_cast<int>(masses.size()));
  }
  if (m.cords.empty()) return usage_error("there are no cords to move");
  for (const double mass : m.mass)
    if (!(mass > 0)) return usage_error("a point that no cord ends at has no mass");
  std::nth_element(piece_stiffness.begin(),
                   piece_stiffness.begin() + static_cast<std::ptrdiff_t>(piece_stiffness.size() / 2),
                   piece_stiffness.end());
  m.contact_stiffness = k_contact_share * piece_stiffness[piece_stiffness.size() / 2];

  if (!m.has_prop()) return m;
  RigidProp& prop = *m.setup.prop;
  const std::string where = "primary \"" + prop.name + "\"";
  if (prop.surface.empty() || prop.triangles.empty()) return usage_error("it has no surface", where);
  if (prop.two_way && !(prop.mass.mass > 0 && prop.mass.inertia.allFinite() && prop.mass.inertia.trace() > 0))
    return usage_error("a two-way primary needs a mass", where, "write mass, in kg");
  const double earliest = -m.setup.preroll_frames / m.setup.fps;
  if (prop.two_way && prop.release < earliest) return usage_error("it is released before the bake begins", where);
  if (!(prop.mass.mass > 0)) prop.mass = {1, Mat3::Identity()};  // driven: only the frame's shape counts
  m.frame = equimomental(prop.mass);
  for (const Vec3& p : prop.surface) m.skin_weights.push_back(m.frame.weights(p));
  const int points = m.point_count();
  for (const Triangle& t : prop.triangles) m.skin.push_back({points + t[0], points + t[1], points + t[2]});
  const double node_mass = prop.mass.mass / 4, h = m.setup.longest_step;
  for (int a = 0; a < 4; ++a)
    for (int b = a + 1; b < 4; ++b)
      m.elements.springs.push_back({points + a, points + b, (m.frame.node[at(a)] - m.frame.node[at(b)]).norm(),
                                    node_mass / (k_frame_yield * h * h), 0, true});
  m.mass.insert(m.mass.end(), 4, node_mass);
  return m;
}

}  // namespace ft::inline solvers
