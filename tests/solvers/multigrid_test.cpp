// How vertices are interpolated between levels of the linear solver, and how coarse matrices are summed up.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "solvers/linear/galerkin_plan.h"
#include "solvers/linear/interpolation.h"
#include "tests/support/spring_sheet.h"

namespace ft {
namespace {

using test::dense, test::fill_with_noise, test::noise;
using Sheet = test::SpringSheet;

TEST(GalerkinPlan, Sums_up_what_a_dense_product_does) {
  const Sheet sheet(11);
  const Interpolation p = make_interpolation(sheet.pattern, sheet.rest);
  BlockMatrix fine;
  fine.reset(sheet.pattern);
  fill_with_noise(fine);
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(3 * sheet.pattern.vertex_count(), 3 * p.coarse_count());
  for (int i = 0; i < sheet.pattern.vertex_count(); ++i)
    for (const Interpolation::Link to : p.rows[at(i)])
      if (to.share != 0)
        weights.block<3, 3>(3 * i, 3 * static_cast<int>(to.vertex))
            .diagonal()
            .setConstant(double(to.share) / Interpolation::k_shares);
  const Eigen::MatrixXd expected = weights.transpose() * dense(fine) * weights;
  GalerkinPlan plan;
  const BlockPattern pattern = plan.build(sheet.pattern, p);
  BlockMatrix coarse;
  coarse.reset(pattern);
  plan.apply(fine, coarse);
  EXPECT_LT((dense(coarse) - expected).norm(), 1e-5 * expected.norm());
}

/// Vertices that belong to nothing, amid a sheet, move its parts apart by as many places.
TEST(GalerkinPlan, Gives_the_same_bits_whatever_the_distances_between_places) {
  const Sheet sheet(11);
  const int n = sheet.pattern.vertex_count();
  const auto coarse_of = [&](int gap, int& coarse_gap) {
    const auto moved = [&](int v) { return v < n / 2 ? v : v + gap; };
    std::vector<std::array<int, 4>> springs;
    for (const auto& s : sheet.springs) springs.push_back({moved(s[0]), moved(s[1]), -1, -1});
    std::vector<Vec3> rest(at(n + gap), Vec3::Zero());
    for (int v = 0; v < n; ++v) rest[at(moved(v))] = sheet.rest[at(v)];
    const BlockPattern pattern = make_pattern(n + gap, std::array{springs});
    BlockMatrix fine, coarse;
    fine.reset(pattern);
    for (int v = 0; v < n; ++v)
      sheet.pattern.visit_row(v, [&](int u, int place) {
        for (int c = 0; u >= v && c < 9; ++c)
          fine.blocks[at(pattern.find(moved(v), moved(u)))].data()[c] =
              float(noise(at(place), static_cast<std::uint64_t>(c)));
      });
    GalerkinPlan plan;
    const Interpolation p = make_interpolation(pattern, rest);
    const BlockPattern coarse_pattern = plan.build(pattern, p);
    coarse.reset(coarse_pattern);
    plan.apply(fine, coarse);
    coarse_gap = p.coarse_count();
    std::vector<Mat3f> blocks;
    for (std::size_t i = 0; i < at(p.coarse_count()); ++i)
      if (p.coarse_to_fine[i] < n / 2 || p.coarse_to_fine[i] >= n / 2 + gap)
        blocks.insert(blocks.end(), coarse.blocks.begin() + coarse_pattern.diagonal[i],
                      coarse.blocks.begin() + coarse_pattern.diagonal[i + 1]);
    return blocks;
  };
  int none = 0, some = 0;
  const std::vector<Mat3f> expected = coarse_of(0, none);
  for (const int gap : {1, 20, 30, 31, 60, 65300, 65534, 65535, 65536, 140000}) {
    EXPECT_EQ(coarse_of(gap, some), expected) << gap;
    EXPECT_EQ(some, none + gap);
  }
}

TEST(Interpolation, sums_to_one_and_nearly_reproduces_linear_fields) {
  const Sheet sheet(40);
  const Interpolation p = make_interpolation(sheet.pattern, sheet.rest);
  EXPECT_LT(p.coarse_count(), 40 * 40 / 3);
  double squared = 0;
  for (std::size_t i = 0; i < sheet.rest.size(); ++i) {
    Vec3 x = Vec3::Zero();
    float sum = 0;
    int shares = 0;
    for (const Interpolation::Link to : p.rows[i]) {
      x += double(to.weight()) * sheet.rest[at(p.coarse_to_fine[to.vertex])];
      sum += to.weight();
      shares += to.share;
    }
    EXPECT_NEAR(sum, 1, 1e-6);
    EXPECT_EQ(shares, Interpolation::k_shares);
    squared += (x - sheet.rest[i]).squaredNorm();
  }
  const double cell = 1.0 / 40;
  EXPECT_LT(std::sqrt(squared / double(sheet.rest.size())), 0.25 * cell);
}

TEST(Interpolation, reproduces_linear_fields_of_a_regular_mesh_but_at_its_border) {
  constexpr int n = 21;
  std::vector<Vec3> rest;
  std::vector<std::array<int, 4>> triangles;
  for (int v = 0; v < n * n; ++v) rest.emplace_back(v % n, v / n, 0);
  for (int v = 0; v < n * n; ++v)
    if (v % n + 1 < n && v / n + 1 < n)
      triangles.push_back({v, v + 1, v + n + 1, -1}), triangles.push_back({v, v + n + 1, v + n, -1});
  const Interpolation p = make_interpolation(make_pattern(n * n, std::array{triangles}), rest);
  for (int v = 0; v < n * n; ++v) {
    if (std::min({v % n, v / n, n - 1 - v % n, n - 1 - v / n}) < 2) continue;
    Vec3 x = Vec3::Zero();
    for (const Interpolation::Link to : p.rows[at(v)]) x += to.share * rest[at(p.coarse_to_fine[to.vertex])];
    EXPECT_EQ(x, Vec3(Interpolation::k_shares * rest[at(v)]));
  }
}

}  // namespace
}  // namespace ft
