// The stand-ins, in one list. Adding one: a file beside this, a line in registry.cpp; the contract tests then run over
// it.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "solvers/standins/standin.h"

namespace ft::inline solvers {

struct StandInKind {
  std::string_view name;
  Result<std::unique_ptr<StandIn>> (*make)(const StandInSpec& spec);
};

std::span<const StandInKind> stand_in_kinds();

/// Refuses, by a usage error, what makes no sense: a kind that is not known, measures that are missing or out of range,
/// and a supporting kind that would be added to the support of the clip.
Result<std::unique_ptr<StandIn>> make_stand_in(const StandInSpec& spec);

}  // namespace ft::inline solvers
