// The visible surface of cords: round, closed, and without jumps, however the cords hang.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "baker/core/parallel.h"
#include "solvers/cords/generators.h"
#include "solvers/cords/tubes.h"

namespace ft {
namespace {

constexpr double k_radius = 2e-3;

std::vector<Vec3> placed(const CordTubes& tubes, std::span<const Vec3> points) {
  std::vector<Vec3> out(tubes.mesh().positions.size());
  tubes.place(points, out);
  return out;
}

template <class Move>
std::vector<Vec3> moved(std::span<const Vec3> points, Move&& move) {
  std::vector<Vec3> out;
  for (const Vec3& p : points) out.push_back(move(p));
  return out;
}

double volume(const Mesh& mesh, std::span<const Vec3> positions) {
  double six = 0;
  for (const Triangle& t : triangulate(mesh))
    six += positions[at(t[0])].dot(positions[at(t[1])].cross(positions[at(t[2])]));
  return six / 6;
}

double largest_step(std::span<const Vec3> a, std::span<const Vec3> b) {
  double out = 0;
  for (std::size_t i = 0; i < a.size(); ++i) out = std::max(out, (a[i] - b[i]).norm());
  return out;
}

TEST(CordTubes, Are_closed_and_turned_outwards) {
  const CordGraph net = diamond_net({});
  const CordTubes tubes(net, k_radius);
  std::map<std::pair<int, int>, int> sides;
  const Mesh& mesh = tubes.mesh();
  for (std::size_t f = 0; f < mesh.face_sizes.size(); ++f) {
    ASSERT_EQ(mesh.face_sizes[f], 4);
    for (std::size_t k = 0; k < 4; ++k)
      ++sides[{mesh.face_vertices[4 * f + k], mesh.face_vertices[4 * f + (k + 1) % 4]}];
  }
  for (const auto& [side, count] : sides) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(sides.contains({side.second, side.first})) << "an open side";
  }
  double length = 0;
  for (const auto& [a, b] : net.cords) length += (net.points[at(a)] - net.points[at(b)]).norm();
  const double section = 1.5 * std::sqrt(3.0) * k_radius * k_radius;  // of a hexagon
  EXPECT_NEAR(volume(mesh, mesh.positions), section * length, 0.01 * section * length) << "negative if turned inwards";
}

TEST(CordTubes, Know_the_ring_of_every_point) {
  CordGraph graph;
  graph.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {5, 5, 5}};
  graph.cords = {{0, 1}, {1, 2}, {1, 3}};
  graph.strands = {{2, 1, 0}, {3, 1}};
  const CordTubes tubes(graph, 0.01);
  for (int point = 0; point < 4; ++point) {
    const int first = tubes.vertex_of(point);
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < CordTubes::k_sides; ++k) sum += tubes.mesh().positions[at(first + k)] / CordTubes::k_sides;
    EXPECT_LT((sum - graph.points[at(point)]).norm(), 1e-2) << point;
  }
  EXPECT_EQ(tubes.vertex_of(4), -1);
}

TEST(CordTubes, Keep_their_radius_through_bends) {
  const CordGraph net = diamond_net({});
  const CordTubes tubes(net, k_radius);
  // A bulge as a ball makes it, so that every twine bends.
  const auto points = moved(net.points, [](const Vec3& p) {
    const double wide = 1 + 0.6 * std::exp(-std::pow((p.y() + 0.3) / 0.06, 2));
    return Vec3(p.x() * wide, p.y(), p.z() * wide);
  });
  const std::vector<Vec3> out = placed(tubes, points);
  std::size_t v = 0;
  for (const auto& strand : net.strands)
    for (std::size_t i = 0; i < strand.size(); ++i)
      for (int k = 0; k < CordTubes::k_sides; ++k, ++v)
        for (const std::size_t cord : {i > 0 ? i - 1 : 0, std::min(i, strand.size() - 2)}) {
          const Vec3 a = points[at(strand[cord])], b = points[at(strand[cord + 1])];
          const double distance = (out[v] - a).cross((b - a).normalized()).norm();
          EXPECT_NEAR(distance, k_radius, 1e-12);
        }
}

TEST(CordTubes, Move_along_when_all_is_moved_rigidly) {
  const CordGraph net = diamond_net({});
  const CordTubes tubes(net, k_radius);
  for (const double angle : {0.3, 1.7, 3.1, 4.5}) {
    const Quat turn(Eigen::AngleAxisd(angle, Vec3(1, 2, -0.5).normalized()));
    const auto move = [&](const Vec3& p) { return Vec3(turn * p + Vec3(3, -1, 2)); };
    EXPECT_LT(largest_step(placed(tubes, moved(net.points, move)), moved(tubes.mesh().positions, move)), 1e-12);
  }
}

/// Largest step of any vertex against its point, of a rope that turns once about `axis` in `steps` steps.
double largest_step_around(const Vec3& rope_end, const Vec3& axis, int steps) {
  RopeMeasures measures;
  measures.to = rope_end;
  measures.pieces = 5;
  const CordGraph cord = rope(measures);
  const CordTubes tubes(cord, k_radius);
  const auto arms = [&](double angle) {
    const Quat turn(Eigen::AngleAxisd(angle, axis));
    const auto points = moved(cord.points, [&](const Vec3& p) { return Vec3(turn * p); });
    std::vector<Vec3> out = placed(tubes, points);
    for (std::size_t v = 0; v < out.size(); ++v) out[v] -= points[v / CordTubes::k_sides];
    return out;
  };
  double largest = 0;
  for (int i = 0; i < steps; ++i) {
    const double step = 2 * std::numbers::pi / steps;
    largest = std::max(largest, largest_step(arms((i + 0.5) * step), arms((i + 1.5) * step)));
  }
  return largest;
}

TEST(CordTubes, Do_not_flip_when_a_rope_swings_through_the_vertical_or_all_around) {
  constexpr int k_steps = 720;
  const double step = 2 * std::numbers::pi / k_steps * k_radius;
  for (const Vec3& end : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 1, 0)})  // through the vertical, up and down
    EXPECT_LT(largest_step_around(end, Vec3::UnitZ(), k_steps), 1.001 * step) << end.transpose();
  // Around it, in a cone: about itself it turns as far as the cone is wide.
  for (const double down : {-3.0, -0.5, 0.0})
    EXPECT_LT(largest_step_around(Vec3(1, down, 0), Vec3::UnitY(), k_steps), 1.5 * step) << down;
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0.6, 0.8, 0)})  // past the vertical at some distance
    EXPECT_LT(largest_step_around(Vec3(0.3, -0.5, 0.8), axis, k_steps), 8 * step) << axis.transpose();
}

TEST(CordTubes, Follow_a_net_that_is_swept_aside_without_a_jump) {
  const CordGraph net = diamond_net({});
  const CordTubes tubes(net, k_radius);
  std::vector<Vec3> before = tubes.mesh().positions;
  std::vector<Vec3> points_before = net.points;
  for (int i = 1; i <= 400; ++i) {
    // The lower it is, the further it swings: beyond the horizontal, to and fro.
    const double swing = 2.2 * std::sin(2 * std::numbers::pi * i / 400);
    const auto points = moved(
        net.points, [&](const Vec3& p) { return Vec3(Eigen::AngleAxisd(swing * p.y() / -0.42, Vec3::UnitZ()) * p); });
    const std::vector<Vec3> now = placed(tubes, points);
    EXPECT_LT(largest_step(before, now), largest_step(points_before, points) + 0.5 * k_radius) << i;
    before = now, points_before = points;
  }
}

TEST(CordTubes, Of_points_in_one_place_and_of_folded_strands_are_finite_and_thin) {
  RopeMeasures measures;
  measures.to = Vec3(0, -1, 0);
  measures.pieces = 6;
  const CordGraph cord = rope(measures);
  const CordTubes tubes(cord, k_radius);
  const std::vector<std::vector<Vec3>> cases = {
      std::vector<Vec3>(7, Vec3(1, 2, 3)),
      {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 1, 0}, {0, 0, 0}, {0, 0, 0}},
      {{0, 0, 0}, {0, -1, 0}, {0, 0, 0}, {0, -1, 0}, {0, 0, 0}, {0, -1, 0}, {0, 0, 0}},
      {{0, 0, 0}, {0, 1e-300, 0}, {0, 1, 0}, {0, 1, 1e-200}, {0, 1, 1}, {1e-9, 1, 1}, {0, 1, 1}},
  };
  for (const auto& points : cases) {
    const std::vector<Vec3> out = placed(tubes, points);
    for (std::size_t v = 0; v < out.size(); ++v) {
      const double distance = (out[v] - points[v / CordTubes::k_sides]).norm();
      EXPECT_GE(distance, k_radius * (1 - 1e-9));
      EXPECT_LE(distance, 2 * k_radius * (1 + 1e-9)) << "a mitre of twice the radius at most";
    }
  }
  const CordGraph net = diamond_net({});
  EXPECT_TRUE(all_finite(placed(CordTubes(net, k_radius), std::vector<Vec3>(net.points.size(), Vec3(1, 1, 1)))));
}

TEST(CordTubes, Are_the_same_bits_for_any_number_of_threads) {
  const CordGraph net = diamond_net({.columns = 40, .rows = 20});
  const CordTubes tubes(net, k_radius);
  const auto points =
      moved(net.points, [](const Vec3& p) { return Vec3(p.x() + p.y() * p.y(), p.y(), p.z() * p.x()); });
  std::vector<Vec3> one;
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    const std::vector<Vec3> out = placed(tubes, points);
    if (one.empty()) one = out;
    EXPECT_EQ(out, one);
  }
}

}  // namespace
}  // namespace ft
