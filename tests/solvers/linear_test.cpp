// The linear solver against dense solutions, its scaling, and what it does with held rows, contacts and broken input.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "baker/core/parallel.h"
#include "solvers/linear/extra_rows.h"
#include "solvers/linear/linear_system.h"
#include "solvers/linear/row_product.h"
#include "tests/support/spring_sheet.h"

namespace ft {
namespace {

using test::dense, test::fill_with_noise, test::noise;
using Sheet = test::SpringSheet;

Eigen::VectorXd dense_solution(const Sheet& sheet, std::span<const PairTerm> terms, std::span<const char> fixed) {
  BlockMatrix m;
  m.reset(sheet.pattern);
  sheet.fill(m);
  const int n = sheet.pattern.vertex_count();
  Eigen::MatrixXd a = dense(m);
  for (const PairTerm& t : terms)
    for (std::size_t p = 0; p < 4; ++p)
      for (std::size_t q = 0; q < 4; ++q)
        if (t.vertex[p] >= 0 && t.vertex[q] >= 0)
          a.block<3, 3>(3 * t.vertex[p], 3 * t.vertex[q]) += (t.weight[p] * t.weight[q] * t.stiffness).cast<double>();
  Eigen::VectorXd b(3 * n);
  const auto load = sheet.load();
  for (int i = 0; i < n; ++i) b.segment<3>(3 * i) = load[at(i)];
  for (int i = 0; i < n; ++i)
    if (fixed[at(i)]) {
      a.middleRows(3 * i, 3).setZero();
      a.middleCols(3 * i, 3).setZero();
      a.block<3, 3>(3 * i, 3 * i).setIdentity();
      b.segment<3>(3 * i).setZero();
    }
  return a.ldlt().solve(b);
}

double relative_error(std::span<const Vec3> x, const Eigen::VectorXd& exact) {
  double error = 0;
  for (std::size_t i = 0; i < x.size(); ++i) error += (x[i] - exact.segment<3>(3 * static_cast<int>(i))).squaredNorm();
  return std::sqrt(error) / exact.norm();
}

std::vector<PairTerm> contacts(const Sheet& sheet) {
  std::vector<PairTerm> terms;
  const int n = sheet.n * sheet.n;
  for (int k = 0; k < 20; ++k) {
    PairTerm t;  // a vertex of one end of the sheet against a triangle of the other: outside the pattern
    t.vertex = {k, n - 2 - k, n - 3 - k, n - 2 - sheet.n - k};
    t.weight = {1, -0.3f, -0.5f, -0.2f};
    const Vec3f normal = Vec3f(float(noise(at(k), 1)), float(noise(at(k), 2)), 1).normalized();
    t.stiffness = 500 * normal * normal.transpose();
    terms.push_back(t);
  }
  return terms;
}

/// Between vertices anywhere, so stiff that a cycle that is not symmetric turns residuals to the wrong side.
std::vector<PairTerm> contacts_anywhere(const Sheet& sheet, std::uint64_t seed) {
  std::vector<PairTerm> terms(60);
  for (std::size_t k = 0; k < terms.size(); ++k) {
    for (std::size_t v = 0; v < 4; ++v)
      terms[k].vertex[v] =
          static_cast<int>(random_uniform({.element = 4 * k + v}, 100 + seed) * double(sheet.x.size()));
    terms[k].weight = {1, -0.3f, -0.5f, -0.2f};
    const Vec3f normal = Vec3f(float(noise(k, 200 + seed)), float(noise(k, 300 + seed)), 0.5f).normalized();
    terms[k].stiffness = 1e6f * normal * normal.transpose();
  }
  return terms;
}

TEST(BlockPattern, Has_every_pair_of_a_stencil_once_whatever_order_and_however_often_it_comes) {
  const std::vector<std::array<int, 4>> lists[] = {{{5, 2, -1, -1}, {2, 5, 0, -1}}, {{5, 5, 3, 2}}};
  const BlockPattern pattern = make_pattern(6, lists);
  const std::vector<std::vector<int>> expected{{0, 2, 5}, {1}, {0, 2, 3, 5}, {2, 3, 5}, {4}, {0, 2, 3, 5}};
  EXPECT_EQ(pattern.block_count(), 11u);
  for (int i = 0; i < 6; ++i) {
    std::vector<int> columns;
    pattern.visit_row(i, [&](int j, int place) {
      columns.push_back(j);
      EXPECT_EQ(place, pattern.find(std::min(i, j), std::max(i, j)));
    });
    EXPECT_EQ(columns, expected[at(i)]) << i;
    EXPECT_EQ(pattern.find(i, i), pattern.diagonal[at(i)]);
  }
  EXPECT_EQ(pattern.find(1, 2), -1);
  EXPECT_EQ(BlockPattern().vertex_count(), 0);
}

TEST(RowProduct, Multiplies_rows_of_even_and_odd_length_by_both_halves_of_a_symmetric_matrix) {
  std::vector<std::array<int, 4>> springs;
  for (int i = 1; i < 12; ++i)
    for (int j = 0; j < i; j += 1 + i % 3) springs.push_back({i, j, -1, -1});
  const BlockPattern pattern = make_pattern(12, std::array{springs});
  BlockMatrix matrix;
  matrix.reset(pattern);
  fill_with_noise(matrix);
  // What is read beyond the end of a block counts for nothing.
  matrix.blocks.back().setConstant(std::numeric_limits<float>::quiet_NaN());
  std::vector<Vec4f> x(12);
  Eigen::VectorXd flat(36);
  int odd = 0;
  for (int i = 0; i < 12; ++i) {
    odd += (pattern.diagonal[at(i) + 1] - pattern.diagonal[at(i)]) % 2;
    x[at(i)] = Vec4f(float(noise(at(i), 90)), float(noise(at(i), 91)), float(noise(at(i), 92)), 0);
    flat.segment<3>(3 * i) = x[at(i)].head<3>().cast<double>();
  }
  EXPECT_GT(odd, 0);
  EXPECT_LT(odd, 12);
  const Eigen::VectorXd expected = dense(matrix) * flat;
  for (int i = 0; i < 12; ++i) {
    const Vec4f row = row_product(matrix, at(i), x.data());
    EXPECT_LT((row.head<3>().cast<double>() - expected.segment<3>(3 * i)).norm(), 1e-5);  // a hundred roundings
    EXPECT_EQ(row[3], 0);
  }
}

TEST(ExtraRows, Have_both_halves_of_what_is_added_up_in_each_place) {
  std::vector<PairTerm> terms(30);
  std::vector<ExtraBlock> blocks;
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(36, 36);
  for (int t = 0; t < 30; ++t) {
    PairTerm& term = terms[at(t)];
    term.weight = {0.7f, -0.3f, 0.2f, -0.6f};
    const Vec3f n(float(noise(at(t), 1)), float(noise(at(t), 2)), float(noise(at(t), 3)));
    term.stiffness = n * n.transpose();
    const int row = t % 5, column = 6 + t % 3 * 2;  // each of fifteen places twice, rows 5, 7, 9 and 11 have none
    blocks.push_back({row, column, t, 1, 3});
    const Mat3 block = (term.weight[1] * term.weight[3] * term.stiffness).cast<double>();
    expected.block<3, 3>(3 * row, 3 * column) += block;
    expected.block<3, 3>(3 * column, 3 * row) += block;
  }
  ExtraRows rows;
  rows.add(std::span(blocks).first(20), terms, 12);
  rows.add({}, terms, 12);
  rows.add(std::span(blocks).subspan(20), terms, 12);
  Eigen::MatrixXd found = Eigen::MatrixXd::Zero(36, 36);
  for (int i = 0; i < 12; ++i) {
    int last = -1;
    for (int k = rows.start[at(i)]; k < rows.start[at(i)] + rows.used[at(i)]; ++k) {
      EXPECT_GT(rows.column[at(k)], last);
      last = rows.column[at(k)];
      found.block<3, 3>(3 * i, 3 * last) += rows.value[at(k)].cast<double>();
    }
  }
  EXPECT_LT((found - expected).norm(), 1e-6 * expected.norm());
  rows.clear();
  EXPECT_TRUE(rows.empty());
}

class Solves : public testing::TestWithParam<LinearSettings::Preconditioner> {};

TEST_P(Solves, the_same_as_a_dense_factorisation_with_held_rows_and_contacts) {
  const Sheet sheet(12);
  std::vector<char> fixed(sheet.x.size(), 0);
  fixed[0] = fixed[3] = fixed[40] = 1;
  const auto terms = contacts(sheet);
  LinearSystem system(sheet.pattern, sheet.rest,
                      {.preconditioner = GetParam(), .tolerance = 1e-5, .max_iterations = 2000});
  sheet.fill(system.begin());
  system.add_pair_terms(terms);
  std::vector<Vec3> x(sheet.x.size());
  const LinearReport report = system.solve(sheet.load(), fixed, x);
  EXPECT_TRUE(report.converged);
  EXPECT_LT(relative_error(x, dense_solution(sheet, terms, fixed)), 2e-3);
  fixed[7] = fixed[41] = 1;  // more may be held without filling the matrix anew
  system.solve(sheet.load(), fixed, x);
  EXPECT_LT(relative_error(x, dense_solution(sheet, terms, fixed)), 2e-3);
  EXPECT_EQ(x[40], Vec3(0, 0, 0));
}

TEST_P(Solves, reports_failure_and_stays_finite_on_an_indefinite_or_broken_matrix) {
  const Sheet sheet(12);
  const std::vector<char> fixed(sheet.x.size(), 0);
  for (const float poison : {-1e5f, std::numeric_limits<float>::quiet_NaN()}) {
    LinearSystem system(sheet.pattern, sheet.rest, {.preconditioner = GetParam(), .tolerance = 1e-6});
    BlockMatrix& m = system.begin();
    sheet.fill(m);
    for (std::size_t i = 0; i < sheet.x.size(); i += 3)
      m.blocks[at(sheet.pattern.diagonal[i])].diagonal().array() += poison;
    system.add_pair_terms({});
    std::vector<Vec3> x(sheet.x.size());
    const LinearReport report = system.solve(sheet.load(), fixed, x);
    EXPECT_FALSE(report.converged);
    EXPECT_TRUE(all_finite(x));
  }
}

INSTANTIATE_TEST_SUITE_P(Both, Solves,
                         testing::Values(LinearSettings::Preconditioner::k_block_jacobi,
                                         LinearSettings::Preconditioner::k_multigrid));

TEST(LinearSystem, needs_about_as_many_multigrid_iterations_for_a_fine_sheet_as_for_a_coarse_one) {
  int iterations[2] = {};
  for (const int which : {0, 1}) {
    const Sheet sheet(which == 0 ? 25 : 100);
    const std::vector<char> fixed(sheet.x.size(), 0);
    LinearSystem system(sheet.pattern, sheet.rest, {.tolerance = 1e-3});
    sheet.fill(system.begin());
    system.add_pair_terms({});
    std::vector<Vec3> x(sheet.x.size());
    const LinearReport report = system.solve(sheet.load(), fixed, x);
    EXPECT_TRUE(report.converged);
    iterations[which] = report.iterations;
  }
  EXPECT_LE(iterations[1], 2 * iterations[0] + 4) << iterations[0];
  EXPECT_LT(iterations[1], 40);
}

TEST(LinearSystem, stops_where_what_is_left_is_enough_but_never_before_it_is_a_share_of_the_right_side) {
  const Sheet sheet(25);
  const std::vector<char> fixed(sheet.x.size(), 0);
  LinearSystem system(sheet.pattern, sheet.rest, {.tolerance = 1e-3});
  const auto solve = [&](double enough) {
    sheet.fill(system.begin());
    system.add_pair_terms({});
    std::vector<Vec3> x;
    return system.solve(sheet.load(), fixed, x, enough);
  };
  const LinearReport whole = solve(0);
  ASSERT_GT(whole.start_norm, 0);
  EXPECT_LE(whole.residual, 1e-3);
  const LinearReport same = solve(0.9e-3 * whole.start_norm), less = solve(3e-3 * whole.start_norm);
  EXPECT_EQ(same.iterations, whole.iterations);
  EXPECT_LT(less.iterations, whole.iterations);
  EXPECT_LE(less.residual, 3e-3);
  EXPECT_GT(less.residual, 1e-3);
  const LinearReport least = solve(10 * whole.start_norm);
  EXPECT_TRUE(least.converged);
  EXPECT_GE(least.iterations, 1);
  EXPECT_LE(least.residual, 5e-3);
}

TEST(LinearSystem, makes_less_of_what_is_left_however_loose_the_tolerance_is) {
  const Sheet sheet(20);
  const std::vector<char> fixed(sheet.x.size(), 0);
  LinearSystem system(sheet.pattern, sheet.rest, {.tolerance = 0.4});
  sheet.fill(system.begin());
  system.add_pair_terms(contacts_anywhere(sheet, 1));
  std::vector<Vec3> x;
  const LinearReport report = system.solve(sheet.load(), fixed, x, 1e9);
  EXPECT_TRUE(report.converged);
  EXPECT_GT(report.iterations, 1);
  EXPECT_LE(report.residual, 0.5);
}

TEST(LinearSystem, takes_further_terms_between_two_solves) {
  const Sheet sheet(12);
  std::vector<char> fixed(sheet.x.size(), 0);
  fixed[0] = fixed[40] = 1;
  auto terms = contacts(sheet);
  const auto more = contacts_anywhere(sheet, 3);
  LinearSystem system(sheet.pattern, sheet.rest, {.tolerance = 1e-5, .max_iterations = 2000});
  sheet.fill(system.begin());
  std::vector<Vec3> x;
  for (const auto& part : {terms, more}) {
    system.add_pair_terms(part);
    EXPECT_TRUE(system.solve(sheet.load(), fixed, x).converged);
  }
  terms.insert(terms.end(), more.begin(), more.end());
  EXPECT_LT(relative_error(x, dense_solution(sheet, terms, fixed)), 1e-3);
}

TEST(LinearSystem, gives_the_same_bits_when_it_was_given_back_and_filled_anew) {
  const Sheet sheet(12);
  const std::vector<char> fixed(sheet.x.size(), 0);
  LinearSystem system(sheet.pattern, sheet.rest, {});
  EXPECT_EQ(system.block_count(), sheet.pattern.block_count());
  EXPECT_FALSE(system.is_filled());
  std::vector<Vec3> first, again;
  for (std::vector<Vec3>* const x : {&first, &again}) {
    sheet.fill(system.begin());
    system.add_pair_terms(contacts(sheet));
    EXPECT_TRUE(system.is_filled());
    EXPECT_TRUE(system.solve(sheet.load(), fixed, *x).converged);
    EXPECT_TRUE(system.is_filled());
    system.give_back();
    EXPECT_FALSE(system.is_filled());
  }
  EXPECT_EQ(first, again);
}

TEST(LinearSystem, knows_how_stiff_a_vertex_is_alone) {
  const Sheet sheet(5);
  LinearSystem system(sheet.pattern, sheet.rest, {});
  BlockMatrix& matrix = system.begin();
  sheet.fill(matrix);
  const Vec3 along = Vec3(1, 2, -1).normalized();
  const Mat3 block = matrix.blocks[at(sheet.pattern.diagonal[7])].cast<double>();
  EXPECT_NEAR(system.stiffness_along(7, along), along.dot(block * along), 1e-5 * block.norm());
  PairTerm term;
  term.vertex[0] = 7;
  term.weight[0] = 1;
  term.stiffness = 100 * Mat3f::Identity();
  system.add_pair_terms(std::vector{term});
  EXPECT_NEAR(system.stiffness_along(7, along), 100 + along.dot(block * along), 1e-5 * (100 + block.norm()));
}

TEST(LinearSystem, solves_sheets_with_contacts_a_thousand_times_stiffer_than_they_are) {
  const Sheet sheet(20);
  const std::vector<char> fixed(sheet.x.size(), 0);
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const auto terms = contacts_anywhere(sheet, seed);
    LinearSystem system(sheet.pattern, sheet.rest, {.tolerance = 3e-2, .max_iterations = 2000});
    sheet.fill(system.begin());
    system.add_pair_terms(terms);
    std::vector<Vec3> x(sheet.x.size());
    EXPECT_TRUE(system.solve(sheet.load(), fixed, x).converged) << seed;
    EXPECT_LT(relative_error(x, dense_solution(sheet, terms, fixed)), 0.1) << seed;
  }
}

TEST(LinearSystem, gives_the_same_bits_for_any_number_of_threads) {
  const Sheet sheet(60);
  const std::vector<char> fixed(sheet.x.size(), 0);
  for (const auto& terms : {contacts(sheet), contacts_anywhere(sheet, 0)}) {
    std::vector<Vec3> first;
    for (const int threads : {1, 2, 3, 8}) {
      const ThreadLimit limit(threads);
      LinearSystem system(sheet.pattern, sheet.rest, {.tolerance = 1e-3});
      sheet.fill(system.begin());
      system.add_pair_terms(terms);
      std::vector<Vec3> x(sheet.x.size());
      system.solve(sheet.load(), fixed, x);
      if (first.empty()) first = x;
      EXPECT_EQ(first, x) << threads;
    }
  }
}

TEST(LinearSystem, solves_loose_vertices_and_separate_pieces) {
  std::vector<std::array<int, 4>> springs;
  for (int i = 0; i < 199; ++i)
    if (i != 99) springs.push_back({i, i + 1, -1, -1});
  const BlockPattern pattern = make_pattern(400, std::array{springs});  // two ropes and 200 loose vertices
  std::vector<Vec3> rest;
  for (int i = 0; i < 400; ++i) rest.emplace_back(0.01 * i, 0, 0);
  LinearSystem system(pattern, rest, {.tolerance = 1e-6});
  BlockMatrix& m = system.begin();
  for (std::size_t i = 0; i < 400; ++i) m.blocks[at(pattern.diagonal[i])] += Mat3f::Identity();
  for (const auto& s : springs)
    for (const int a : {0, 1})
      for (int b = a; b < 2; ++b)
        m.blocks[at(pattern.find(s[at(a)], s[at(b)]))] += Mat3f::Identity() * (a == b ? 50.f : -50.f);
  system.add_pair_terms({});
  std::vector<Vec3> x(400);
  const LinearReport report = system.solve(std::vector<Vec3>(400, Vec3(1, 2, 3)), std::vector<char>(400, 0), x);
  EXPECT_TRUE(report.converged);
  for (const Vec3& v : x) EXPECT_LT((v - Vec3(1, 2, 3)).norm(), 1e-4);
}

}  // namespace
}  // namespace ft
