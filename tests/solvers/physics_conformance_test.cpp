// Every scene of the conformance table, every row of it. The same table that `validate` prints.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "solvers/validation/validation.h"
#include "tests/support/sanitized.h"

namespace ft {
namespace {

class PhysicsConformance : public testing::TestWithParam<ValidationScene> {};

TEST_P(PhysicsConformance, Every_row_is_within_its_tolerance) {
  if (test::k_thread_sanitized && GetParam().slow)
    GTEST_SKIP() << "thousands of small loops: the quick rows run the same ones";
  const auto rows = GetParam().run();
  EXPECT_FALSE(rows.empty());
  for (const ValidationCase& row : rows) {
    EXPECT_EQ(row.name, GetParam().name);
    EXPECT_FALSE(row.source.empty()) << row.what;
    EXPECT_TRUE(row.passed) << row.what << ": " << row.value << " " << row.unit << ", expected " << row.reference
                            << " +- " << row.tolerance << " (" << row.source << ")";
  }
}

INSTANTIATE_TEST_SUITE_P(Table, PhysicsConformance,
                         testing::ValuesIn(validation_scenes().begin(), validation_scenes().end()),
                         [](const auto& scene) {
                           return std::string(scene.param.name) + (scene.param.slow ? "_slow" : "");
                         });

TEST(Validation, A_row_passes_within_its_tolerance_only) {
  EXPECT_TRUE(validation_case("s", "w", 1.01, 1, 0.011, "m", "x").passed);
  EXPECT_FALSE(validation_case("s", "w", 1.02, 1, 0.011, "m", "x").passed);
  EXPECT_FALSE(validation_case("s", "w", 0.98, 1, 0.011, "m", "x").passed);
  EXPECT_FALSE(validation_case("s", "w", std::nan(""), 1, 0.011, "m", "x").passed);
}

TEST(Validation, A_filter_runs_the_scenes_that_it_names) {
  int started = 0;
  const auto rows = run_validation("terminal", [&](const ValidationScene& scene) {
    ++started;
    EXPECT_EQ(scene.name, "terminal_velocity");
  });
  EXPECT_EQ(started, 1);
  EXPECT_EQ(rows.size(), 1u);
  EXPECT_TRUE(run_validation("no such scene").empty());
}

}  // namespace
}  // namespace ft
