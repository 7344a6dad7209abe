// The real thing: the knife dress of the Codimensional IPC authors, sewn from its 14 panels on their mannequin, beside
// their own draped result. Frame 0 of the dance is held still.
#include <gtest/gtest.h>

#include <algorithm>

#include "baker/core/rigid.h"
#include "io/shot/mesh_file.h"
#include "solvers/cloth/cloth_solver.h"
#include "tests/support/assets.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

constexpr int k_frames = 75;            ///< 3 s: half to sew, half to come to rest
constexpr double k_body_height = 0.75;  ///< the authors' result is centred: their body's feet are at -0.75 m

Mesh read(const std::filesystem::path& path) {
  auto mesh = read_obj(path);
  EXPECT_TRUE(mesh) << (mesh ? "" : mesh.error().text());
  return mesh ? std::move(*mesh) : Mesh{};
}

double area_of(const Mesh& mesh, std::span<const Vec3> x) {
  double sum = 0;
  for (const Triangle& t : triangulate(mesh)) sum += triangle_area(x[at(t[0])], x[at(t[1])], x[at(t[2])]);
  return sum;
}

/// Distances of the vertices after the best rigid motion of a onto b; sorted [m].
std::vector<double> distances_after_alignment(std::span<const Vec3> a, std::span<const Vec3> b) {
  const Eigen::Isometry3d fit = rigid_fit(a, b);
  std::vector<double> out;
  for (std::size_t i = 0; i < a.size(); ++i) out.push_back((fit * a[i] - b[i]).norm());
  std::sort(out.begin(), out.end());
  return out;
}

/// The fabric, friction and contact of the authors' script for this dress (95 % wool, 5 % lycra): 0.328 mm of 543.3
/// kg/m3, E = 760 Pa, ten times that for bending, Poisson's ratio 0.071, and a barrier of 1 kPa against principal
/// stretches of 13.4 %: hardly any resistance to compression, and 4.8 N/m at a stretch of 8 %. Our limits are those of
/// yarns, not of principal stretches; they and the shear come near their tension at 8 %, as in the bodice.
void make_as_the_authors_did(ClothGarment& dress) {
  Fabric& f = dress.fabric;
  f.mass_per_area = 0.1782;
  f.stretch_warp = f.stretch_weft = 0.25;
  f.poisson = 0.071;
  f.shear = 15;
  f.bend_warp = f.bend_weft = 2.2e-8;
  f.limit_warp = f.limit_weft = 1e-4;
  f.limit_stretch = 65;
  dress.thickness = 1e-3;
  dress.friction = dress.self_friction = 0.2;
}

TEST(SewnDress, Comes_out_as_the_authors_of_the_pattern_draped_it_slow) {
  const auto folder = test::assets_root() / "garments";
  FT_REQUIRE_FILE(folder / "cipc_dress_knife/stage.obj");
  FT_REQUIRE_FILE(folder / "cipc_mannequin_rumba/body_frame0_yup.obj");
  ClothGarment dress;
  dress.name = "dress";
  dress.mesh = read(folder / "cipc_dress_knife/stage.obj");
  for (Vec3& p : dress.mesh.positions) p = Vec3(p.x(), p.z() + k_body_height, -p.y());
  dress.pattern_scale = 1;
  make_as_the_authors_did(dress);
  const Mesh mesh = dress.mesh, drape = read(folder / "cipc_dress_knife/drape.obj");
  const Mesh body = read(folder / "cipc_mannequin_rumba/body_frame0_yup.obj");
  ASSERT_GE(drape.positions.size(), mesh.positions.size());

  Surface surface;
  surface.triangles = triangulate(body);
  surface.part_of_vertex.assign(body.positions.size(), 0);
  ClothSetup setup;
  setup.fps = 25;
  setup.preroll_frames = k_frames;
  setup.primary =
      std::make_shared<ScriptedBody>(surface, body.positions, k_frames / setup.fps, [](double, std::span<Vec3>) {});
  setup.garments.push_back(std::move(dress));
  auto solver = make_cloth_solver(std::move(setup));
  ASSERT_TRUE(solver) << solver.error().text();
  State state = (*solver)->initial_state();
  FrameReport last;
  for (int f = 0; f < k_frames; ++f) {
    last = (*solver)->advance_frame(state);
    ASSERT_TRUE(last.finite);
  }
  EXPECT_EQ(last.crossings_body, 0);
  EXPECT_EQ(last.crossings_self, 0);
  EXPECT_EQ(last.released_vertices, 0);

  std::vector<Vec3> x(mesh.positions.size());
  (*solver)->system_positions(state, 0, x);
  for (Vec3& p : x) p.y() -= k_body_height;
  const std::span<const Vec3> theirs(drape.positions.data(), x.size());
  const Box box = bounds(x), their_box = bounds(theirs);
  const double area = area_of(mesh, x), their_area = area_of(mesh, theirs);
  EXPECT_NEAR(their_area, 0.6802, 1e-4);
  EXPECT_NEAR(area, their_area, 0.02 * their_area);
  EXPECT_NEAR(box.lo.y(), their_box.lo.y(), 0.015);
  EXPECT_NEAR(box.hi.y(), their_box.hi.y(), 0.015);

  double widest = 0;
  for (const Stitch& s : mesh.stitches)
    widest = std::max(widest, (x[at(s.vertex)] - (1 - s.place) * x[at(s.edge[0])] - s.place * x[at(s.edge[1])]).norm());
  EXPECT_LT(widest, 1e-3);

  const auto d = distances_after_alignment(x, theirs);
  const auto percentile = [&](std::size_t p) { return d[(d.size() - 1) * p / 100]; };
  const auto record = [](const char* name, double value) {
    RecordProperty(name, std::to_string(value));
    std::printf("%s %.6f\n", name, value);
  };
  record("area_m2", area);
  record("lowest_m", box.lo.y());
  record("highest_m", box.hi.y());
  record("widest_seam_mm", 1e3 * widest);
  record("strain_p99", last.strain_p99);
  record("distance_median_mm", 1e3 * percentile(50));
  record("distance_p90_mm", 1e3 * percentile(90));
  record("distance_p99_mm", 1e3 * percentile(99));
  record("distance_max_mm", 1e3 * d.back());
}

}  // namespace
}  // namespace ft
