// Grooms that stand still: any pose is the equilibrium of its rest shape, and strands that could not stand are stiffer.
#include "solvers/hair/rest_shape.h"

#include <numbers>

#include "tests/solvers/rods.h"

namespace ft {
namespace {

using namespace test;

std::vector<Vec3> weights(const Rod<double>& rod) {
  std::vector<Vec3> out;
  for (const double m : rod.mass) out.emplace_back(0, -m * k_gravity, 0);
  return out;
}

/// A curl of this radius and pitch along a way.
RodPose<double> curl(Rod<double>& rod, double radius, double pitch, const Vec3& way) {
  RodPose<double> pose;
  const Quat turn = Quat::FromTwoVectors(Vec3::UnitX(), way);
  double s = -rod.length[0];
  const double turns = 1 / std::hypot(radius, pitch / (2 * std::numbers::pi));
  for (int i = 0; i < rod.n; ++i, s += rod.length[0]) {
    const double a = turns * s;
    pose.x.push_back(
        plain(Vec3(turn * Vec3(pitch / (2 * std::numbers::pi) * a, radius * std::cos(a), radius * std::sin(a)))));
  }
  V3<double> before{}, director{};
  for (int j = 0; j + 1 < rod.n; ++j) {
    const Vec3 t = plain(pose.x[at(j) + 1] - pose.x[at(j)]).normalized();
    director = j == 0 ? plain(t.unitOrthogonal()) : carried_director(director, before, plain(t));
    before = plain(t);
    pose.director.push_back(director);
  }
  for (std::size_t j = 0; j < rod.length.size(); ++j) rod.length[j] = norm(pose.x[j + 1] - pose.x[j]);
  return pose;
}

double residual(const Rod<double>& rod, const RodPose<double>& pose) {
  std::vector<double> gradient(at(rod.unknowns()));
  add_potential(rod, pose, nullptr, 0, RodHessian<double>(), gradient, nullptr);
  double worst = 0;
  for (std::size_t i = 2; i < at(rod.n); ++i)
    for (std::size_t a = 0; a < 3; ++a)
      worst = std::max(worst, std::abs(gradient[4 * i + a] + (a == 1 ? rod.mass[i] * k_gravity : 0)));
  for (std::size_t j = 1; j + 1 < at(rod.n); ++j)
    worst = std::max(worst, std::abs(gradient[4 * j + 3]) / rod.length[1]);
  return worst / (rod.mass[2] * k_gravity);
}

TEST(RestShape, Any_groom_is_the_equilibrium_of_its_rest_shape) {
  for (const Vec3& way : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0.3, -1, 0.2)})
    for (const double radius : {0.0, 0.008}) {
      Rod<double> rod = straight_rod(32, 0.2, OneHair());
      const RodPose<double> pose = curl(rod, radius, 0.03, way.normalized());
      make_rest_shape(rod, pose, weights(rod));
      EXPECT_LT(residual(rod, pose), 1e-6) << radius << " " << way.transpose();
    }
}

TEST(RestShape, What_cannot_stand_is_made_stiffer_and_what_hangs_is_not) {
  const OneHair m;
  const auto raised = [&](double length, const Vec3& way, double slowest) {
    Rod<double> rod = straight_rod(32, length, m);
    const RodPose<double> pose = straight_pose(rod, way, way.unitOrthogonal());
    return stand_still(rod, pose, weights(rod), slowest);
  };
  const auto wanted = [](double length) { return slowest_wanted(length, k_gravity); };
  EXPECT_EQ(raised(0.3, -Vec3::UnitY(), wanted(0.3)), 1);
  EXPECT_EQ(raised(0.05, Vec3::UnitX(), wanted(0.05)), 1);
  for (const double height : {0.15, 0.2, 0.3}) {
    // A column as high as this is about to buckle; it needs more to swing as fast as wanted.
    const double least = std::pow(height / (1.98635 * m.bending_length()), 3);
    EXPECT_NEAR(raised(height, Vec3::UnitY(), 0), least, 0.04 * least);
    EXPECT_GT(raised(height, Vec3::UnitY(), wanted(height)), 1.1 * least);
  }
}

TEST(RestShape, A_strand_that_was_kicked_comes_back_to_where_it_was_combed) {
  for (const Vec3& way : {Vec3(1, 0, 0), Vec3(0, 1, 0)}) {
    Rod<double> rod = straight_rod(24, 0.2, OneHair());
    const RodPose<double> groom = curl(rod, 0.006, 0.04, way);
    stand_still(rod, groom, weights(rod), slowest_wanted(0.2, k_gravity));
    RodPose<double> pose = groom;
    RodStep<double> step;
    RodStrains<double> since;
    std::vector<double> tension(at(rod.n), 0.0);
    const double h = 1.0 / 96;
    std::vector<V3<double>> before = pose.x;
    double farthest = 0;
    for (int k = 0; k < 96 * 6; ++k) {
      strains_of(pose, since);
      RodSurroundings<double> around;
      const double kick = k < 5 ? 30 : 0, drag = 8;
      for (std::size_t i = 0; i < at(rod.n); ++i) {
        const double inertia = rod.mass[i] / (h * h), slow = rod.mass[i] * drag / h;
        const V3<double> free = pose.x[i] + (pose.x[i] - before[i]) + V3<double>{0, -k_gravity * h * h, kick * h * h};
        around.pull.push_back(inertia + slow);
        around.goal.push_back((1 / (inertia + slow)) * (inertia * free + slow * pose.x[i]));
      }
      before = pose.x;
      step.run(rod, around, since, 0.5, tension, pose);
      farthest = std::max(farthest, norm(pose.x.back() - groom.x.back()));
    }
    printf("went %.0f mm, back to %.4f mm\n", 1e3 * farthest, 1e3 * norm(pose.x.back() - groom.x.back()));
    EXPECT_GT(farthest, 0.02);
    EXPECT_LT(norm(pose.x.back() - groom.x.back()), 1e-3);
  }
}

}  // namespace
}  // namespace ft
