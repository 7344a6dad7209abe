// A character of a shot as the file has it, made ready: imported, judged, repeated, placed, and yielding to stand-ins.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "baker/plan/plan.h"

namespace ft::inline baker {

/// With the shot's pre-roll. Adds to `notes`. Refused: no surface, poses that are not finite, sizes that are a slip of
/// units.
Result<PrimaryPlan> plan_character(const Shot& shot, const PrimarySpec& spec, const Importer& importer,
                                   const std::filesystem::path& import_cache, std::vector<std::string>& notes);

}  // namespace ft::inline baker
