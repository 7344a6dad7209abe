// A body that is cut to another place: the cloth goes along, and nothing else of it changes.
#include <gtest/gtest.h>

#include "solvers/cloth/advance/body_advance.h"
#include "solvers/cloth/cloth_solver.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

constexpr int k_cut = 9;
constexpr double k_fps = 24;

Eigen::Isometry3d placed(double angle, const Vec3& to) {
  return Eigen::Translation3d(to) * Eigen::AngleAxisd(angle, Vec3::UnitY());
}

/// A ball that wanders, from frame k_cut on seen from elsewhere; between the two frames it is smeared over the way.
std::shared_ptr<ScriptedBody> wandering_ball(const Eigen::Isometry3d& elsewhere) {
  Surface surface;
  std::vector<Vec3> points;
  make_sphere(0.2, 12, 16, points, surface.triangles);
  const double cut = (k_cut - 1) / k_fps;  // the shot's first frame is 1
  return std::make_shared<ScriptedBody>(surface, points, 0, [elsewhere, cut](double time, std::span<Vec3> x) {
    const double share = std::clamp(1 + (time - cut) * k_fps, 0.0, 1.0);
    for (Vec3& p : x) {
      p += Vec3(0.5 * time, 0, 0.2 * time);
      if (share > 1e-9) p = (1 - share) * p + share * (elsewhere * p);
    }
  });
}

/// Lying on the ball, or held above it by its rim.
ClothSetup sheet_on(std::shared_ptr<const Trajectory> body, bool held) {
  ClothSetup setup;
  setup.primary = std::move(body);
  setup.preroll_frames = 0;
  setup.fps = k_fps;
  ClothGarment sheet;
  sheet.name = "sheet";
  sheet.mesh = make_sheet(0.5, 12, held ? 0.3 : 0.21);
  if (held) {
    ClothPin rim;
    for (int i = 0; i < 13 * 13; ++i)
      if (i % 13 == 0 || i % 13 == 12 || i / 13 == 0 || i / 13 == 12) rim.vertices.push_back(i);
    sheet.pins.push_back(rim);
    // Solved to the end: what single precision leaves of a coarse solve depends on the last bit of where the cloth is.
    setup.newton_iterations = 30;
    setup.linear_tolerance = 1e-6;
  }
  setup.garments.push_back(std::move(sheet));
  return setup;
}

struct Walked {
  std::vector<std::vector<Vec3>> x;
  std::vector<FrameReport> reports;
};

Walked walk(ClothSetup setup, int frames) {
  auto solver = make_cloth_solver(std::move(setup));
  EXPECT_TRUE(solver);
  Walked out;
  State state = (*solver)->initial_state();
  for (int f = 0; f < frames; ++f) {
    out.reports.push_back((*solver)->advance_frame(state));
    out.x.emplace_back(at((*solver)->system_mesh(0).vertex_count()));
    (*solver)->system_positions(state, 0, out.x.back());
  }
  return out;
}

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b, const Eigen::Isometry3d& moved) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (moved * a[i] - b[i]).norm());
  return most;
}

void expect_nothing_changes(bool held, double tolerance) {
  const Walked still = walk(sheet_on(wandering_ball(Eigen::Isometry3d::Identity()), held), 11);
  for (const auto& elsewhere : {placed(0, Vec3(3, 0, 0)), placed(2, Vec3(-1, 0.5, 2))}) {
    ClothSetup setup = sheet_on(wandering_ball(elsewhere), held);
    setup.teleports.push_back({k_cut, elsewhere, Vec3::Zero()});
    const Walked cut = walk(std::move(setup), 11);
    for (std::size_t f = 0; f < cut.x.size(); ++f) {
      const bool there = cut.reports[f].frame >= k_cut;
      EXPECT_LT(farthest(still.x[f], cut.x[f], there ? elsewhere : Eigen::Isometry3d::Identity()), tolerance)
          << cut.reports[f].frame;
      EXPECT_NEAR(cut.reports[f].strain_max, still.reports[f].strain_max, 100 * tolerance) << cut.reports[f].frame;
      EXPECT_EQ(cut.reports[f].crossings_body, 0) << cut.reports[f].frame;
    }
  }
}

TEST(Teleport, of_the_body_changes_nothing_in_the_frame_of_the_body) {
  expect_nothing_changes(true, 1e-9);
}

// Contact and three Newton iterations in single precision make 1e-7 of the rounding of the new place within a few
// frames.
TEST(Teleport, of_the_body_changes_nothing_for_cloth_that_lies_on_it) {
  expect_nothing_changes(false, 2e-6);
}

TEST(Teleport, that_nobody_names_tears_at_the_cloth) {
  // What the carrying is for: the same cut, simulated as motion.
  const Walked torn = walk(sheet_on(wandering_ball(placed(0, Vec3(3, 0, 0))), false), k_cut);
  const Walked still = walk(sheet_on(wandering_ball(Eigen::Isometry3d::Identity()), false), k_cut);
  EXPECT_GT(farthest(still.x.back(), torn.x.back(), placed(0, Vec3(3, 0, 0))), 0.1);
}

TEST(Teleport, into_another_motion_gives_the_cloth_the_velocity_of_its_body) {
  ClothMotion m;
  m.x = {Vec3(1, 2, 3)};
  m.v = {Vec3(1, 0, 0)};
  m.h_previous = 0.01;
  m.x_previous = {m.x[0] - 0.01 * m.v[0]};
  m.v_previous = m.v;
  Teleport t{5, placed(std::numbers::pi / 2, Vec3(0, 0, 7)), Vec3(0, 0, 4)};
  carry(t, m);
  EXPECT_LT((m.v[0] - Vec3(0, 0, 3)).norm(), 1e-12);  // a quarter turn about y takes x to -z
  EXPECT_LT((m.x[0] - Vec3(3, 2, 6)).norm(), 1e-12);
  EXPECT_LT((m.x[0] - m.x_previous[0] - 0.01 * m.v[0]).norm(), 1e-12);
}

}  // namespace
}  // namespace ft
