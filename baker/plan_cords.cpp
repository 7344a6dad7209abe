#include "baker/plan_cords.h"

#include <fmt/format.h>

#include <algorithm>

#include "baker/plan_common.h"
#include "baker/quality.h"
#include "io/shot/mesh_file.h"
#include "solvers/cords/generators.h"
#include "solvers/cords/tubes.h"

namespace ft {
namespace {

Result<CordSystem> cord_system(const CordsSpec& spec) {
  auto graph = cord_graph(spec);
  if (!graph) return graph.error();
  CordSystem out;
  out.name = spec.name;
  out.graph = std::move(*graph);
  out.mass = spec.mass;
  out.stretch = spec.stretch;
  out.bend = spec.bend;
  out.damping = spec.damping;
  out.radius = spec.radius;
  out.friction = spec.friction;
  out.hold_stiffness = spec.hold_stiffness;
  out.self_collision = spec.self_collision;
  return out;
}

RigidProp rigid_prop(const Prop& prop, const RigidTrack& track, bool two_way) {
  RigidProp out;
  out.name = prop.name;
  out.surface = prop.surface;
  out.triangles = prop.triangles;
  out.mass = prop.mass;
  out.track = track;
  out.two_way = two_way;
  out.release_on_contact = prop.release_on_contact;
  // What has nothing to release it is free from the first frame.
  out.release = prop.release_on_contact || std::isfinite(prop.release) ? prop.release : 0;
  return out;
}

}  // namespace

Result<CordGraph> cord_graph(const CordsSpec& s) {
  if (s.shape == "net") {
    NetMeasures net;
    net.columns = s.columns;
    net.rows = s.rows;
    net.radius_top = s.radius_top;
    net.radius_bottom = s.radius_bottom;
    net.length = s.length;
    net.pieces = s.points;
    net.centre = s.position;
    return diamond_net(net);
  }
  if (s.shape == "mesh") {
    auto mesh = read_obj(s.mesh);
    if (!mesh) return mesh.error();
    for (Vec3& p : mesh->positions) {
      p *= s.unit_scale;
      if (s.up == "z") p = Vec3(p.x(), p.z(), -p.y());
      p += s.position;
    }
    return cords_of_mesh(*mesh, s.held, s.points);
  }
  RopeMeasures line;
  line.from = s.position;
  line.to = s.to;
  line.pieces = s.points;
  line.hold_from = s.held == "start" || s.held == "both";
  line.hold_to = s.held == "end" || s.held == "both";
  if (s.shape == "knots") {
    line.knots = s.knots;
    line.knot_share = s.knot_mass / (s.mass - s.knots * s.knot_mass);
  }
  return rope(line);
}

Status plan_cords(const Shot& shot, std::size_t p, BakePlan& plan) {
  const PrimaryPlan& primary = plan.primaries[p];
  GroupPlan group{p, {}, {}, LockstepSetup{}};
  LockstepSetup& setup = *group.lockstep;
  bool two_way = false, one_way = false;
  for (const CordsSpec& spec : shot.cords) {
    if (spec.on != primary.name) continue;
    auto system = cord_system(spec);
    if (!system) {
      Error error = system.error();
      error.where = shot.file.filename().string() + ": cords \"" + spec.name + "\"" +
                    (error.where.empty() ? "" : ": " + error.where);
      return error;
    }
    Mesh mesh = CordTubes(system->graph, system->radius, spec.name).mesh();
    mesh.name = spec.name;
    GarmentOutput output;
    output.mesh = std::make_shared<const Mesh>(std::move(mesh));
    group.outputs.push_back(std::move(output));
    setup.cords.push_back(std::move(*system));
    (spec.coupling == "two-way" ? two_way : one_way) = true;
  }
  if (setup.cords.empty()) return {};
  const std::string where = shot.file.filename().string() + ": primary \"" + primary.name + "\"";
  const bool wears_cloth =
      std::any_of(shot.cloths.begin(), shot.cloths.end(), [&](const ClothSpec& c) { return c.on == primary.name; });
  if (two_way && (one_way || wears_cloth))
    return usage_error("some of its secondaries are two-way and others are not", where,
                       "a primary that yields is followed by cords that are all two-way so far");
  CHECK(primary.prop);
  setup.prop = rigid_prop(*primary.prop, primary.track, two_way);
  take_from_shot(shot, setup);
  apply_quality(shot, setup);
  plan.groups.push_back(std::move(group));
  return {};
}

}  // namespace ft
