// `preview`: a bake as one page that needs nothing else: player, colours by strain and gap, plots. The page is made of
// the files in baker/preview and of three.js, all of which are inside the program.
#pragma once

#include <filesystem>
#include <string>

#include "baker/core/result.h"

namespace ft {

struct PreviewOptions {
  std::filesystem::path folder;  ///< of a bake; an unfinished one is shown as far as it has come
  std::filesystem::path output;  ///< empty: preview.html in the folder
};

/// Gaps are shown up to here [m].
inline constexpr double k_preview_gap_range = 0.02;

/// The page's text. Errors: no manifest, caches that do not belong to it (k_input).
Result<std::string> preview_page(const std::filesystem::path& bake_folder);

/// Writes the page and says where; returns an exit code.
int run_preview(const PreviewOptions& options);

}  // namespace ft
