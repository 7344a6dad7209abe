// A body with fewer triangles around the one that was given.
#include "collision/simplify/coarse_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/collision/capsule_scene.h"
#include "tests/support/scripted_body.h"

namespace ft::test {
namespace {

constexpr double k_long = 0.06, k_off = 2e-3;

Eigen::Isometry3d far_pose() {
  return Eigen::Translation3d(3, 1, -2) * Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized());
}

std::shared_ptr<const Trajectory> body_of(Surface surface, std::vector<Vec3> bind) {
  const auto turn = [](double time, std::span<Vec3> x) {
    if (time > 0)
      for (Vec3& p : x) p = far_pose() * p;
  };
  return std::make_shared<ScriptedBody>(std::move(surface), std::move(bind), 0.5, turn);
}

std::shared_ptr<const Trajectory> ball(double radius, int rings, int segments) {
  Surface surface;
  std::vector<Vec3> bind;
  make_sphere(radius, rings, segments, bind, surface.triangles);
  return body_of(std::move(surface), std::move(bind));
}

std::vector<Vec3> bind_of(const Trajectory& body) {
  std::vector<Vec3> out(at(body.surface().vertex_count()));
  body.bind_pose(out);
  return out;
}

bool is_closed(std::span<const Triangle> triangles) {
  std::map<Edge, int> uses;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
      ++uses[{a, b}];
    }
  return std::all_of(uses.begin(), uses.end(), [](const auto& u) { return u.second == 2; });
}

TEST(CoarseBody, A_ball_has_far_fewer_triangles_and_the_given_one_lies_inside) {
  constexpr double k_radius = 0.12;
  const auto fine = ball(k_radius, 48, 96);
  const auto coarse = coarse_body(fine, 2, k_long, k_off);
  const Surface& surface = coarse->surface();
  EXPECT_LT(2 * surface.triangles.size(), fine->surface().triangles.size());
  EXPECT_TRUE(is_closed(surface.triangles));
  const std::vector<Vec3> x = bind_of(*coarse);
  double least = 1, most = 0;  // of the coarse surface from the centre, on the way to the given vertices
  for (const Vec3& p : bind_of(*fine)) {
    int met = 0;
    for (const Triangle& t : surface.triangles) {
      Mat3 corners;
      for (std::size_t k = 0; k < 3; ++k) corners.col(static_cast<Eigen::Index>(k)) = x[at(t[k])];
      const Vec3 weight = corners.fullPivLu().solve(p.normalized());
      if ((weight.array() < -1e-9).any()) continue;
      ++met;
      least = std::min(least, 1 / weight.sum());
      most = std::max(most, 1 / weight.sum());
    }
    EXPECT_GE(met, 1);
  }
  EXPECT_GT(least, k_radius - 0.1 * k_off);
  EXPECT_LT(most, k_radius + 2 * k_off);
}

TEST(CoarseBody, It_moves_with_the_given_one_and_keeps_its_times) {
  const auto fine = ball(0.1, 24, 48);
  const auto coarse = coarse_body(fine, 2, k_long, k_off);
  EXPECT_EQ(coarse->preroll(), fine->preroll());
  EXPECT_TRUE(coarse->bind_to_start().isApprox(fine->bind_to_start()));
  std::vector<Vec3> x = bind_of(*coarse), moved(x.size());
  coarse->sample(1, moved);
  for (std::size_t v = 0; v < x.size(); ++v) EXPECT_LT((moved[v] - far_pose() * x[v]).norm(), 1e-12);
}

TEST(CoarseBody, Every_part_is_left_and_as_long_as_it_was) {
  const CapsuleBody given(
      {{"trunk", {0, 0, 0}, {0, 0.5, 0}, 0.12, -1}, {"arm", {0.1, 0.45, 0}, {0.6, 0.45, 0}, 0.04, 0}});
  std::vector<Vec3> bind = given.bind();
  const auto coarse = coarse_body(body_of(given.surface, bind), 2, k_long, k_off);
  const Surface& surface = coarse->surface();
  ASSERT_EQ(surface.parts.size(), 2u);
  EXPECT_LT(surface.triangles.size(), given.surface.triangles.size());
  EXPECT_TRUE(is_closed(surface.triangles));
  const std::vector<Vec3> x = bind_of(*coarse);
  std::array<Box, 2> fine_box, coarse_box;
  for (std::size_t v = 0; v < bind.size(); ++v) fine_box[at(given.surface.part_of_vertex[v])].include(bind[v]);
  for (std::size_t v = 0; v < x.size(); ++v) coarse_box[at(surface.part_of_vertex[v])].include(x[v]);
  for (std::size_t p = 0; p < 2; ++p) {
    EXPECT_LT((fine_box[p].lo - coarse_box[p].lo).norm(), 3 * k_off);
    EXPECT_LT((fine_box[p].hi - coarse_box[p].hi).norm(), 3 * k_off);
  }
}

TEST(CoarseBody, Seams_of_a_file_do_not_open) {
  Surface surface;
  std::vector<Vec3> bind;
  make_sphere(0.1, 24, 48, bind, surface.triangles);
  const int count = static_cast<int>(bind.size());
  for (int v = 0; v < count; ++v) bind.push_back(bind[at(v)]);
  for (Triangle& t : surface.triangles) {  // one half has vertices of its own
    const Vec3 middle = bind[at(t[0])] + bind[at(t[1])] + bind[at(t[2])];
    if (middle.x() > 0)
      for (int& v : t) v += count;
  }
  ASSERT_FALSE(is_closed(surface.triangles));
  const auto coarse = coarse_body(body_of(surface, bind), 2, k_long, k_off);
  EXPECT_TRUE(is_closed(coarse->surface().triangles));
  EXPECT_LT(2 * coarse->surface().triangles.size(), surface.triangles.size());
}

TEST(CoarseBody, What_may_not_deviate_or_grow_longer_stays_as_it_is) {
  const auto fine = ball(0.1, 16, 32);
  for (const auto& [longest, deviation] : {std::pair{k_long, 0.0}, {1e-3, k_off}}) {
    const auto coarse = coarse_body(fine, 2, longest, deviation);
    EXPECT_EQ(coarse->surface().triangles.size(), fine->surface().triangles.size());
    EXPECT_EQ(bind_of(*coarse), bind_of(*fine));
  }
}

}  // namespace
}  // namespace ft::test
