// Runs a bake and measures it from outside: its CPU time is limited, not its wall time, so that what else the machine
// does decides nothing. For sweep_tool.cpp.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "baker/core/result.h"

namespace ft::bench {

/// Exit code of what was ended because it took longer than it may, as timeout(1) has it.
inline constexpr int k_took_too_long = 124;

struct MeasuredRun {
  int exit_code = 0;       ///< 128 + the signal, where one ended it
  double cpu_seconds = 0;  ///< with all that it started
  /// Between one line of its progress that begins with "frame" and the next; the first: since the start.
  std::vector<double> frame_cpu_seconds;
};

/// What it says, on both channels, goes to `log`. After `limit` seconds of CPU it is asked to end (SIGTERM), and made
/// to a tenth of that later.
Result<MeasuredRun> run_measured(const std::vector<std::string>& command, double limit,
                                 const std::filesystem::path& log);

/// The numbers in the order above, a line each.
Status write_run(const std::filesystem::path& file, const MeasuredRun& run);
Result<MeasuredRun> read_run(const std::filesystem::path& file);

}  // namespace ft::bench
