#include "baker/systems/interface/collider_slice.h"

#include "baker/systems/interface/absent_runs.h"

namespace ft::inline baker {

std::vector<AbsentRuns> sliced(const AbsentRuns& runs, std::span<const ColliderSlice> slices) {
  std::size_t count = 0;  // every vertex is of one slice
  for (const ColliderSlice& slice : slices) count += slice.vertices.size();
  const std::vector<char> all = marks_of(runs, static_cast<int>(count));
  std::vector<AbsentRuns> out;
  for (const ColliderSlice& slice : slices) {
    std::vector<char> marks;
    for (const int v : slice.vertices) marks.push_back(all[at(v)]);
    AbsentRuns own = runs_of(runs.system, marks);
    own.collider = slice.name;
    if (!own.runs.empty()) out.push_back(std::move(own));
  }
  return out;
}

}  // namespace ft::inline baker
