// The fields of moving air, in one list. Adding one: a file beside this, a line in registry.cpp; the contract tests
// then run over it.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "solvers/wind/wind_field.h"

namespace ft::inline solvers {

struct WindFieldKind {
  std::string_view name;
  Result<std::unique_ptr<WindField>> (*make)(const WindFieldSpec& spec);
};

std::span<const WindFieldKind> wind_field_kinds();

/// Refuses, by a usage error, what makes no sense: a kind that is not known, a field without direction or size.
Result<std::unique_ptr<WindField>> make_wind_field(const WindFieldSpec& spec);

}  // namespace ft::inline solvers
