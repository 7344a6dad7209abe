// A secondary that was baked in an earlier stage as a body for later ones: what it looks like, and how it moves, which
// is known once its bake has come to its end. The frames of the pre-roll are kept with those of the shot, so that who
// is on it starts where it starts and goes through the same pre-roll.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "baker/plan/plan.h"
#include "baker/record/bake_folder.h"

namespace ft::inline baker {

struct Carrier {
  std::string name;                  ///< as others refer to it, "cloth.robe"
  std::string caches;                ///< name of its system, "robe"
  std::shared_ptr<const Mesh> mesh;  ///< as its file has it, placed; its bind pose
  bool sheet = false;
  bool liquid = false;
  std::size_t primary = 0;  ///< whom it is on, into BakePlan::primaries
};

/// Of all groups of a plan, before their meshes are given away.
std::vector<Carrier> carriers_of(const BakePlan& plan);

/// As it stands where its bake starts: for a look at later stages before the first has been baked.
PrimaryPlan standing_carrier(const Carrier& carrier, const BakePlan& plan);
/// As its bake has moved it. Error: what was recorded of it is gone or spoilt.
Result<PrimaryPlan> moving_carrier(const Carrier& carrier, const BakePlan& plan, const BakeFolder& folder);

}  // namespace ft::inline baker
