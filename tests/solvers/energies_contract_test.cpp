// The contract of an energy, run over the registry: gradient against differences of the value, Hessian symmetric and
// positive semidefinite, Hessian against differences of the gradient where it is exact, rigid motion, rest state,
// degenerate elements, the same bits for any number of threads.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstring>

#include "baker/core/parallel.h"
#include "baker/core/random.h"
#include "solvers/energies/cords.h"
#include "solvers/energies/registry.h"
#include "tests/solvers/cloth_patches.h"
#include "tests/support/spring_sheet.h"

namespace ft {
namespace {

using test::dense;

struct Scene {
  ClothTopology topology;
  BlockPattern pattern;
  std::vector<Vec3> x, v, x_t0, x_tm1;
  StepContext context() const {
    StepContext c;
    c.h = 4e-3;
    c.beta_h = 2.0 / 3 * c.h;
    c.x_t0 = x_t0, c.v_t0 = v, c.x_tm1 = x_tm1;
    c.a = 4.0 / 3, c.b = 1.0 / 3;
    return c;
  }
};

const AirSettings k_windy{1.225, steady_wind(Vec3(1.5, 0.2, -0.7))};

/// A curved rest shape of two fabrics, strained by a few per cent and in motion.
Scene make_scene(Energy& energy, ClothTopology topology, std::uint64_t seed, double amplitude) {
  Scene s;
  s.topology = std::move(topology);
  const std::vector<std::array<int, 4>> lists[] = {energy.stencils()};
  s.pattern = make_pattern(s.topology.vertex_count, lists);
  s.x = jitter(s.topology.rest, amplitude, seed);
  s.v = jitter(std::vector<Vec3>(s.x.size(), Vec3(0.3, -1, 0.2)), 0.5, seed + 1);
  s.x_t0 = jitter(s.x, 0.2 * amplitude, seed + 2);
  s.x_tm1 = jitter(s.x_t0, 0.2 * amplitude, seed + 3);
  return s;
}

Eigen::VectorXd gradient_of(const Energy& energy, const std::vector<Vec3>& x) {
  std::vector<Vec3> g(x.size(), Vec3::Zero());
  energy.add_gradient(x, g);
  return Eigen::Map<const Eigen::VectorXd>(g[0].data(), static_cast<Eigen::Index>(3 * g.size()));
}

class EnergyContract : public testing::TestWithParam<ClothEnergyKind> {
 protected:
  ClothTopology topology_ = curved_patch(5, 6);
  std::unique_ptr<Energy> energy_ = GetParam().make(topology_, k_windy);
};

TEST_P(EnergyContract, Its_name_is_that_of_the_list) {
  EXPECT_EQ(energy_->name(), GetParam().name);
}

TEST_P(EnergyContract, Gradient_agrees_with_differences_of_the_value) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Scene s = make_scene(*energy_, topology_, seed, 2e-3);
    energy_->begin_step(s.context());
    const Eigen::VectorXd g = gradient_of(*energy_, s.x);
    Eigen::VectorXd differences(g.size());
    const double step = 1e-6;  // central: truncation about step^2 f''', round-off 1e-16 f / step
    for (Eigen::Index k = 0; k < g.size(); ++k) {
      double& coordinate = s.x[static_cast<std::size_t>(k / 3)][k % 3];
      const double kept = coordinate;
      coordinate = kept + step;
      const double plus = energy_->value(s.x);
      coordinate = kept - step;
      differences[k] = (plus - energy_->value(s.x)) / (2 * step);
      coordinate = kept;
    }
    ASSERT_GT(g.norm(), 0);
    EXPECT_LT((g - differences).norm(), 2e-6 * g.norm()) << "seed " << seed;
  }
}

TEST_P(EnergyContract, Hessian_is_symmetric_and_positive_semidefinite) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    for (const double amplitude : {0.0, 2e-3, 3e-2}) {
      Scene s = make_scene(*energy_, topology_, seed, amplitude);
      energy_->begin_step(s.context());
      BlockMatrix m;
      m.reset(s.pattern);
      energy_->add_hessian(s.x, m);
      const Eigen::MatrixXd h = dense(m);
      ASSERT_TRUE(h.allFinite());
      EXPECT_LT((h - h.transpose()).norm(), 1e-6 * h.norm());  // float sums in another order
      const Eigen::VectorXd eigenvalues =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(0.5 * (h + h.transpose())).eigenvalues();
      EXPECT_GT(eigenvalues[0], -2e-6 * eigenvalues[eigenvalues.size() - 1]);  // float round-off of the entries
    }
}

TEST_P(EnergyContract, Hessian_adds_to_what_is_there) {
  Scene s = make_scene(*energy_, topology_, 1, 2e-3);
  energy_->begin_step(s.context());
  BlockMatrix once, twice;
  once.reset(s.pattern);
  twice.reset(s.pattern);
  energy_->add_hessian(s.x, once);
  energy_->add_hessian(s.x, twice);
  energy_->add_hessian(s.x, twice);
  EXPECT_LT((dense(twice) - 2 * dense(once)).norm(), 1e-6 * dense(once).norm());
}

TEST_P(EnergyContract, What_was_asked_before_changes_no_answer_and_both_derivatives_are_those_asked_one_by_one) {
  const Scene s = make_scene(*energy_, topology_, 1, 2e-3), other = make_scene(*energy_, topology_, 9, 2e-2);
  energy_->begin_step(s.context());
  const auto fresh = GetParam().make(topology_, k_windy);
  fresh->begin_step(s.context());
  const double value = fresh->value(s.x);
  const Eigen::VectorXd g = gradient_of(*fresh, s.x);
  BlockMatrix h, both;
  h.reset(s.pattern);
  both.reset(s.pattern);
  fresh->add_hessian(s.x, h);
  EXPECT_NE(energy_->value(other.x), value);
  EXPECT_EQ(gradient_of(*energy_, s.x), g);
  gradient_of(*energy_, other.x);
  EXPECT_EQ(energy_->value(s.x), value);
  gradient_of(*energy_, other.x);
  std::vector<Vec3> gradient(s.x.size(), Vec3::Zero());
  energy_->add_derivatives(s.x, gradient, both);
  EXPECT_EQ(Eigen::Map<const Eigen::VectorXd>(gradient[0].data(), g.size()), g);
  EXPECT_EQ(dense(both), dense(h));
}

TEST_P(EnergyContract, A_new_step_forgets_the_last_one) {
  const Scene s = make_scene(*energy_, topology_, 1, 2e-3), other = make_scene(*energy_, topology_, 9, 2e-2);
  energy_->begin_step(s.context());
  const double value = energy_->value(s.x);
  const Eigen::VectorXd g = gradient_of(*energy_, s.x);
  energy_->begin_step(other.context());
  energy_->value(other.x);
  energy_->begin_step(s.context());
  EXPECT_EQ(energy_->value(s.x), value);
  EXPECT_EQ(gradient_of(*energy_, s.x), g);
}

TEST_P(EnergyContract, Degenerate_elements_give_finite_numbers) {
  Scene s = make_scene(*energy_, topology_, 1, 2e-3);
  for (const double offset : {0.0, 1e-12, -1e-12}) {
    std::vector<Vec3> x = s.x;
    const Triangle t = s.topology.triangles[at(static_cast<int>(s.topology.triangles.size() / 2))];
    x[at(t[1])] = x[at(t[0])] + Vec3(offset, 0, 0);  // no length
    const Triangle u = s.topology.triangles[1];
    x[at(u[2])] = 0.5 * (x[at(u[0])] + x[at(u[1])]) + Vec3(0, offset, 0);  // no height
    Scene moved = s;
    moved.x_t0 = x;
    for (const bool at_start : {false, true}) {
      energy_->begin_step(at_start ? moved.context() : s.context());
      BlockMatrix m;
      m.reset(s.pattern);
      energy_->add_hessian(x, m);
      EXPECT_TRUE(std::isfinite(energy_->value(x)));
      EXPECT_TRUE(gradient_of(*energy_, x).allFinite());
      EXPECT_TRUE(dense(m).allFinite());
    }
  }
}

TEST_P(EnergyContract, A_rest_shape_with_degenerate_triangles_gives_finite_numbers) {
  for (const double offset : {0.0, 1e-12, -1e-12}) {
    std::vector<Vec3> rest = topology_.rest;
    const Triangle t = topology_.triangles[3];
    rest[at(t[2])] = 0.5 * (rest[at(t[0])] + rest[at(t[1])]) + Vec3(offset, 0, 0);
    const ClothTopology bad = make_cloth_topology(rest, topology_.triangles, topology_.pieces);
    const auto energy = GetParam().make(bad, k_windy);
    Scene s = make_scene(*energy, bad, 1, 2e-3);
    energy->begin_step(s.context());
    BlockMatrix m;
    m.reset(s.pattern);
    energy->add_hessian(s.x, m);
    EXPECT_TRUE(std::isfinite(energy->value(s.x)));
    EXPECT_TRUE(gradient_of(*energy, s.x).allFinite());
    EXPECT_TRUE(dense(m).allFinite());
  }
}

/// Elements are computed in groups of lanes. Lanes without an element add nothing anywhere: other threads write there.
TEST_P(EnergyContract, Touches_no_vertex_without_an_element) {
  if (!GetParam().elastic) GTEST_SKIP() << "not of elements";
  const std::vector<Vec3> rest = {{0, 0, 1}, {0, 0, 0}, {0.1, 0, 0}, {0.05, 0.1, 0}, {0.05, -0.1, 0}};
  const Triangle triangles[] = {{1, 2, 3}, {2, 1, 4}};
  const ClothPiece pieces[] = {{0, 5, Fabric{}}};
  const ClothTopology loose = make_cloth_topology(rest, triangles, pieces);
  const auto energy = GetParam().make(loose, k_windy);
  Scene s = make_scene(*energy, loose, 5, 1e-3);
  energy->begin_step(s.context());
  s.x[0].setConstant(std::nan(""));
  const Eigen::VectorXd g = gradient_of(*energy, s.x);
  EXPECT_EQ(g.head<3>(), Eigen::Vector3d::Zero());
  EXPECT_TRUE(g.allFinite());
  EXPECT_GT(g.norm(), 0);
}

TEST_P(EnergyContract, The_same_bits_at_1_2_3_and_8_threads) {
  const ClothTopology large = curved_patch(40, 50);
  std::vector<double> first_value;
  Eigen::VectorXd first_gradient;
  decltype(BlockMatrix::blocks) first_blocks;
  for (const int threads : {1, 2, 3, 8}) {
    const ThreadLimit limit(threads);
    const auto energy = GetParam().make(large, k_windy);
    const Scene s = make_scene(*energy, large, 4, 1e-3);
    energy->begin_step(s.context());
    BlockMatrix m;
    m.reset(s.pattern);
    energy->add_hessian(s.x, m);
    const double value = energy->value(s.x);
    const Eigen::VectorXd g = gradient_of(*energy, s.x);
    if (threads == 1) {
      first_value = {value}, first_gradient = g, first_blocks = m.blocks;
      continue;
    }
    EXPECT_EQ(value, first_value[0]);
    EXPECT_EQ(g, first_gradient);
    ASSERT_EQ(m.blocks.size(), first_blocks.size());
    EXPECT_EQ(std::memcmp(m.blocks.data(), first_blocks.data(), m.blocks.size() * sizeof(Mat3f)), 0);
  }
}

TEST_P(EnergyContract, An_elastic_energy_has_no_force_and_no_value_at_rest) {
  if (!GetParam().elastic) GTEST_SKIP() << "not elastic";
  StepContext context;
  context.x_t0 = topology_.rest;
  energy_->begin_step(context);
  const double scale = 1e-6;  // N: a strain of 1e-9 in a triangle of 2 cm and 500 N/m
  EXPECT_LT(gradient_of(*energy_, topology_.rest).lpNorm<Eigen::Infinity>(), scale * 1e-3);
  EXPECT_LT(energy_->value(topology_.rest), 1e-15);
}

TEST_P(EnergyContract, Rigid_motion_changes_nothing_and_damping_does_not_feel_it) {
  if (!GetParam().elastic) GTEST_SKIP() << "not elastic";
  Scene s = make_scene(*energy_, topology_, 2, 2e-3);
  const auto turned = [&](double angle, double shift) {
    const Mat3 r = Eigen::AngleAxisd(angle, Vec3(1, 2, -1).normalized()).toRotationMatrix();
    std::vector<Vec3> out = s.x;
    for (Vec3& p : out) p = r * p + shift * Vec3(3, -1, 2);
    return out;
  };
  // The body spins at half a turn a step, without strain rate: the force is that of standing still, turned.
  StepContext still = s.context(), spinning = s.context();
  still.x_t0 = s.x, still.x_tm1 = s.x;
  energy_->begin_step(still);
  const Eigen::VectorXd g = gradient_of(*energy_, s.x);
  const double value = energy_->value(s.x);
  const std::vector<Vec3> t0 = turned(1.5, 1), tm1 = turned(-1, 0.3), t1 = turned(2.9, 2);
  spinning.x_t0 = t0, spinning.x_tm1 = tm1;
  energy_->begin_step(spinning);
  const Mat3 r = Eigen::AngleAxisd(2.9, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  Eigen::VectorXd expected = g;
  for (Eigen::Index i = 0; i < g.size(); i += 3) expected.segment<3>(i) = r * g.segment<3>(i);
  EXPECT_LT((gradient_of(*energy_, t1) - expected).norm(), 1e-9 * g.norm());
  EXPECT_NEAR(energy_->value(t1), value, 1e-9 * value);
  // No net force, no net moment.
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    const Vec3 f = g.segment<3>(static_cast<Eigen::Index>(3 * i));
    force += f, moment += s.x[i].cross(f);
  }
  EXPECT_LT(force.norm(), 1e-12 * g.norm());
  EXPECT_LT(moment.norm(), 1e-12 * g.norm());
}

/// Differences of the gradient, symmetrised.
Eigen::MatrixXd true_hessian(const Energy& energy, std::vector<Vec3> x) {
  const Eigen::Index n = static_cast<Eigen::Index>(3 * x.size());
  Eigen::MatrixXd out(n, n);
  const double step = 1e-6;
  for (Eigen::Index k = 0; k < n; ++k) {
    double& coordinate = x[static_cast<std::size_t>(k / 3)][k % 3];
    const double kept = coordinate;
    coordinate = kept + step;
    const Eigen::VectorXd plus = gradient_of(energy, x);
    coordinate = kept - step;
    out.col(k) = (plus - gradient_of(energy, x)) / (2 * step);
    coordinate = kept;
  }
  return 0.5 * (out + out.transpose());
}

TEST_P(EnergyContract, What_is_internal_pulls_at_nothing_outside) {
  if (!energy_->is_internal()) GTEST_SKIP() << "not internal";
  const Scene s = make_scene(*energy_, topology_, 5, 2e-3);
  energy_->begin_step(s.context());
  const Eigen::VectorXd g = gradient_of(*energy_, s.x);
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    const Vec3 f = g.segment<3>(static_cast<Eigen::Index>(3 * i));
    force += f, moment += s.x[i].cross(f);
  }
  EXPECT_GT(g.norm(), 0);
  EXPECT_LT(force.norm(), 1e-12 * g.norm());
  EXPECT_LT(moment.norm(), 1e-12 * g.norm());
}

TEST_P(EnergyContract, Hessian_is_the_true_one_or_more_than_half_of_it) {
  // Where nothing is clamped or dropped for definiteness. Membrane: stretched and sheared beyond its limits, all stress
  // positive. Bending: at the rest shape, where the moment is zero. Drag: quadratic.
  Scene s = make_scene(*energy_, topology_, 3, 1e-3);
  if (GetParam().elastic) {
    const bool membrane = GetParam().name == "membrane";
    s.x = s.topology.rest;
    if (membrane)
      for (Vec3& p : s.x) p = 1.05 * (p + 0.06 * p.y() * Vec3::UnitX());
    s.x_t0 = s.x_tm1 = s.x;
  }
  energy_->begin_step(s.context());
  BlockMatrix m;
  m.reset(s.pattern);
  energy_->add_hessian(s.x, m);
  const Eigen::MatrixXd h = dense(m), exact = true_hessian(*energy_, s.x);
  if (GetParam().exact_hessian) {
    EXPECT_LT((h - exact).norm(), 1e-5 * exact.norm());  // float entries
    return;
  }
  // A Newton step with h lowers the quadratic model as long as the largest ratio is below 2.
  const Eigen::MatrixXd shift = 1e-5 * h.norm() * Eigen::MatrixXd::Identity(h.rows(), h.cols());
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ratio(exact, 0.5 * (h + h.transpose()) + shift);
  const double largest = ratio.eigenvalues()[h.rows() - 1];
  RecordProperty("largest_ratio", std::to_string(largest));
  EXPECT_LT(largest, 2.0);
  EXPECT_GT(largest, 1.0);
}

/// One cord, always drawn.
class OneCord : public Cords {
 public:
  explicit OneCord(const Cord& cord) : Cords({cord}) {}
  std::string_view name() const override { return "one cord"; }
};

TEST(Cords, That_hold_a_vertex_to_a_triangle_of_its_own_have_the_Hessian_of_their_energy) {
  const OneCord energy({{2, 0, 1, 2}, {1, -0.5, -0.2, -0.3}, 0, 100, 1e9});
  std::vector<Vec3> x{{0, 0, 0}, {0.1, 0.02, 0}, {0.03, 0.1, 0.05}};
  const auto stencils = energy.stencils();
  const BlockPattern pattern = make_pattern(3, std::array{stencils});
  BlockMatrix m;
  m.reset(pattern);
  energy.add_hessian(x, m);
  const Eigen::MatrixXd h = dense(m), exact = true_hessian(energy, x);
  EXPECT_GT(exact.norm(), 1);
  EXPECT_LT((h - exact).norm(), 1e-5 * exact.norm());
}

INSTANTIATE_TEST_SUITE_P(Registry, EnergyContract,
                         testing::ValuesIn(cloth_energy_kinds().begin(), cloth_energy_kinds().end()),
                         [](const auto& kind) { return std::string(kind.param.name); });

}  // namespace
}  // namespace ft
