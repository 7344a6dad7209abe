// `preview`: bakes as one page that needs nothing else: player, colours by strain and gap, plots, and the primaries'
// paths in all the bakes over each other. The page is made of the files in baker/preview and of three.js, all of which
// are inside the program.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "baker/core/result.h"

namespace ft::inline baker {

struct PreviewOptions {
  std::vector<std::filesystem::path> folders;  ///< of bakes, the first one plays; one that is unfinished is shown as
                                               ///< far as it has come
  std::filesystem::path output;                ///< empty: preview.html in the first folder
  double curve_megabytes = 64;  ///< > 0: of the page; curves that are more have a share of their strands in it
};

/// Gaps are shown up to here [m].
inline constexpr double k_preview_gap_range = 0.02;

struct PreviewPage {
  std::string text;
  std::vector<std::string> notes;  ///< what of the bakes it does not show; the page says the same
};

/// output is not looked at. Errors: no manifest, caches that do not belong to it (k_input).
Result<PreviewPage> preview_page(const PreviewOptions& options);

/// Writes the page and says where; returns an exit code.
int run_preview(const PreviewOptions& options);

}  // namespace ft::inline baker
