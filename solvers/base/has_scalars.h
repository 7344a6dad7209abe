// What a solver says of the vertices of its meshes beside their places, by name: foam on water, wet ground. Caches have
// it as attributes of the vertices.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "baker/core/state.h"

namespace ft::inline solvers {

class HasScalars {
 public:
  virtual ~HasScalars() = default;

  /// Of a system that is a mesh: names, none twice. The same in all frames.
  virtual std::span<const std::string> scalar_names(int system) const = 0;
  /// Those of a state: a list for each name, a value for each vertex.
  virtual void system_scalars(const State& state, int system, std::vector<std::vector<float>>& values) const = 0;
};

}  // namespace ft::inline solvers
