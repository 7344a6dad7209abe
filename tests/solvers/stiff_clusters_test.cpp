// What contact ties together: who becomes a cluster, that a cluster's block is solved as a dense one is, and what it is
// worth to the linear solver.
#include "solvers/linear/stiff_clusters.h"

#include <gtest/gtest.h>

#include <set>

#include "solvers/linear/linear_system.h"
#include "tests/support/spring_sheet.h"

namespace ft {
namespace {

using test::noise;
using Sheet = test::SpringSheet;

/// Edges of the sheet's first rows against edges of its last rows, with friction: stiff in every direction.
std::vector<PairTerm> folded_contacts(const Sheet& sheet, int count, float stiffness) {
  std::vector<PairTerm> terms;
  const int n = sheet.n * sheet.n;
  for (int k = 0; k < count; ++k) {
    PairTerm t;
    t.vertex = {2 * k, 2 * k + 1, n - 2 - 2 * k, n - 1 - 2 * k};
    t.weight = {0.6f, 0.4f, -0.3f, -0.7f};
    const Vec3f normal = Vec3f(float(noise(at(k), 1)), float(noise(at(k), 2)), 1).normalized();
    t.stiffness = stiffness * (normal * normal.transpose() + 0.3f * Mat3f::Identity());
    terms.push_back(t);
  }
  return terms;
}

struct Built {
  BlockMatrix matrix;
  ExtraRows extra;
  StiffClusters clusters;

  Built(const Sheet& sheet, std::span<const PairTerm> terms, std::span<const char> held) {
    matrix.reset(sheet.pattern);
    sheet.fill(matrix);
    std::vector<ExtraBlock> added;
    std::vector<StiffClusters::Coupling> couplings;
    for (std::size_t t = 0; t < terms.size(); ++t)
      for (std::uint8_t a = 0; a < 4; ++a)
        for (std::uint8_t b = 0; b < 4; ++b) {
          const int row = terms[t].vertex[a], column = terms[t].vertex[b];
          if (column < row) continue;
          const int place = sheet.pattern.find(row, column);
          if (place < 0) {
            added.push_back({row, column, static_cast<int>(t), a, b});
            continue;
          }
          matrix.blocks[at(place)] += (terms[t].weight[a] * terms[t].weight[b]) * terms[t].stiffness;
          if (row != column) couplings.push_back({row, column, place});
        }
    extra.add(added, terms, sheet.x.size());
    clusters.build(matrix, extra, held, couplings);
  }
};

TEST(StiffClusters, Are_what_contact_ties_together_and_nobody_is_in_two_or_held) {
  const Sheet sheet(20);
  std::vector<char> held(sheet.x.size(), 0);
  EXPECT_EQ(Built(sheet, {}, held).clusters.count(), 0);
  Built loose(sheet, folded_contacts(sheet, 10, 1), held);  // hardly touches
  loose.clusters.build(loose.matrix, loose.extra, held, {});
  EXPECT_EQ(loose.clusters.count(), 0);
  held[4] = held[9] = 1;
  const Built built(sheet, folded_contacts(sheet, 10, 1e6f), held);
  ASSERT_GT(built.clusters.count(), 0);
  std::set<int> seen;
  for (int c = 0; c < built.clusters.count(); ++c) {
    const auto members = built.clusters.members(c);
    EXPECT_GE(members.size(), 2u);
    EXPECT_LE(members.size(), at(StiffClusters::k_most_vertices));
    EXPECT_TRUE(std::ranges::is_sorted(members));
    for (const int v : members) {
      EXPECT_TRUE(seen.insert(v).second) << v;
      EXPECT_EQ(held[at(v)], 0) << v;
    }
  }
  for (int v = 0; v < sheet.n * sheet.n; ++v) EXPECT_EQ(built.clusters.has(at(v)), seen.contains(v)) << v;
  for (const int v : {0, 1, 439, 440}) EXPECT_TRUE(seen.contains(v)) << v;  // of the first contact
  EXPECT_FALSE(seen.contains(4));
  EXPECT_FALSE(seen.contains(200));
}

TEST(StiffClusters, Solve_their_block_of_the_matrix) {
  const Sheet sheet(20);
  const std::vector<char> held(sheet.x.size(), 0);
  const auto terms = folded_contacts(sheet, 30, 1e5f);
  const Built built(sheet, terms, held);
  ASSERT_GT(built.clusters.count(), 0);
  Eigen::MatrixXd whole = test::dense(built.matrix);
  for (std::size_t i = 0; i < sheet.x.size(); ++i)
    for (int k = built.extra.start[i]; k < built.extra.start[i] + built.extra.used[i]; ++k)
      whole.block<3, 3>(3 * static_cast<int>(i), 3 * built.extra.column[at(k)]) =
          built.extra.value[at(k)].cast<double>();
  for (int c = 0; c < built.clusters.count(); ++c) {
    const auto v = built.clusters.members(c);
    const int n = 3 * static_cast<int>(v.size());
    Eigen::MatrixXd block(n, n);
    Eigen::VectorXd x(n);
    for (std::size_t a = 0; a < v.size(); ++a) {
      for (int k = 0; k < 3; ++k) x[3 * static_cast<int>(a) + k] = noise(at(v[a]), 10 + at(k));
      for (std::size_t b = 0; b < v.size(); ++b)
        block.block<3, 3>(3 * static_cast<int>(a), 3 * static_cast<int>(b)) = whole.block<3, 3>(3 * v[a], 3 * v[b]);
    }
    const Eigen::VectorXd b = block * x;
    std::vector<Vec4f> r(v.size()), out(v.size());
    for (std::size_t a = 0; a < v.size(); ++a) r[a] << b.segment<3>(3 * static_cast<int>(a)).cast<float>(), 0;
    built.clusters.solve(c, r, out);
    // Floats, and what is stiff is a thousand times stiffer than what is not.
    for (std::size_t a = 0; a < v.size(); ++a) {
      EXPECT_LT((out[a].head<3>().cast<double>() - x.segment<3>(3 * static_cast<int>(a))).norm(), 1e-2) << c;
      EXPECT_EQ(out[a][3], 0);
    }
  }
}

// A matrix that is not what it should be does not spoil a solve.
TEST(StiffClusters, Are_smoothed_one_by_one_where_their_block_is_not_definite) {
  const Sheet sheet(10);
  const std::vector<char> held(sheet.x.size(), 0);
  auto terms = folded_contacts(sheet, 1, 1e5f);
  Built built(sheet, terms, held);
  for (Mat3f& value : built.extra.value) value *= 3;
  built.clusters.build(built.matrix, built.extra, held, {});
  ASSERT_EQ(built.clusters.count(), 1);
  const auto v = built.clusters.members(0);
  std::vector<Vec4f> r(v.size(), Vec4f(1, 2, 3, 0)), out(v.size());
  built.clusters.solve(0, r, out);
  for (std::size_t a = 0; a < v.size(); ++a) {
    const Mat3f block = built.matrix.blocks[at(sheet.pattern.diagonal[at(v[a])])];
    EXPECT_LT((block * out[a].head<3>() - r[a].head<3>()).norm(), 1e-2);
  }
}

TEST(StiffClusters, Spare_the_linear_solver_what_is_stiff_between_layers) {
  const Sheet sheet(40);
  const std::vector<char> fixed(sheet.x.size(), 0);
  LinearSystem system(sheet.pattern, sheet.rest, {.tolerance = 1e-2, .max_iterations = 5000});
  sheet.fill(system.begin());
  system.add_pair_terms(folded_contacts(sheet, 100, 1e6f));
  std::vector<Vec3> x;
  const LinearReport report = system.solve(sheet.load(), fixed, x);
  EXPECT_TRUE(report.converged);
  EXPECT_LT(report.iterations, 200);  // 148, and 1351 where every vertex is smoothed alone
}

}  // namespace
}  // namespace ft
