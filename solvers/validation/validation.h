// The physics conformance table: scenes whose answer is known in closed form or from the literature, run through the
// same solver that bakes. For the command `validate`, and for the tests, which demand that every row passes. Adding
// one: a function in one of the files beside this, a line in validation.cpp.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ft::inline solvers {

/// One row: a value and what it should be.
struct ValidationCase {
  std::string name;  ///< of its scene, "hanging_sheet"
  std::string what;  ///< the quantity, in words
  double value = 0;
  double reference = 0;
  double tolerance = 0;  ///< absolute, in the unit of the value
  bool passed = false;   ///< |value - reference| <= tolerance
  std::string unit;
  std::string source;  ///< where the reference is from
};

/// Fills passed. A value that is not finite fails.
ValidationCase validation_case(std::string name, std::string what, double value, double reference, double tolerance,
                               std::string unit, std::string source);

struct ValidationScene {
  std::string_view name;   ///< snake_case
  std::string_view title;  ///< one sentence
  bool slow;               ///< takes more than two seconds
  std::vector<ValidationCase> (*run)();
};

std::span<const ValidationScene> validation_scenes();

/// Runs the scenes whose name contains the filter (all when empty). before: called with each scene, for progress; may
/// be empty.
std::vector<ValidationCase> run_validation(std::string_view filter = {},
                                           const std::function<void(const ValidationScene&)>& before = {});

}  // namespace ft::inline solvers
