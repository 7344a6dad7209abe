// The energies of cloth, in one list. Adding one: a file beside this, a line in registry.cpp; the contract tests then
// run over it.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "solvers/energies/air_drag.h"
#include "solvers/energies/cloth_topology.h"
#include "solvers/energies/energy.h"

namespace ft::inline solvers {

struct ClothEnergyKind {
  std::string_view name;
  std::unique_ptr<Energy> (*make)(const ClothTopology& topology, const AirSettings& air);
  bool elastic;        ///< knows no place and no direction in space: no force at rest, none from rigid motion
  bool exact_hessian;  ///< equals the second derivative where that is positive definite; false: more than half of it
};

std::span<const ClothEnergyKind> cloth_energy_kinds();

/// One of each kind. They copy what they need of the topology.
std::vector<std::unique_ptr<Energy>> make_cloth_energies(const ClothTopology& topology, const AirSettings& air);

}  // namespace ft::inline solvers
