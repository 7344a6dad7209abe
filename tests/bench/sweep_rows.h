// What became of one bake of a sweep, as a row, and the sum of all rows. For sweep_tool.cpp. A row is made of the bake
// folder's manifest.json and report.json and of what was measured; frames are those of the shot, but for the times.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "baker/core/result.h"
#include "tests/bench/sweep_run.h"

namespace ft::bench {

struct SweepRow {
  std::string name;
  int frame_count = 0;  ///< that were baked
  int exit_code = 0;    ///< 124: it took longer than it may
  bool complete = false;
  int crossings_body = 0;  ///< with the feasible collider, sum over the frames
  int crossings_self = 0;  ///< among cloth
  int crossing_frames = 0;
  int crossings_last = 0;        ///< in the last frame
  int late_frames = 0;           ///< with crossings, though for k_room_frames there has been room everywhere
  double strain_p99 = 0;         ///< the worst frame's, 1
  double absent_share = 0;       ///< of the frames: something was absent
  double cpu_seconds = 0;        ///< a frame, the pre-roll's counted, import and caches included
  double worst_frame_ratio = 0;  ///< slowest frame, of the pre-roll too, over the shot's median one [CPU]
  int worst_frame = 0;           ///< with most crossings; without any, most strained
  std::string garments;          ///< "skirt+top"

  int crossings() const { return crossings_body + crossings_self; }
};

/// Frames in which cloth has to come out once there is room again.
inline constexpr int k_room_frames = 12;

/// A bake that left no manifest gives a row without frames.
Result<SweepRow> row_of_bake(const std::filesystem::path& folder, const MeasuredRun& run);

std::string row_header();
std::string to_line(const SweepRow& row);
Result<SweepRow> row_from_line(const std::string& line);

/// Worst first: what is not complete, then by crossings, then by strain.
std::vector<SweepRow> worst_first(std::vector<SweepRow> rows);

/// For people: a line a bake, the sum below it, and RESULT as the last line.
std::string table_of(const std::vector<SweepRow>& rows);

}  // namespace ft::bench
