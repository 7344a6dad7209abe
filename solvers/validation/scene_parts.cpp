#include "solvers/validation/scene_parts.h"

#include <algorithm>

#include "baker/core/check.h"

namespace ft::inline solvers {
namespace {

class Boxes final : public Trajectory {
 public:
  using Place = std::function<Vec3(std::size_t, double, const Vec3&)>;
  Boxes(const std::vector<BoxSpec>& boxes, Place place) : place_(std::move(place)) {
    for (std::size_t b = 0; b < boxes.size(); ++b) {
      const int first = static_cast<int>(points_.size());
      for (int c = 0; c < 8; ++c)
        points_.push_back({c & 1 ? boxes[b].hi.x() : boxes[b].lo.x(), c & 2 ? boxes[b].hi.y() : boxes[b].lo.y(),
                           c & 4 ? boxes[b].hi.z() : boxes[b].lo.z()});
      const Triangle faces[] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
      for (const Triangle& f : faces) surface_.triangles.push_back({f[0] + first, f[1] + first, f[2] + first});
      surface_.part_of_vertex.resize(points_.size(), static_cast<int>(b));
      surface_.parts.push_back({"box" + std::to_string(b), -1, (boxes[b].hi - boxes[b].lo).prod()});
    }
  }
  const Surface& surface() const override { return surface_; }
  void bind_pose(std::span<Vec3> out) const override { sample(0, out); }
  void sample(double time, std::span<Vec3> out) const override {
    for (std::size_t i = 0; i < points_.size(); ++i) out[i] = place_(at(surface_.part_of_vertex[i]), time, points_[i]);
  }
  Eigen::Isometry3d bind_to_start() const override { return Eigen::Isometry3d::Identity(); }
  double preroll() const override { return 0; }

 private:
  Surface surface_;
  std::vector<Vec3> points_;
  Place place_;
};

}  // namespace

Mesh rectangle_mesh(int columns, int rows, const std::function<Vec3(double, double)>& place) {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      points.push_back(place(static_cast<double>(i) / columns, static_cast<double>(j) / rows));
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int a = i + (columns + 1) * j, b = a + 1, c = a + columns + 1, d = c + 1;
      if ((i + j) % 2 == 0)
        triangles.insert(triangles.end(), {{a, b, d}, {a, d, c}});
      else
        triangles.insert(triangles.end(), {{a, b, c}, {b, d, c}});
    }
  return make_triangle_mesh("cloth", std::move(points), triangles);
}

Fabric plain_fabric(double mass_per_area, double stretch, double bend, double poisson) {
  Fabric f;
  f.name = "plain";
  f.mass_per_area = mass_per_area;
  f.stretch_warp = f.stretch_weft = stretch;
  f.shear = stretch / (2 * (1 + poisson));
  f.poisson = poisson;
  f.bend_warp = f.bend_weft = bend;
  f.damping = 0;
  return f;
}

ClothSetup accurate_setup(Mesh mesh, const Fabric& fabric, double fps, int substeps) {
  ClothSetup setup;
  ClothGarment garment;
  garment.name = "cloth";
  garment.mesh = std::move(mesh);
  garment.fabric = fabric;
  garment.self_collision = false;
  setup.garments.push_back(std::move(garment));
  setup.fps = fps;
  setup.preroll_frames = 0;
  setup.air_density = 0;
  setup.min_substeps = setup.max_substeps = substeps;
  setup.newton_iterations = 10;
  setup.linear_tolerance = 1e-4;
  return setup;
}

void pin_stiffly(ClothSetup& setup, std::vector<int> vertices, double stiffness) {
  ClothPin pin;
  pin.vertices = std::move(vertices);
  pin.stiffness = stiffness;
  pin.max_pull = 1e12;
  setup.garments[0].pins.push_back(std::move(pin));
}

std::shared_ptr<const Trajectory> make_boxes(std::vector<BoxSpec> boxes, Boxes::Place place) {
  return std::make_shared<Boxes>(boxes, std::move(place));
}

ClothRun::ClothRun(ClothSetup setup) {
  auto made = make_cloth_solver(std::move(setup));
  CHECK(made.ok());
  solver_ = std::move(*made);
  state_ = solver_->initial_state();
}

void ClothRun::set_velocity(const std::function<Vec3(const Vec3&)>& velocity) {
  auto& x = state_.block("x");
  auto& v = state_.block("v");
  for (std::size_t i = 0; i < x.size(); i += 3) {
    const Vec3 value = velocity(Vec3(x[i], x[i + 1], x[i + 2]));
    for (int k = 0; k < 3; ++k) v[i + at(k)] = value[k];
  }
  state_.block("h_previous") = {0.0};
}

std::vector<Vec3> ClothRun::positions() const {
  const auto view = as_points(*state_.find("x"));
  return {view.begin(), view.end()};
}

std::vector<Vec3> ClothRun::velocities() const {
  const auto view = as_points(*state_.find("v"));
  return {view.begin(), view.end()};
}

}  // namespace ft::inline solvers
