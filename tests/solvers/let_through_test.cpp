// Cloth between parts that close until there is no room: the smaller one is let go, named, and when they open again the
// cloth is between them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/cloth/advance/body_advance.h"
#include "solvers/cloth/cloth_solver.h"
#include "solvers/cloth/model/cloth_model.h"
#include "tests/support/torture/shapes.h"

namespace ft {
namespace {

constexpr double k_plate = 0.02, k_open = 0.07;

/// Half the distance between the plates' inner faces [m]: they pass into each other by 2 mm and open again.
double half_gap(double t) {
  const double shut = torture::ease(t, 0.0, 0.5) - torture::ease(t, 0.6, 1.0);
  return 0.5 * (k_open + (-2e-3 - k_open) * shut);
}

/// A tube between two plates, the first of which is the larger part; `first` is its side.
ClothSetup tube_between_plates(double first) {
  const auto motion = [](double side) {
    return [side](double t) { return torture::shift({0, side * (half_gap(t) + 0.5 * k_plate), 0}); };
  };
  torture::RigidParts body;
  body.add("large", torture::box({0.14, k_plate, 0.12}), motion(first));
  body.add("small", torture::box({0.14, k_plate, 0.12}), motion(-first));
  ClothGarment tube;
  tube.name = "tube";
  tube.mesh = torture::grid("tube", 20, 8, true, [](double s, double t) {
    const double around = 2 * std::numbers::pi * s;
    return Vec3(0.03 * std::cos(around), 0.03 * std::sin(around), 0.07 * (t - 0.5));
  });
  ClothSetup setup;
  setup.primary = body.build();
  setup.preroll_frames = 0;
  setup.gravity.setZero();
  setup.garments.push_back(std::move(tube));
  setup.feasible.carve = false;
  return setup;
}

class LetThrough : public testing::TestWithParam<double> {};

TEST_P(LetThrough, Cloth_between_plates_without_room_comes_back_between_them) {
  auto solver = make_cloth_solver(tube_between_plates(GetParam()));
  ASSERT_TRUE(solver);
  State state = (*solver)->initial_state();
  bool was_let_through = false;
  FrameReport last;
  for (int f = 0; f < 28; ++f) {
    last = (*solver)->advance_frame(state);
    EXPECT_TRUE(last.finite) << last.frame;
    EXPECT_LT(last.strain_p99, 0.1) << last.frame;
    EXPECT_EQ(last.rewinds, 0) << last.frame;
    EXPECT_LT(last.substeps, 64) << last.frame;
    if (last.released_vertices == 0) continue;
    was_let_through = true;
    for (const Incident& i : last.incidents)
      EXPECT_EQ(i.text.find("at large"), std::string::npos) << "the larger part holds it: " << i.text;
  }
  EXPECT_TRUE(was_let_through);
  EXPECT_EQ(last.released_vertices, 0);
  EXPECT_EQ(last.crossings_body, 0);
  std::vector<Vec3> x(at((*solver)->system_mesh(0).vertex_count()));
  (*solver)->system_positions(state, 0, x);
  for (const Vec3& p : x) EXPECT_LT(std::abs(p.y()), half_gap(state.time));
}

struct Squeezed {
  int pieces = 0, released = 0;
  double work = 0;
  bool impatient = false;
};

/// The tube after the plates' way until t1 in one substep, all of whose shortened pieces are too short. patience: as
/// SubstepInput has it.
Squeezed squeezed(double t1, double patience = std::numeric_limits<double>::infinity()) {
  auto model = build_cloth_model(tube_between_plates(1));
  EXPECT_TRUE(model);
  ClothMotion cloth;
  cloth.x = cloth.x_previous = cloth.x_older = (*model)->start;
  cloth.v.assign(cloth.x.size(), Vec3::Zero());
  cloth.v_previous = cloth.v_older = cloth.v;
  cloth.absent.assign(at((*model)->collider->vertex_count()), 0);
  cloth.tangled.assign(cloth.x.size(), 0);
  const auto body_at = [&](double t) {
    std::vector<Vec3> drawn, feasible;
    (*model)->collider->drawn(t, drawn);
    (*model)->collider->feasible(t, drawn, feasible);
    return feasible;
  };
  const std::vector<Vec3> body_t0 = body_at(0), body_t1 = body_at(t1);
  SubstepInput in;
  in.body_t0 = body_t0;
  in.body_t1 = body_t1;
  const std::vector<char> none(body_t1.size(), 0);
  in.deep_t1 = none;
  in.h = in.shortest = t1;
  in.patience = patience;
  const AdvanceReport report = BodyAdvance(**model).substep(in, cloth);
  EXPECT_TRUE(report.finite);
  return {report.pieces, static_cast<int>(std::count(cloth.absent.begin(), cloth.absent.end(), 1)), report.work,
          report.impatient};
}

TEST(LetThrough, Blocked_cloth_gets_some_pieces_that_are_too_short_before) {
  const Squeezed with_room = squeezed(0.4), without = squeezed(0.5);
  EXPECT_GT(with_room.pieces, 1) << "nothing was in the way";
  EXPECT_EQ(with_room.released, 0);
  EXPECT_GT(without.released, 0);
  EXPECT_LT(without.pieces, 20);
}

TEST(LetThrough, Beyond_the_limit_of_work_what_blocks_is_let_go_at_once) {
  const Squeezed patient = squeezed(0.4), hasty = squeezed(0.4, 0), enough = squeezed(0.4, 10 * patient.work);
  EXPECT_FALSE(patient.impatient);
  EXPECT_TRUE(hasty.impatient);
  EXPECT_GT(hasty.released, 0) << "there is room, if it takes its time";
  EXPECT_LT(hasty.pieces, patient.pieces);
  EXPECT_LT(hasty.work, patient.work);
  EXPECT_FALSE(enough.impatient);
  EXPECT_EQ(enough.released, 0);
}

INSTANTIATE_TEST_SUITE_P(side, LetThrough, testing::Values(-1.0, 1.0));

}  // namespace
}  // namespace ft
