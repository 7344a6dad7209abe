// State: all that changes in a step. Model never changes, scratch is forgotten, and nothing hidden survives a step:
// hash(State) is the determinism test, save(State) is the checkpoint, resuming is the same code path as continuing.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "baker/core/byte_parts.h"
#include "baker/core/hash.h"
#include "baker/core/result.h"
#include "baker/core/types.h"

namespace ft {

/// Numbers that copies of a state have in common until one of them is changed: a checkpoint is a copy that costs
/// nothing while it waits to be written. Copies may be read in several threads; each belongs to one.
class SharedNumbers {
 public:
  SharedNumbers() = default;
  SharedNumbers(std::vector<double> values) : values_(std::make_shared<std::vector<double>>(std::move(values))) {}
  const std::vector<double>& read() const;
  /// To be changed: first copied, if somebody else has them.
  std::vector<double>& write();
  /// Whether both are one.
  bool is(const SharedNumbers& other) const { return values_ == other.values_; }

 private:
  std::shared_ptr<std::vector<double>> values_;  ///< null: none
};

/// A named column of numbers. Doubles carry positions exactly; integers up to 2^53 go in as doubles too.
struct StateBlock {
  std::string name;
  SharedNumbers values;
};

struct State {
  int frame = 0;    ///< frame of the shot that this state belongs to; pre-roll frames are below the first
  double time = 0;  ///< s from the first frame of the shot
  std::vector<StateBlock> blocks;

  /// The block of that name, to be changed; made (empty) when missing.
  std::vector<double>& block(std::string_view name);
  /// Puts others in the place of a block's numbers, whoever else has the old ones.
  void set(std::string_view name, std::vector<double> values);
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
