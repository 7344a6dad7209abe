// Names in the output folder, in one place.
//   manifest.json  report.json  SYSTEM.abc  SYSTEM.pc2  SYSTEM.obj        what a user takes
//   .state/        checkpoint  stages  SYSTEM.motion.pc2  SYSTEM.flow.pc2  lock  import/   what the program needs to go
//   on
#pragma once

#include <filesystem>
#include <string>

namespace ft::inline baker {

struct BakeFolder {
  std::filesystem::path path;

  std::filesystem::path state() const { return path / ".state"; }
  std::filesystem::path lock() const { return state() / "lock"; }
  std::filesystem::path checkpoint() const { return state() / "checkpoint"; }
  /// What earlier stages have come to, and how each of their systems moves in all frames, for the stages after them.
  std::filesystem::path stages() const { return state() / "stages"; }
  std::filesystem::path motion(const std::string& system) const { return state() / (system + ".motion.pc2"); }
  /// Of a liquid: how it flows at its vertices [m/s].
  std::filesystem::path flow(const std::string& system) const { return state() / (system + ".flow.pc2"); }
  std::filesystem::path import_cache() const { return state() / "import"; }
  std::filesystem::path manifest() const { return path / "manifest.json"; }
  std::filesystem::path report() const { return path / "report.json"; }

  /// Where a bake goes without --out: "shot.bake" beside shot.toml.
  static BakeFolder beside(const std::filesystem::path& shot_file) {
    return {std::filesystem::path(shot_file).replace_extension(".bake")};
  }
};

}  // namespace ft::inline baker
