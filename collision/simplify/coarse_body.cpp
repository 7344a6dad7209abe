#include "collision/simplify/coarse_body.h"

#include <algorithm>

#include "baker/core/check.h"
#include "baker/core/parallel.h"
#include "collision/geometry/weld.h"
#include "collision/simplify/mesh_coarsen.h"

namespace ft::inline collision {
namespace {

constexpr std::size_t k_block = 1024;
constexpr double k_least_cosine = 0.5;  ///< between the normals of a vertex and of its triangle, as far as is counted
constexpr double k_most_lift = 0.25;    ///< of the longest edge at a vertex [1]

class CoarseBody final : public Trajectory {
 public:
  CoarseBody(std::shared_ptr<const Trajectory> fine, double factor, double longest, double deviation);

  const Surface& surface() const override { return surface_; }
  void bind_pose(std::span<Vec3> positions) const override {
    std::vector<Vec3> fine(at(fine_->surface().vertex_count()));
    fine_->bind_pose(fine);
    place(fine, positions);
  }
  void sample(double time, std::span<Vec3> positions) const override {
    std::vector<Vec3> fine(at(fine_->surface().vertex_count()));
    fine_->sample(time, fine);
    place(fine, positions);
  }
  Eigen::Isometry3d bind_to_start() const override { return fine_->bind_to_start(); }
  double preroll() const override { return fine_->preroll(); }

 private:
  void place(std::span<const Vec3> fine, std::span<Vec3> positions) const;
  void find_lifts(const CoarsenedMesh& mesh, std::span<const int> number, std::span<const Vec3> bind);

  std::shared_ptr<const Trajectory> fine_;
  Surface surface_;
  std::vector<int> kept_;     ///< finer vertex of each
  std::vector<double> lift_;  ///< of each along its normal [m]
};

CoarseBody::CoarseBody(std::shared_ptr<const Trajectory> fine, double factor, double longest, double deviation)
    : fine_(std::move(fine)) {
  const Surface& given = fine_->surface();
  std::vector<Vec3> bind(at(given.vertex_count()));
  fine_->bind_pose(bind);
  const std::vector<int> representative = weld(bind, given.part_of_vertex);
  std::vector<Triangle> triangles;
  for (Triangle t : given.triangles) {
    for (int& v : t) v = representative[at(v)];
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
  std::vector<int> groups;
  for (const int part : given.part_of_vertex) groups.push_back(part + 1);
  const CoarsenedMesh mesh = coarsen_mesh({bind, triangles, {}, groups, factor, longest, deviation});

  std::vector<int> number(mesh.kept.size(), -1);  // without the vertices of no triangle, such as copies
  for (const Triangle& t : mesh.triangles)
    for (const int v : t) number[at(v)] = 0;
  surface_.parts = given.parts;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<int>(kept_.size());
    kept_.push_back(mesh.kept[v]);
    surface_.part_of_vertex.push_back(given.part_of_vertex[at(mesh.kept[v])]);
  }
  for (const Triangle& t : mesh.triangles)
    surface_.triangles.push_back({number[at(t[0])], number[at(t[1])], number[at(t[2])]});
  find_lifts(mesh, number, bind);
}

/// So that of every triangle the finer vertices above it come to lie inside.
void CoarseBody::find_lifts(const CoarsenedMesh& mesh, std::span<const int> number, std::span<const Vec3> bind) {
  std::vector<Vec3> x;
  for (const int v : kept_) x.push_back(bind[at(v)]);
  const std::vector<Vec3> normals = vertex_normals(x, surface_.triangles);
  lift_.assign(x.size(), 0.0);
  for (std::size_t v = 0; v < mesh.places.size(); ++v) {
    Triangle corner = mesh.places[v].vertex;
    for (int& c : corner) c = number[at(c)];
    if (corner[0] < 0 || corner[0] == corner[1]) continue;  // of no triangle, or left as it is
    const Vec3 &a = x[at(corner[0])], &b = x[at(corner[1])], &c = x[at(corner[2])];
    const Vec3 normal = (b - a).cross(c - a).normalized();
    const double height = (bind[v] - a).dot(normal);
    for (const int i : corner)
      lift_[at(i)] = std::max(lift_[at(i)], height / std::max(k_least_cosine, normals[at(i)].dot(normal)));
  }
  std::vector<double> longest(x.size(), 0.0);
  for (const Edge& e : unique_edges(surface_.triangles))
    for (const int v : e) longest[at(v)] = std::max(longest[at(v)], (x[at(e[0])] - x[at(e[1])]).norm());
  for (std::size_t i = 0; i < lift_.size(); ++i) lift_[i] = std::min(lift_[i], k_most_lift * longest[i]);
}

void CoarseBody::place(std::span<const Vec3> fine, std::span<Vec3> positions) const {
  CHECK(positions.size() == kept_.size());
  for (std::size_t i = 0; i < kept_.size(); ++i) positions[i] = fine[at(kept_[i])];
  const std::vector<Vec3> normals = vertex_normals(positions, surface_.triangles);
  parallel_for(kept_.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) positions[i] += lift_[i] * normals[i];
  });
}

}  // namespace

std::shared_ptr<const Trajectory> coarse_body(std::shared_ptr<const Trajectory> fine, double factor, double longest,
                                              double deviation) {
  return std::make_shared<CoarseBody>(std::move(fine), factor, longest, deviation);
}

}  // namespace ft::inline collision
