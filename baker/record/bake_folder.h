// Names in the output folder, in one place.
//   manifest.json  report.json  SYSTEM.abc  SYSTEM.pc2  SYSTEM.obj      what a user takes
//   .state/        checkpoint  lock  import/                          what the program needs to go on
#pragma once

#include <filesystem>
#include <string>

namespace ft::inline baker {

struct BakeFolder {
  std::filesystem::path path;

  std::filesystem::path state() const { return path / ".state"; }
  std::filesystem::path lock() const { return state() / "lock"; }
  std::filesystem::path checkpoint() const { return state() / "checkpoint"; }
  std::filesystem::path import_cache() const { return state() / "import"; }
  std::filesystem::path manifest() const { return path / "manifest.json"; }
  std::filesystem::path report() const { return path / "report.json"; }

  /// Where a bake goes without --out: "shot.bake" beside shot.toml.
  static BakeFolder beside(const std::filesystem::path& shot_file) {
    return {std::filesystem::path(shot_file).replace_extension(".bake")};
  }
};

}  // namespace ft::inline baker
