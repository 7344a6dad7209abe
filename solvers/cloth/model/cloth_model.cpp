#include "solvers/cloth/model/cloth_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "baker/core/corner_uvs.h"
#include "baker/core/give_back.h"
#include "collision/body/carve_plan.h"
#include "solvers/cloth/model/attach.h"
#include "solvers/cloth/model/cloth_check.h"
#include "solvers/cloth/model/draw_back.h"
#include "solvers/cloth/model/pins.h"
#include "solvers/cloth/model/sewing.h"
#include "solvers/energies/registry.h"

namespace ft::inline solvers {
namespace {

/// Per garment the median of its edges at rest [m]; infinite without any.
std::vector<double> median_edges(const ClothModel& model) {
  std::vector<std::vector<double>> lengths(model.setup.garments.size());
  for (std::size_t k = 0; k < model.rest_edges.edges.size(); ++k)
    lengths[at(model.garment_of(model.rest_edges.edges[k][0]))].push_back(model.rest_edges.lengths[k]);
  std::vector<double> out;
  for (std::vector<double>& of_garment : lengths) {
    const auto middle = of_garment.begin() + static_cast<std::ptrdiff_t>(of_garment.size() / 2);
    std::nth_element(of_garment.begin(), middle, of_garment.end());
    out.push_back(of_garment.empty() ? std::numeric_limits<double>::infinity() : *middle);
  }
  return out;
}

/// Vertices, triangles and rest shape of all garments in one numbering, each a piece of the topology.
void concatenate(ClothModel& model) {
  std::vector<ClothPiece> pieces;
  std::vector<std::array<Vec2, 3>> uvs;
  bool all_have_uvs = true;
  ContactModel& contact = model.contact;
  std::size_t vertices = 0, triangle_count = 0;
  for (const ClothGarment& garment : model.setup.garments) {
    vertices += garment.mesh.positions.size();
    triangle_count += garment.mesh.face_vertices.size() - 2 * garment.mesh.face_sizes.size();
  }
  const auto reserve = [](std::size_t count, auto&... lists) { (lists.reserve(count), ...); };
  const bool several = model.setup.garments.size() > 1;
  reserve(vertices, contact.radius, contact.garment, model.self_collides);
  if (!several) model.triangles = as_triangles(model.setup.garments[0].mesh);
  const bool own_triangles = model.triangles.empty();
  reserve(several ? vertices : 0, model.own_rest);
  reserve(own_triangles ? triangle_count : 0, model.own_triangles);
  reserve(triangle_count, uvs);
  for (std::size_t g = 0; g < model.setup.garments.size(); ++g) {
    const ClothGarment& garment = model.setup.garments[g];
    const int first = static_cast<int>(contact.radius.size());
    const std::size_t count = garment.mesh.positions.size();
    model.first_vertex.push_back(first);
    pieces.push_back({first, static_cast<int>(count), garment.fabric, garment.pattern_scale, garment.maps});
    if (several)
      model.own_rest.insert(model.own_rest.end(), garment.mesh.positions.begin(), garment.mesh.positions.end());
    const auto triangles = triangulate(garment.mesh);
    const auto own_uvs = corner_uvs(garment.mesh, triangles);
    all_have_uvs = all_have_uvs && !own_uvs.empty();
    uvs.insert(uvs.end(), own_uvs.begin(), own_uvs.end());
    if (own_uvs.empty()) uvs.resize(uvs.size() + triangles.size(), {Vec2::Zero(), Vec2::Zero(), Vec2::Zero()});
    for (Triangle t : triangles) {
      for (int& v : t) v += first;
      if (own_triangles) model.own_triangles.push_back(t);
    }
    for (std::size_t i = 0; i < count; ++i)
      contact.radius.push_back(garment.maps.thickness.empty() ? garment.thickness : garment.maps.thickness[i]);
    contact.friction.push_back(garment.friction);
    contact.self_friction.push_back(garment.self_friction);
    contact.garment.resize(contact.garment.size() + count, static_cast<int>(g));
    model.self_collides.resize(model.self_collides.size() + count, garment.self_collision);
  }
  if (own_triangles) model.triangles = model.own_triangles;
  contact.rest = several ? model.own_rest : model.setup.garments[0].mesh.positions;
  model.first_vertex.push_back(static_cast<int>(contact.rest.size()));
  contact.cloth_vertex_count = static_cast<int>(contact.rest.size());
  // Degenerate uvs (all zero) fall back to the rest shape's own axes.
  model.topology = std::make_unique<ClothTopology>(make_cloth_topology(contact.rest, model.triangles, pieces, uvs));
}

void weigh(ClothModel& model) {
  const std::size_t n = model.contact.rest.size();
  model.mass = model.topology->mass;
  model.contact.area.assign(n, 0.0);
  model.unused.assign(n, 1);
  const ClothTopology& topology = *model.topology;
  for (std::size_t index = 0; index < topology.triangles.size(); ++index) {
    const Triangle& t = topology.triangles[index];
    const auto& rest = model.contact.rest;
    const bool cut = topology.pieces[at(topology.triangle_piece[index])].pattern_scale > 0;
    const double area = cut ? topology.rest_area[index] : triangle_area(rest[at(t[0])], rest[at(t[1])], rest[at(t[2])]);
    for (const int v : t) {
      model.contact.area[at(v)] += area / 3;
      model.unused[at(v)] = 0;
    }
  }
  for (std::size_t i = 0; i < n; ++i)
    if (!(model.mass[i] > 0)) model.unused[i] = 1;
  model.rest_edges = rest_edges(model.contact.rest, model.triangles);
  model.rest_edges.edges.shrink_to_fit();
  lengths_from_pattern(*model.topology, model.rest_edges);
  model.typical_edge = median_edges(model);
  std::vector<double> typical(n), cluster_size(n);
  for (std::size_t i = 0; i < n; ++i) {
    typical[i] = model.typical_edge[at(model.contact.garment[i])];
    cluster_size[i] = k_very_near * typical[i];
  }
  model.clusters = VertexClusters(model.rest_edges, cluster_size);
  model.carry_smooth = CarrySmooth(model.contact.rest, model.rest_edges, typical, k_very_near, model.clusters);
}

/// Where the garments start: as the body at the start of the pre-roll has taken them along, or, what is pinned to the
/// world, where they are.
void place(ClothModel& model) {
  const ClothSetup& setup = model.setup;
  model.start.assign(model.contact.rest.begin(), model.contact.rest.end());
  if (!setup.primary) return;
  for (std::size_t g = 0; g < setup.garments.size(); ++g) {
    const auto& pins = setup.garments[g].pins;
    if (std::any_of(pins.begin(), pins.end(), [](const ClothPin& pin) { return pin.to_world; })) continue;
    const auto& wearer = setup.garments[g].wearer;
    const Eigen::Isometry3d to_start = wearer ? wearer->to_start : setup.primary->bind_to_start();
    for (int v = model.first_vertex[g]; v < model.first_vertex[g + 1]; ++v)
      model.start[at(v)] = to_start * model.start[at(v)];
  }
}

}  // namespace

Result<std::unique_ptr<ClothModel>> build_cloth_model(ClothSetup setup) {
  if (Status status = check(setup); !status) return status.error();
  auto model = std::make_unique<ClothModel>();
  model->setup = std::move(setup);
  concatenate(*model);
  weigh(*model);
  place(*model);
  pin(*model);
  sew(*model);
  attach(*model);
  const ClothSetup& s = model->setup;
  AirSettings air;
  air.wind = s.wind;
  air.density = s.air_density;
  model->energies = make_cloth_energies(*model->topology, air);
  if (s.primary) {
    auto draw_back = std::make_unique<DrawBack>();
    model->draw_back = draw_back.get();
    model->energies.push_back(std::move(draw_back));
  }
  std::vector<std::vector<std::array<int, 4>>> stencils;
  for (const auto& energy : model->energies) stencils.push_back(energy->stencils());
  model->pattern = make_pattern(model->vertex_count(), stencils);
  model->attachments = std::move(model->topology->attachments);
  model->seams = std::move(model->topology->seams);
  model->flipped_caps = std::move(model->topology->flipped_caps);
  model->topology.reset();
  for (ClothGarment& garment : model->setup.garments) {
    Mesh& mesh = garment.mesh;
    give_back(mesh.uvs, mesh.face_uvs, mesh.groups, mesh.stitches, garment.maps);
  }
  if (s.primary) {
    CHECK(s.poses == nullptr || &s.poses->body() == s.primary.get());
    model->collider = std::make_unique<MovingCollider>(
        s.poses != nullptr ? s.poses : std::make_shared<FeasiblePoses>(s.primary, s.feasible));
    const std::vector<int> by_size = parts_by_size(s.primary->surface().parts);
    model->part_rank.resize(by_size.size());
    for (std::size_t rank = 0; rank < by_size.size(); ++rank)
      model->part_rank[at(by_size[rank])] = static_cast<int>(rank);
    for (const int part : s.bodies.empty() ? std::span<const int>{} : model->collider->part_of_vertex()) {
      const auto own = std::find_if(s.bodies.begin(), s.bodies.end(), [&](const PartRange& b) { return b.has(part); });
      CHECK(own != s.bodies.end());
      model->body_of_vertex.push_back(static_cast<int>(own - s.bodies.begin()));
    }
    model->absence = Absence(*model);
    double thickness = 0;
    for (const double radius : model->contact.radius) thickness = std::max(thickness, radius);
    model->start_depth = model->collider->draw_in_for(model->start, model->triangles, thickness);
  }
  return model;
}

}  // namespace ft::inline solvers
