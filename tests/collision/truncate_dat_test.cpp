// Divide and truncate, put to an adversary: pairs at all distances and of all shapes are pushed at each other by huge
// random steps, again and again. After every update the features must still be separated by a plane: not the one that
// was used to truncate but, independently, any plane that the moved features admit. Without such a plane the count goes
// up.
#include "collision/step_bound/truncate_dat.h"

#include <gtest/gtest.h>

#include "baker/core/parallel.h"
#include "tests/collision/pair_scene.h"

namespace ft {
namespace {

using test::Dice;
using test::random_stencil;
using test::stays_apart;

constexpr double k_floor = 1e-5;

/// With nothing in common.
PairMove move_of(const std::array<Vec3, 4>& x, std::array<Vec3, 4> dx, const std::array<bool, 4>& movable) {
  for (std::size_t i = 0; i < 4; ++i)
    if (!movable[i]) dx[i].setZero();
  const Vec3 zero = Vec3::Zero();
  return {x, dx, {zero, zero, zero, zero}, movable};
}

struct Tally {
  int updates = 0, crossed = 0;
  double lowest = 1;  ///< smallest distance after any update [m]
};

Tally attack(PairKind kind, double from_origin, int pairs, std::uint64_t seed) {
  Tally tally;
  Dice dice(seed);
  for (int p = 0; p < pairs; ++p) {
    const double scale = std::pow(10, dice.uniform(-3, 0));
    std::array<Vec3, 4> x = random_stencil(dice, scale);
    const Vec3 place = from_origin * dice.direction();
    for (Vec3& v : x) v += place;
    const PairGeometry start = pair_geometry(kind, x);
    if (!separates(kind, x, start, 1.01 * k_floor)) {  // the attack begins with a state that is allowed
      const Vec3 away = start.distance > 0 ? start.normal : dice.direction();
      for (int i = 0; i < first_feature_size(kind); ++i)
        x[static_cast<std::size_t>(i)] += away * dice.uniform(1.5, 40) * k_floor;
      if (!separates(kind, x, pair_geometry(kind, x), 1.01 * k_floor)) continue;
    }
    std::array<bool, 4> movable{true, true, true, true};
    const int still = dice.below(4);  // none, the first feature, the second, single vertices
    for (std::size_t i = 0; i < 4; ++i) {
      const bool first = static_cast<int>(i) < first_feature_size(kind);
      if (still == 1 ? first : still == 2 ? !first : still == 3 && dice.below(3) == 0) movable[i] = false;
    }
    for (int step = 0; step < 20; ++step) {
      std::array<Vec3, 4> dx;
      const double reach = scale * std::pow(10, dice.uniform(-4, 1));
      const PairGeometry now = pair_geometry(kind, x);
      for (std::size_t i = 0; i < 4; ++i) {
        const double side = static_cast<int>(i) < first_feature_size(kind) ? -1 : 1;
        dx[i] = reach * (dice.direction() + side * dice.uniform(0, 2) * now.normal);
      }
      const std::array<double, 4> share = truncate_pair(kind, move_of(x, dx, movable), k_floor);
      std::array<Vec3, 4> next = x, moved;
      for (std::size_t i = 0; i < 4; ++i) {
        if (movable[i]) next[i] = x[i] + share[i] * dx[i];
        moved[i] = next[i] - x[i];
      }
      ++tally.updates;
      if (!stays_apart(kind, x, moved)) ++tally.crossed;
      tally.lowest = std::min(tally.lowest, pair_geometry(kind, next).distance);
      x = next;
    }
  }
  return tally;
}

void expect_no_crossing(PairKind kind, double from_origin) {
  std::vector<Tally> tallies(16);
  parallel_tasks(tallies.size(), [&](std::size_t i) { tallies[i] = attack(kind, from_origin, 4600, 100 + i); });
  Tally total;
  for (const Tally& t : tallies) {
    total.updates += t.updates;
    total.crossed += t.crossed;
    total.lowest = std::min(total.lowest, t.lowest);
  }
  EXPECT_GE(total.updates, 1000000);
  EXPECT_EQ(total.crossed, 0);
  // Where two closest pairs of a slim feature are equally near to the last bit, the plane may be tilted by 1e-8;
  // sliding ten feature lengths along it then loses some nanometres of the floor.
  EXPECT_GE(total.lowest, 0.998 * k_floor);
  std::printf("  %d updates, %d crossed, lowest %.9g m\n", total.updates, total.crossed, total.lowest);
}

TEST(Truncation, No_vertex_crosses_a_face_in_a_million_hostile_updates_at_1_m_slow) {
  expect_no_crossing(PairKind::k_vertex_face, 1);
}
TEST(Truncation, No_vertex_crosses_a_face_in_a_million_hostile_updates_at_100_m_slow) {
  expect_no_crossing(PairKind::k_vertex_face, 100);
}
TEST(Truncation, No_edge_crosses_an_edge_in_a_million_hostile_updates_at_1_m_slow) {
  expect_no_crossing(PairKind::k_edge_edge, 1);
}
TEST(Truncation, No_edge_crosses_an_edge_in_a_million_hostile_updates_at_100_m_slow) {
  expect_no_crossing(PairKind::k_edge_edge, 100);
}

TEST(Truncation, The_judge_of_this_file_sees_a_crossing) {
  std::array<Vec3, 4> x{Vec3(0.2, 0.2, 1), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, dx{};
  for (Vec3& d : dx) d.setZero();
  dx[0] = Vec3(0, 0, -2);
  EXPECT_FALSE(stays_apart(PairKind::k_vertex_face, x, dx));
  dx[0] = Vec3(0, 0, -0.9);
  EXPECT_TRUE(stays_apart(PairKind::k_vertex_face, x, dx));
  x = {Vec3(-1, 0, 1), Vec3(1, 0, 1), Vec3(0, -1, 0), Vec3(0, 1, 0)};
  dx = {Vec3(0, 0, -2), Vec3(0, 0, -2), Vec3(0, 0, 0), Vec3(0, 0, 0)};
  EXPECT_FALSE(stays_apart(PairKind::k_edge_edge, x, dx));
}

TEST(Truncation, A_vertex_falling_on_a_still_face_may_use_nine_tenths_of_the_room) {
  const std::array<Vec3, 4> x{Vec3(0.2, 0.2, 1), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const std::array<Vec3, 4> dx{Vec3(0, 0, -2), Vec3(0, 0, 5), Vec3(0, 0, 5), Vec3(0, 0, 5)};
  const auto share = truncate_pair(PairKind::k_vertex_face, move_of(x, dx, {true, false, false, false}), 0.1);
  EXPECT_NEAR(share[0], 0.9 * 0.9 / 2, 1e-15);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(share[i], 1);
}

TEST(Truncation, Two_that_approach_share_the_room_as_they_approach) {
  const std::array<Vec3, 4> x{Vec3(-1, 0, 1), Vec3(1, 0, 1), Vec3(0, -1, 0), Vec3(0, 1, 0)};
  const std::array<Vec3, 4> dx{Vec3(0, 0, -3), Vec3(0, 0, -3), Vec3(0, 0, 1), Vec3(0, 0, 1)};
  const auto share = truncate_pair(PairKind::k_edge_edge, move_of(x, dx, {true, true, true, true}), 0);
  for (const double t : share) EXPECT_NEAR(t, 0.9 * 0.25, 1e-15);
}

TEST(Truncation, Who_leaves_or_slides_is_not_held_back) {
  const std::array<Vec3, 4> x{Vec3(0.2, 0.2, 0.5 * k_floor), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  for (const Vec3& d : {Vec3(0, 0, 1), Vec3(5, -3, 0)}) {
    const std::array<Vec3, 4> dx{d, Vec3(0, 0, 0), Vec3(0, 0, -1), Vec3(0, 0, 0)};
    for (const double t : truncate_pair(PairKind::k_vertex_face, move_of(x, dx, {true, true, true, true}), k_floor))
      EXPECT_EQ(t, 1);
  }
}

TEST(Truncation, A_pair_nearer_than_the_floor_comes_no_nearer) {
  std::array<Vec3, 4> x{Vec3(0.2, 0.2, 0.3 * k_floor), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const std::array<Vec3, 4> dx{Vec3(0, 0, -1), Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)};
  EXPECT_NEAR(truncate_pair(PairKind::k_vertex_face, move_of(x, dx, {true, true, true, true}), k_floor)[0], 0, 1e-18);
}

TEST(Truncation, A_pair_that_touches_allows_no_motion) {
  const std::array<Vec3, 4> x{Vec3(0.2, 0.2, 0), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const std::array<Vec3, 4> dx{Vec3(0, 0, 1), Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)};
  const auto share = truncate_pair(PairKind::k_vertex_face, move_of(x, dx, {true, true, false, true}), k_floor);
  EXPECT_EQ(share, (std::array<double, 4>{0, 0, 1, 0}));
}

struct Soup {
  std::vector<Vec3> x, dx;
  ContactPairs pairs;
  int movable_count = 0;
};

Soup make_soup(std::uint64_t seed) {
  Soup soup;
  Dice dice(seed);
  const int n = 400;
  soup.movable_count = 300;
  for (int i = 0; i < n; ++i) {
    soup.x.push_back(dice.cube(0.2));
    soup.dx.push_back(dice.cube(std::pow(10, dice.uniform(-5, -1))));
  }
  for (int k = 0; k < 20000; ++k) {
    std::array<int, 4> v;
    for (int& i : v) i = dice.below(n);
    std::array<int, 4> sorted = v;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) continue;
    (k % 2 ? soup.pairs.vertex_face : soup.pairs.edge_edge).push_back({v});
  }
  return soup;
}

TEST(Truncation, Share_of_a_vertex_is_the_least_over_its_pairs_and_the_early_way_out_changes_nothing) {
  const Soup soup = make_soup(31);
  const auto n = static_cast<std::size_t>(soup.movable_count);
  std::vector<double> share(n), expected(n, 1.0);
  const std::vector<Vec3> still(n, Vec3::Zero());
  truncate_displacements(soup.x, soup.dx, still, soup.movable_count, soup.pairs, k_floor, share);
  for (const PairKind kind : {PairKind::k_vertex_face, PairKind::k_edge_edge}) {
    for (const Stencil& s : kind == PairKind::k_vertex_face ? soup.pairs.vertex_face : soup.pairs.edge_edge) {
      std::array<Vec3, 4> x, dx;
      std::array<bool, 4> movable;
      for (std::size_t i = 0; i < 4; ++i) {
        const auto v = static_cast<std::size_t>(s.v[i]);
        x[i] = soup.x[v], dx[i] = soup.dx[v], movable[i] = v < n;
      }
      const auto own = truncate_pair(kind, move_of(x, dx, movable), k_floor);
      for (std::size_t i = 0; i < 4; ++i)
        if (movable[i])
          expected[static_cast<std::size_t>(s.v[i])] = std::min(expected[static_cast<std::size_t>(s.v[i])], own[i]);
    }
  }
  EXPECT_EQ(share, expected);
  EXPECT_GT(std::count_if(share.begin(), share.end(), [](double t) { return t > 0 && t < 1; }), 100);
}

TEST(Truncation, Shares_are_the_same_bits_for_any_thread_count_and_any_order_of_pairs) {
  Soup soup = make_soup(32);
  std::vector<double> first(static_cast<std::size_t>(soup.movable_count)), share = first;
  const std::vector<Vec3> still(first.size(), Vec3::Zero());
  truncate_displacements(soup.x, soup.dx, still, soup.movable_count, soup.pairs, k_floor, first);
  for (const int threads : {1, 2, 3, 8}) {
    const ThreadLimit limit(threads);
    std::reverse(soup.pairs.vertex_face.begin(), soup.pairs.vertex_face.end());
    std::rotate(soup.pairs.edge_edge.begin(), soup.pairs.edge_edge.begin() + 777, soup.pairs.edge_edge.end());
    truncate_displacements(soup.x, soup.dx, still, soup.movable_count, soup.pairs, k_floor, share);
    EXPECT_EQ(first, share) << threads << " threads";
  }
}

}  // namespace
}  // namespace ft
