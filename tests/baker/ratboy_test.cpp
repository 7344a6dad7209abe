// A real groom: TressFX's mohawk, 2,228 strands as they come, each rooted in a triangle of its own.
#include <gtest/gtest.h>

#include "baker/core/output_frame.h"
#include "io/hair/guides.h"
#include "solvers/hair/hair_solver.h"
#include "tests/support/assets.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

std::filesystem::path mohawk_file() {
  return test::assets_root() / "hair/tressfx_ratboy/Ratboy_mohawk.tfx";
}

/// It swings to and fro by 5 cm along z, twice a second, until `until` [s]; 0: it stands still.
HairSetup mohawk(double until) {
  HairSetup setup;
  setup.preroll_frames = 0;
  const auto guides = read_guides(mohawk_file(), 1);
  EXPECT_TRUE(guides) << guides.error().text();
  if (!guides) return setup;
  Surface surface;
  std::vector<Vec3> bind;
  for (std::size_t s = 0; s < guides->strands.size(); ++s) {
    HairStrand strand;
    strand.id = s;
    strand.positions = guides->strands[s];
    if (strand.positions.size() != 32) continue;  // what had a vertex twice
    const Vec3 root = strand.positions[0], way = (strand.positions[1] - root).normalized();
    const Vec3 side = way.unitOrthogonal(), other = way.cross(side);
    const int first = static_cast<int>(bind.size());
    for (const Vec3& corner : {Vec3(root + 1e-3 * side), Vec3(root - 1e-3 * side), Vec3(root + 1e-3 * other)})
      bind.push_back(corner);
    surface.triangles.push_back({first, first + 1, first + 2});
    setup.strands.push_back(std::move(strand));
  }
  setup.scalp = std::make_shared<ScriptedBody>(surface, bind, 0, [until](double t, std::span<Vec3> x) {
    if (t > 0 && t < until)
      for (Vec3& p : x) p.z() += 0.05 * std::sin(4 * std::numbers::pi * t);
  });
  return setup;
}

struct Drift {
  double most = 0, left = 0;  ///< m
  double longest = 0;
};
Drift drift_of(HairSetup setup, int frames) {
  auto solver = HairSolver::make(std::move(setup));
  EXPECT_TRUE(solver) << solver.error().text();
  State state = (*solver)->initial_state();
  FrameData start, now;
  (*solver)->system_frame(state, 0, start);
  Drift out;
  for (int f = 0; f < frames; ++f) {
    const FrameReport report = (*solver)->advance_frame(state);
    EXPECT_TRUE(report.finite);
    EXPECT_EQ(report.own.at("hair_unsettled"), 0) << f;
    out.longest = std::max(out.longest, report.strain_max);
    (*solver)->system_frame(state, 0, now);
    out.left = 0;
    for (std::size_t v = 0; v < now.positions.size(); ++v)
      out.left = std::max(out.left, static_cast<double>((now.positions[v] - start.positions[v]).norm()));
    out.most = std::max(out.most, out.left);
  }
  return out;
}

TEST(Ratboy, Every_strand_of_the_groom_stands_still_for_two_seconds_slow) {
  FT_REQUIRE_FILE(mohawk_file());
  const Drift drift = drift_of(mohawk(0), 48);
  printf("drift %.6f mm\n", 1e3 * drift.most);
  EXPECT_LT(drift.most, 0.0005);
}

TEST(Ratboy, After_it_was_shaken_every_strand_comes_back_to_where_it_was_combed_slow) {
  FT_REQUIRE_FILE(mohawk_file());
  const Drift drift = drift_of(mohawk(1), 24 * 5);
  printf("went %.0f mm, left %.4f mm, longest %.6f\n", 1e3 * drift.most, 1e3 * drift.left, drift.longest);
  EXPECT_GT(drift.most, 0.02);
  EXPECT_LT(drift.left, 0.001);
  EXPECT_LT(drift.longest, 0.001);
}

}  // namespace
}  // namespace ft
