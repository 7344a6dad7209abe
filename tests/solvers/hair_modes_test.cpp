// How fast strands swing, through the solver: a clamped beam and a heavy chain in their first modes, against their
// closed forms. Amplitudes are small, nothing is lost to drag or damping, and nothing is met.
#include "baker/core/parallel.h"
#include "baker/core/state_points.h"
#include "tests/solvers/hair_scenes.h"
#include "tests/solvers/rods.h"

namespace ft {
namespace {

using namespace test;

/// One strand, straight down from the lowest place of a ball; it loses nothing.
HairSetup straight_down(double length, int vertices, double fps) {
  HairSetup setup;
  setup.preroll_frames = 0;
  setup.fps = fps;
  setup.scalp = rigid_body(sphere_surface(k_head, 3), Vec3::Zero());
  HairStrand strand;
  for (int i = 0; i < vertices; ++i) strand.positions.emplace_back(0, -k_head - length * i / (vertices - 1), 0);
  setup.strands.push_back(std::move(strand));
  setup.material.damping = setup.material.drag = setup.material.air_drag = 0;
  return setup;
}

/// Starts it in a mode, given by its place along the strand (0 at the root, 1 at the tip), as a velocity along x of
/// `speed` at the tip [m/s]. Returns by how many oscillations a second the strand's part in that mode swings, in the
/// mean of so many of them [Hz].
double frequency(const HairSetup& setup, const std::function<double(double)>& mode, double speed, int oscillations) {
  const ThreadLimit limit(1);  // one strand is no work for two
  const auto solver = solver_of(setup);
  EXPECT_EQ(solver->stiffened()[0], 1);
  State state = solver->initial_state();
  const int n = solver->vertices();
  std::vector<double> weights(at(n));
  const auto v = as_points(state.block("v"));
  for (int i = 1; i < n; ++i) {
    weights[at(i)] = mode(static_cast<double>(i) / (n - 1)) * (i + 1 < n ? 1 : 0.5);
    v[at(i + 1)].x() = speed * mode(static_cast<double>(i) / (n - 1)) / mode(1);  // 0 is the ghost
  }
  // From one upward crossing of zero to a later one, each found between frames.
  std::vector<double> crossings;
  double before = 0;
  for (int f = 1; at(oscillations) >= crossings.size(); ++f) {
    const FrameReport report = solver->advance_frame(state);
    EXPECT_EQ(report.own.at("hair_unsettled"), 0);
    const auto x = as_points(*state.find("x"));
    double now = 0;
    for (int i = 1; i < n; ++i) now += weights[at(i)] * x[at(i + 1)].x();
    if (before < 0 && now >= 0) crossings.push_back((f - now / (now - before)) / setup.fps);
    before = now;
    if (f > 20 * oscillations * setup.fps) return 0;  // it does not swing
  }
  return oscillations / (crossings.back() - crossings.front());
}

TEST(HairModes, A_clamped_strand_of_two_centimetres_swings_as_a_beam_does) {
  // Euler and Bernoulli's cantilever: w = b^2 sqrt(EI / (m L^4)), b the first root of 1 + cos b cosh b = 0.
  const OneHair m;
  const double length = 0.02, b = 1.8751041, shape = 0.7340955;
  const double exact =
      b * b * std::sqrt(m.bend() / (m.density * m.area() * std::pow(length, 4))) / (2 * std::numbers::pi);
  EXPECT_NEAR(exact, 48.1, 0.02);
  const auto mode = [&](double s) {
    return std::cosh(b * s) - std::cos(b * s) - shape * (std::sinh(b * s) - std::sin(b * s));
  };
  // Four steps a frame. The tip goes 0.2 mm either way.
  double now[2];
  for (const int k : {0, 1}) {
    HairSetup setup = straight_down(length, 32, k == 0 ? 500 : 1000);
    setup.gravity.setZero();
    now[k] = frequency(setup, mode, 0.06, 12);
    printf("h = 1/%d s: %.3f Hz, exact %.3f\n", k == 0 ? 2000 : 4000, now[k], exact);
    EXPECT_NEAR(now[k], exact, 0.01 * exact);
  }
  // BDF2 is late by (w h)^2 / 3, a quarter with half the step; what is left is of the mesh.
  const double left = (4 * now[1] - now[0]) / 3;
  printf("without steps: %.3f Hz\n", left);
  EXPECT_NEAR(left, exact, 0.002 * exact);
  const double late = 4 * std::pow(std::numbers::pi * exact / 2000, 2) / 3;
  EXPECT_NEAR((left - now[0]) / exact, late, 0.1 * late);
}

TEST(HairModes, A_tassel_swings_as_a_heavy_chain_does) {
  // Bernoulli's chain: w = j0 / 2 sqrt(g / L), in J0(j0 sqrt(1 - s)); j0 = 2.40483 is J0's first root. Of a strand of a
  // ten thousandth of a hair's stiffness, in which bending reaches 0.1 % of the length from the root. Steps are those
  // of any bake: four a frame of 1/24 s.
  const double j0 = 2.4048256;
  for (const double length : {0.15, 0.3})
    for (const int vertices : {16, 32}) {
      HairSetup setup = straight_down(length, vertices, 24);
      setup.material.stiffness = 1e-4;
      const double exact = 0.5 * j0 * std::sqrt(k_gravity / length) / (2 * std::numbers::pi);
      // The tip goes 2 % of the length either way.
      const double speed = 0.02 * length * 2 * std::numbers::pi * exact;
      const double now = frequency(
          setup, [&](double s) { return std::cyl_bessel_j(0, j0 * std::sqrt(1 - s)); }, speed, 10);
      printf("%.2f m, %d vertices: %.4f Hz, exact %.4f\n", length, vertices, now, exact);
      EXPECT_NEAR(now, exact, 0.01 * exact);
    }
}

}  // namespace
}  // namespace ft
