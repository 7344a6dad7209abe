// State: all that changes in a step. Model never changes, scratch is forgotten, and nothing hidden survives a step:
// hash(State) is the determinism test, save(State) is the checkpoint, resuming is the same code path as continuing.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "baker/core/byte_parts.h"
#include "baker/core/hash.h"
#include "baker/core/result.h"
#include "baker/core/types.h"

namespace ft {

/// A named column of numbers. Doubles carry positions exactly; integers up to 2^53 go in as doubles too.
struct StateBlock {
  std::string name;
  std::vector<double> values;
};

struct State {
  int frame = 0;    ///< frame of the shot that this state belongs to; pre-roll frames are below the first
  double time = 0;  ///< s from the first frame of the shot
  std::vector<StateBlock> blocks;

  /// The block of that name; made (empty) when missing.
  std::vector<double>& block(std::string_view name);
  const std::vector<double>* find(std::string_view name) const;
};

Hash128 hash(const State& state);
/// What is saved of a state, which must outlive it.
ByteParts parts_of(const State& state);
Bytes save(const State& state);
/// Refuses anything cut, longer than said, of another version or whose content hash does not match.
Result<State> load_state(std::span<const std::byte> data);

/// Views of a block as points, without copying.
inline std::span<Vec3> as_points(std::vector<double>& values) {
  return {reinterpret_cast<Vec3*>(values.data()), values.size() / 3};
}
inline std::span<const Vec3> as_points(const std::vector<double>& values) {
  return {reinterpret_cast<const Vec3*>(values.data()), values.size() / 3};
}

}  // namespace ft
