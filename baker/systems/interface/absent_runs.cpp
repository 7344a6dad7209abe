#include "baker/systems/interface/absent_runs.h"

#include <algorithm>

namespace ft::inline baker {

AbsentRuns runs_of(std::string system, std::span<const char> marks) {
  AbsentRuns out{std::move(system), {}};
  const int count = static_cast<int>(marks.size());
  for (int v = 0; v < count; ++v) {
    if (marks[at(v)] == 0) continue;
    if (v > 0 && marks[at(v - 1)] != 0)
      ++out.runs.back()[1];
    else
      out.runs.push_back({v, 1});
  }
  return out;
}

std::vector<char> marks_of(const AbsentRuns& runs, int count) {
  std::vector<char> out(at(count), 0);
  for (const auto& [first, length] : runs.runs) {
    const int begin = std::clamp(first, 0, count), end = begin + std::clamp(length, 0, count - begin);
    std::fill(out.begin() + begin, out.begin() + end, 1);
  }
  return out;
}

int vertex_count(const AbsentRuns& runs) {
  int out = 0;
  for (const auto& run : runs.runs) out += run[1];
  return out;
}

std::vector<AbsentRuns> absent_of(const Solver& solver, const State& state) {
  std::vector<AbsentRuns> out;
  for (int s = 0; s < solver.system_count(); ++s) {
    AbsentRuns runs = runs_of(solver.system_name(s), solver.collider_absent(state, s));
    if (!runs.runs.empty()) out.push_back(std::move(runs));
  }
  return out;
}

}  // namespace ft::inline baker
