// Twist of rods against bending: the ring that buckles out of its plane (Michell 1889; Goriely 2006).
#include "tests/solvers/rods.h"

namespace ft {
namespace {

using namespace test;

/// A straight strand bent to a ring of N edges about y, and its ends joined with this much twist between them. It is an
/// open rod of N + 2 vertices, the last two of which are where the first two are; and so it is the ring when both of
/// its end edges are held: of any motion of a ring one can be found in which one edge stays where it is.
struct Ring {
  Rod<double> rod;
  RodPose<double> pose;

  Ring(int edges, double twist, const OneHair& m) {
    const double l = 0.2 / edges, turn = 2 * std::numbers::pi / edges;
    const double radius = 0.5 * l / std::sin(0.5 * turn);
    rod = straight_rod(edges + 1, l * edges, m);
    rod.voronoi[1] = l;
    for (int i = 0; i < rod.n; ++i)
      pose.x.push_back(plain(Vec3(radius * std::cos(turn * i), 0, radius * std::sin(turn * i))));
    for (int j = 0; j + 1 < rod.n; ++j) {
      const Vec3 t = plain(pose.x[at(j) + 1] - pose.x[at(j)]).normalized();
      const double angle = twist * j / edges;
      pose.director.push_back(plain(Vec3(std::cos(angle) * Vec3::UnitY() + std::sin(angle) * t.cross(Vec3::UnitY()))));
    }
    // Bending widens a ring; it is as long as the tension says that holds it.
    const std::vector<double> g = gradient();
    const Vec3 outwards = Vec3(plain(pose.x[2])) / radius;
    const double push = -outwards.dot(Vec3(g[8], g[9], g[10])), tension = push / (2 * std::sin(0.5 * turn));
    rod.length.assign(rod.length.size(), l / (1 + tension / rod.stretch));
  }
  std::vector<double> gradient() const {
    std::vector<double> out(at(rod.unknowns()));
    add_potential(rod, pose, nullptr, 0, RodHessian<double>(), out, nullptr);
    return out;
  }
  /// Largest force on what is free, by the bending moment over its length [1].
  double out_of_balance() const {
    const std::vector<double> g = gradient();
    double largest = 0;
    for (std::size_t d = k_given; d + k_given < g.size(); ++d)
      largest = std::max(largest, std::abs(g[d]) / (d % 4 == 3 ? rod.length[0] : 1));
    return largest * 0.2 * 0.2 / rod.bend;
  }
  bool is_stable() const {
    std::vector<double> unused(at(rod.unknowns()));
    BandedMatrix<double> all, free;
    all.reset(rod.unknowns());
    add_potential(rod, pose, nullptr, 0, RodHessian<double>(), unused, &all);
    free.reset(rod.unknowns() - k_given);
    for (int i = k_given; i < free.size(); ++i)
      for (int j = std::max(k_given, i - k_band); j <= i; ++j) free(i, j) = all(i, j);
    // With an edge held it still turns freely about that, all directors turning back: not if the next vertex stays in
    // the plane.
    free(9, 9) += rod.stretch / rod.length[0];
    return free.factor(k_given) > 0;
  }
};

TEST(Rods, A_ring_buckles_at_the_twist_that_Michell_found) {
  OneHair m;
  for (const double shear : {0.89e9, 2.5e9}) {
    m.shear = shear;
    const double exact = 2 * std::numbers::pi * std::sqrt(3.0) * m.bend() / m.twist();
    double off[2];
    for (const int k : {0, 1}) {
      const int edges = k == 0 ? 128 : 256;
      EXPECT_TRUE(Ring(edges, 0, m).is_stable());
      double low = 0.5 * exact, high = 1.5 * exact;
      ASSERT_TRUE(Ring(edges, low, m).is_stable());
      ASSERT_FALSE(Ring(edges, high, m).is_stable());
      while (high - low > 1e-7 * exact) {
        const Ring ring(edges, 0.5 * (low + high), m);
        EXPECT_LT(ring.out_of_balance(), 1e-3);
        (ring.is_stable() ? low : high) = 0.5 * (low + high);
      }
      off[k] = low / exact - 1;
      printf("EI/GJ %.3f, %d edges: buckles at %.3f rad, exact %.3f: off by %.3f %%\n", m.bend() / m.twist(), edges,
             low, exact, 100 * off[k]);
    }
    EXPECT_LT(std::abs(off[1]), 0.01);
    // A stencil's twist is 2 tan(tau / 2), and its moment too large by tau^2 / 3: of the second order in the mesh.
    EXPECT_NEAR(off[0] / off[1], 4, 0.5);
  }
}

}  // namespace
}  // namespace ft
