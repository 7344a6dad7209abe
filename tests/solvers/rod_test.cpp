// Discrete elastic rods: derivatives against differences, and statics against the elastica.
#include "tests/solvers/rods.h"

namespace ft {
namespace {

using namespace test;

/// A strand of random bends and twists.
struct Crooked {
  Rod<double> rod;
  RodPose<double> pose;
  RodStrains<double> since;

  Crooked() {
    OneHair m;
    rod = straight_rod(6, 0.05, m);
    pose = straight_pose(rod, Vec3::UnitX(), Vec3::UnitY());
    const RandomKey key{7, 1, 0, 0};
    std::vector<double> step(at(rod.unknowns()));
    for (std::size_t d = 0; d < step.size(); ++d)
      step[d] = (d % 4 == 3 ? 1.0 : 0.008) * (2 * random_uniform(key, d) - 1);
    RodPose<double> moved;
    move_pose(step, 1.0, pose, moved);
    pose = moved;
    for (std::size_t i = 1; i + 1 < at(rod.n); ++i) {
      rod.k1[i] = 0.2 * static_cast<double>(i) - 0.3, rod.k2[i] = 0.1, rod.tw[i] = -0.15;
    }
    strains_of(straight_pose(rod, Vec3::UnitX(), Vec3::UnitY()), since);
  }
};

TEST(Rods, Gradient_and_Hessian_are_those_of_differences_along_the_way_that_poses_move) {
  Crooked c;
  const double damping = 0.4;
  c.rod.stretch = 1e-3;  // so that bending is seen beside it
  std::vector<double> gradient(at(c.rod.unknowns()));
  BandedMatrix<double> hessian;
  hessian.reset(c.rod.unknowns());
  add_potential(c.rod, c.pose, &c.since, damping, RodHessian<double>(), gradient, &hessian);
  double largest = 0;
  for (const double g : gradient) largest = std::max(largest, std::abs(g));
  const auto moved_by = [&](int d, double by) {
    std::vector<double> step(gradient.size(), 0.0);
    step[at(d)] = by;
    RodPose<double> out;
    move_pose(step, 1.0, c.pose, out);
    return out;
  };
  // Moves do not commute: what differences have beside a symmetric matrix is the gradient's.
  const std::size_t size = gradient.size();
  std::vector<double> slopes(size * size);
  for (int d = 0; d < c.rod.unknowns(); ++d) {
    const double by = d % 4 == 3 ? 1e-5 : 1e-8;
    const double up = potential(c.rod, moved_by(d, by), &c.since, damping),
                 down = potential(c.rod, moved_by(d, -by), &c.since, damping);
    EXPECT_NEAR((up - down) / (2 * by), gradient[at(d)], 1e-5 * largest) << d;
    std::vector<double> above(size, 0.0), below(size, 0.0);
    add_potential(c.rod, moved_by(d, by), &c.since, damping, RodHessian<double>(), above, nullptr);
    add_potential(c.rod, moved_by(d, -by), &c.since, damping, RodHessian<double>(), below, nullptr);
    for (std::size_t e = 0; e < size; ++e) slopes[at(d) * size + e] = (above[e] - below[e]) / (2 * by);
  }
  for (int d = 0; d < c.rod.unknowns(); ++d)
    for (int e = std::max(0, d - k_band); e <= d; ++e) {
      const double expected = 0.5 * (slopes[at(d) * size + at(e)] + slopes[at(e) * size + at(d)]);
      const double scale = std::sqrt(std::abs(hessian(d, d) * hessian(e, e)));
      EXPECT_NEAR(hessian(d, e), expected, 1e-5 * scale) << d << " " << e;
    }
}

/// A strand clamped level, sagging: the drop of its tip by its length.
double droop(int n, double gamma) {
  const OneHair m;
  const double length = m.bending_length() * std::cbrt(gamma);
  const Rod<double> rod = straight_rod(n, length, m);
  RodPose<double> pose = straight_pose(rod, Vec3::UnitX(), Vec3::UnitZ());
  RodStep<double> step;
  step.tolerance = 1e-9;
  std::vector<double> tension(at(rod.n), 0.0);
  RodStrains<double> since;
  // Implicit Euler in long steps, each of which forgets its velocity, comes to rest.
  for (int k = 0; k < 200; ++k) {
    strains_of(pose, since);
    RodSurroundings<double> around;
    const double h = 0.05;
    for (std::size_t i = 0; i < at(rod.n); ++i) {
      around.pull.push_back(rod.mass[i] / (h * h));
      around.goal.push_back(pose.x[i] + V3<double>{0, -k_gravity * h * h, 0});
    }
    EXPECT_TRUE(step.run(rod, around, since, 0, tension, pose).settled[0]) << k;
  }
  return -pose.x.back().y / length;
}

TEST(Rods, A_clamped_strand_droops_as_the_heavy_elastica_does_whatever_its_mesh) {
  for (const auto& [gamma, exact] : {std::pair(1.0, 0.12347), std::pair(10.0, 0.70020)}) {
    double before = 0;
    for (const int n : {16, 32, 64}) {
      const double now = droop(n, gamma);
      printf("gamma %.0f, %d vertices: %.5f, exact %.5f\n", gamma, n, now, exact);
      EXPECT_NEAR(now, exact, 0.01 * exact);
      if (before > 0) {
        EXPECT_NEAR(now, before, 0.005 * exact);
      }
      before = now;
    }
  }
}

TEST(Rods, The_height_at_which_an_upright_strand_buckles_is_where_a_pivot_becomes_negative) {
  const OneHair m;
  const auto stands = [&](double height) {
    const int n = 33;
    const Rod<double> rod = straight_rod(n - 1, height, m);
    RodPose<double> pose = straight_pose(rod, Vec3::UnitY(), Vec3::UnitZ());
    std::vector<double> gradient(at(rod.unknowns())), tension(at(rod.n), 0.0);
    double above = 0;
    for (std::size_t j = at(rod.n) - 2; j >= 1; --j) {
      above += rod.mass[j + 1] * k_gravity;
      tension[j] = -above;
    }
    BandedMatrix<double> hessian;
    hessian.reset(rod.unknowns());
    RodHessian<double> wanted;
    wanted.tension = &tension;
    add_potential(rod, pose, nullptr, 0, wanted, gradient, &hessian);
    return hessian.factor(k_given) > 0;
  };
  double low = m.bending_length(), high = 3 * low;
  while (high - low > 1e-6) (stands(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  printf("buckles at %.4f L_b\n", low / m.bending_length());
  EXPECT_NEAR(low / m.bending_length(), 1.98635, 0.002 * 1.98635);
}

TEST(Rods, Four_strands_at_once_move_as_each_does_alone) {
  const OneHair m;
  RodStep<Lanes> four;
  Rod<Lanes> rods;
  RodPose<Lanes> poses;
  RodSurroundings<Lanes> all;
  RodStrains<Lanes> since_all;
  std::vector<Lanes> tensions;
  const double h = 1.0 / 96;
  std::vector<RodPose<double>> alone;
  const int n = 12;
  for (int lane = 0; lane < 4; ++lane) {
    const Rod<double> rod = straight_rod(n, 0.03 * (lane + 1), m);
    RodPose<double> pose = straight_pose(rod, Vec3(1, 0.3 * lane, 0).normalized(), Vec3::UnitZ());
    RodSurroundings<double> around;
    rods.n = rod.n;
    if (lane == 0) {
      rods.length.resize(rod.length.size()), rods.voronoi.resize(at(n + 1)), rods.mass.resize(at(n + 1));
      rods.k1.assign(at(n + 1), Lanes{}), rods.k2 = rods.tw = rods.k1;
      poses.x.resize(at(n + 1)), poses.director.resize(at(n));
      all.pull.resize(at(n + 1)), all.goal.resize(at(n + 1));
      tensions.assign(at(n + 1), Lanes{});
    }
    for (std::size_t i = 0; i < at(n + 1); ++i) {
      around.pull.push_back(rod.mass[i] / (h * h));
      around.goal.push_back(pose.x[i] + V3<double>{0, -0.01, 0.001 * lane});
      all.pull[i][lane] = around.pull[i];
      set_lane(all.goal[i], lane, plain(around.goal[i]));
      set_lane(poses.x[i], lane, plain(pose.x[i]));
      if (i < at(n)) set_lane(poses.director[i], lane, plain(pose.director[i])), rods.length[i][lane] = rod.length[i];
      rods.voronoi[i][lane] = rod.voronoi[i], rods.mass[i][lane] = rod.mass[i];
    }
    rods.stretch[lane] = rod.stretch, rods.bend[lane] = rod.bend, rods.twist[lane] = rod.twist;
    RodStrains<double> since;
    strains_of(pose, since);
    std::vector<double> tension(at(n + 1), 0.0);
    RodStep<double> one;
    EXPECT_TRUE(one.run(rod, around, since, 0.5, tension, pose).settled[0]);
    alone.push_back(pose);
  }
  strains_of(poses, since_all);
  const RodStepReport report = four.run(rods, all, since_all, 0.5, tensions, poses);
  for (int lane = 0; lane < 4; ++lane) {
    EXPECT_TRUE(report.settled[lane]);
    for (std::size_t i = 0; i < at(n + 1); ++i)
      EXPECT_EQ(lane_of(poses.x[i], lane), plain(alone[at(lane)].x[i])) << lane << " " << i;
  }
}

}  // namespace
}  // namespace ft
