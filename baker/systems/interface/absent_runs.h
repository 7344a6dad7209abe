// What of the feasible collider a system does not meet, between a mark for every vertex and the runs that manifests
// hold.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "solvers/base/solver.h"

namespace ft::inline baker {

AbsentRuns runs_of(std::string system, std::span<const char> marks);
/// A mark for each of `count` vertices: 1, else 0. What runs say beyond them is left out.
std::vector<char> marks_of(const AbsentRuns& runs, int count);
/// How many vertices the runs have.
int vertex_count(const AbsentRuns& runs);
/// Of all systems of a solver that do not meet all of the collider, at the state's time.
std::vector<AbsentRuns> absent_of(const Solver& solver, const State& state);

}  // namespace ft::inline baker
