// See feasible_collider.h. Creases of joints open first. Then the parts are walked from the largest to the smallest,
// each against all larger ones, which are final by then. Nothing is remembered between calls.
#include "collision/body/feasible_collider.h"

#include <algorithm>

#include "baker/core/check.h"
#include "collision/body/absent_vertices.h"
#include "collision/body/carver.h"
#include "collision/body/creases.h"
#include "collision/geometry/mesh_refine.h"

namespace ft::inline collision {
namespace {

/// Of the gap that carving keeps: with less room than that cloth is pressed [1]. Carved edges sag by some of it.
constexpr double k_room_share = 0.8;
constexpr std::size_t k_most_triangles = 400'000;  ///< of the refined collider

}  // namespace

struct FeasibleCollider::Impl {
  RefinedMesh mesh;
  std::vector<int> part_of_vertex;
  Carver carver;  ///< without a surface when there is nothing to carve
  Creases creases;
  AbsentVertices absent;
};

FeasibleCollider::FeasibleCollider(const Surface& drawn, std::span<const Vec3> bind_pose,
                                   const FeasibleSettings& settings)
    : impl_(std::make_unique<Impl>()) {
  Impl& m = *impl_;
  CHECK(static_cast<int>(bind_pose.size()) == drawn.vertex_count() && !drawn.parts.empty());
  m.carver.settings = settings;
  m.carver.near = std::max(1.5 * settings.gap, 0.55 * settings.max_edge);
  std::vector<char> stays;  // per triangle: nothing there has to give way
  for (const Triangle& t : drawn.triangles) {
    const SurfacePart& part = drawn.parts[at(drawn.part_of_vertex[at(t[0])])];
    stays.push_back(part.fixed || part.sheet);
  }
  m.mesh = refine_mesh(bind_pose, drawn.triangles, settings.max_edge, k_most_triangles, stays);
  std::vector<int> rank(drawn.parts.size());
  const std::vector<int> by_size = parts_by_size(drawn.parts);
  for (std::size_t i = 0; i < by_size.size(); ++i) rank[at(by_size[i])] = static_cast<int>(i);
  m.part_of_vertex = drawn.part_of_vertex;
  for (const RefinedMesh::Blend& blend : m.mesh.blends) {
    const int p = m.part_of_vertex[at(blend.a)], q = m.part_of_vertex[at(blend.b)];
    m.part_of_vertex.push_back(rank[at(p)] <= rank[at(q)] ? p : q);
  }
  if (!settings.carve || drawn.parts.size() < 2) return;
  std::vector<Vec3> bind(at(m.mesh.vertex_count()));
  m.mesh.positions(bind_pose, bind);
  m.carver.surface =
      std::make_unique<PartSurface>(bind, m.mesh.triangles, m.part_of_vertex, static_cast<int>(drawn.parts.size()));
  m.carver.plan = make_carve_plan(*m.carver.surface, drawn.parts, m.part_of_vertex, bind, settings.gap);
  m.creases = Creases(*m.carver.surface, drawn.parts, m.part_of_vertex, bind, settings.gap);
  m.absent = AbsentVertices(*m.carver.surface, bind, m.part_of_vertex, drawn.parts, rank, settings.deepest,
                            k_room_share * settings.gap);
}

FeasibleCollider::~FeasibleCollider() = default;

int FeasibleCollider::vertex_count() const {
  return impl_->mesh.vertex_count();
}
std::span<const Triangle> FeasibleCollider::triangles() const {
  return impl_->mesh.triangles;
}
std::span<const int> FeasibleCollider::part_of_vertex() const {
  return impl_->part_of_vertex;
}

bool FeasibleCollider::kept_apart(int part_a, int part_b) const {
  const CarvePlan& plan = impl_->carver.plan;
  if (impl_->carver.surface == nullptr || part_a == part_b || plan.jointed(part_a, part_b)) return false;
  if (plan.parts[at(part_a)].sheet || plan.parts[at(part_b)].sheet) return false;
  const auto& yielding = plan.yielding;
  return yielding[at(part_a)].touching_part(part_b) == nullptr && yielding[at(part_b)].touching_part(part_a) == nullptr;
}

void FeasibleCollider::refine(std::span<const Vec3> drawn, std::span<Vec3> refined) const {
  impl_->mesh.positions(drawn, refined);
}

CarveReport FeasibleCollider::evaluate(std::span<const Vec3> drawn, std::span<Vec3> positions,
                                       std::span<char> absent) const {
  refine(drawn, positions);
  std::fill(absent.begin(), absent.end(), 0);
  CarveReport report;
  if (impl_->carver.surface == nullptr) return report;
  const std::vector<Vec3> before(positions.begin(), positions.end());
  impl_->creases.open(positions);
  std::vector<Vec3> opened;
  if (!absent.empty()) opened.assign(positions.begin(), positions.end());
  const int part_count = impl_->carver.surface->part_count();
  Carver::Scratch scratch{positions, std::vector<TreeBox>(at(part_count)), std::vector<TriangleTree>(at(part_count))};
  for (int part = 0; part < part_count; ++part) scratch.boxes[at(part)] = impl_->carver.box_of(part, positions);
  for (const int part : impl_->carver.plan.by_size)
    if (!impl_->carver.plan.parts[at(part)].fixed) impl_->carver.give_way(part, scratch);
  const auto representative = impl_->carver.surface->representative();
  for (const int v : impl_->carver.plan.copies) {
    const std::size_t r = at(representative[at(v)]);
    positions[at(v)] += positions[r] - before[r];
  }
  if (!absent.empty()) impl_->absent.find(opened, positions, absent);
  std::size_t farthest = 0;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const double move = (positions[v] - before[v]).norm();
    if (move > 0) ++report.moved_vertices;
    if (move > report.largest_move) report.largest_move = move, farthest = v;
  }
  if (report.moved_vertices > 0) {
    report.part_a = impl_->part_of_vertex[farthest];
    report.part_b =
        impl_->carver.deepest_opponent(impl_->carver.plan.yielding[at(report.part_a)], before[farthest], scratch);
  }
  return report;
}

}  // namespace ft::inline collision
