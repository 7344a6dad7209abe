// A plan in words, for --dry-run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "baker/plan/plan.h"

namespace ft::inline baker {

/// Which stage of a chain it is, and what is baked in it: "stage 2 of 2: cloth "badge" on "cloth.robe"".
std::string stage_line(const BakePlan& plan);

std::vector<std::string> plan_lines(const BakePlan& plan, const std::filesystem::path& folder);
/// "0.4 x 0.9 x 0.3 m".
std::string box_text(const Box& box);
/// "1.4 MB", powers of 1000.
std::string size_text(std::uint64_t bytes);
/// "sewn: 851 stitches in 94 seams".
std::string sewing_text(const Mesh& mesh);
/// A character in words: sizes, units, clips; of an inspected one its parts, too.
std::vector<std::string> character_lines(const CharacterInfo& info);

}  // namespace ft::inline baker
