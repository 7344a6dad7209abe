// Where a bake stands before anything is done: nothing there, up to date, stale and why, or begun and not finished.
#pragma once

#include <string>
#include <vector>

#include "baker/plan/inputs.h"
#include "baker/record/bake_folder.h"
#include "baker/record/manifest.h"

namespace ft::inline baker {

struct BakeStatus {
  enum class Kind { k_absent, k_up_to_date, k_stale, k_unfinished };
  Kind kind = Kind::k_absent;
  std::vector<std::string> reasons;  ///< stale or unfinished: one sentence each
  Manifest before;                   ///< what the folder's manifest says; empty when absent
};

/// The manifest of a bake of these inputs, before its first frame: no systems, no frames.
Manifest manifest_of(const BakeInputs& inputs);

/// Compares the folder with what is asked for; reads the caches' bytes, so that a cache that was changed or lost is
/// noticed.
BakeStatus find_bake_status(const BakeFolder& folder, const Manifest& now);

/// "up to date: shot.toml, 121 frames in /there" or "stale: cloth.dress.fabric changed from cotton to denim; dress.obj
/// changed".
std::string describe(const BakeStatus& status, const BakeFolder& folder);

}  // namespace ft::inline baker
