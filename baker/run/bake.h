// The conductor: shot -> plan -> walk of the frames -> caches. One call is one `followthrough bake`. A frame's walk:
//
//   advance every group's solver -> certificate -> snapshot -> writer thread: caches (durable), then the checkpoint
//
// Nothing but State survives a frame, so a resumed bake writes the same bytes as an undisturbed one. Importer and
// solver come in as services: tests bring their own.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "baker/plan/plan.h"
#include "baker/run/progress.h"

namespace ft::inline baker {

struct BakeOptions {
  std::filesystem::path shot_file;
  std::filesystem::path folder;  ///< empty: SHOT.bake beside the shot file
  std::optional<FrameRange> frames;
  std::vector<std::string> overrides;  ///< "cloth.dress.fabric=denim"
  bool resume = false;                 ///< go on from the checkpoint, if there is one
  bool force = false;                  ///< bake even when up to date
  bool dry_run = false;                ///< check and plan only
  bool explain = false;                ///< say whether the bake is up to date and why not; nothing else
};

using SolverFactory = std::function<Result<std::unique_ptr<Solver>>(SystemGroup&)>;

struct BakeServices {
  Importer importer;
  SolverFactory make_solver;
};

struct BakeResult {
  int exit_code = 0;
  std::vector<std::string> lines;   ///< answer of --explain and --dry-run, and "up to date"; for stdout
  std::vector<std::string> faults;  ///< for stderr
  /// Of a finished bake whose water is to go out as OpenVDB, too: its folder; else empty.
  std::filesystem::path volumes{};
};

/// The solver that the group's kind has for it.
Result<std::unique_ptr<Solver>> make_group_solver(SystemGroup& group);

/// progress is told of the walk only; what ends before the walk is in the result alone.
BakeResult bake(const BakeOptions& options, const BakeServices& services, Progress& progress);

}  // namespace ft::inline baker
