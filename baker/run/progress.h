// How a bake tells where it is: to a person, to a log, to a render farm. One event stream; each mode is one small class
// in progress.cpp and one line in its list.
//   bar       one line that redraws itself: frame, time left, health
//   plain     one line per frame
//   json      one JSON object per event and line
//   tractor   Pixar Tractor: "TR_PROGRESS 042%"
//   deadline  Thinkbox Deadline (command line and custom plug-ins): "Progress: 42%"
//   openjd    Open Job Description: "openjd_progress: 42.0", "openjd_status: ...", "openjd_fail: ..."
//   none      nothing
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "baker/core/result.h"
#include "solvers/base/solver.h"

namespace ft::inline baker {

struct ProgressStart {
  std::string shot, folder;
  int first_frame = 0, last_frame = 0, preroll = 0;  ///< preroll: frames before the first, not written
  int from_frame = 0;  ///< first frame that is computed now; later than the start on resume
  int vertex_count = 0;
  int threads = 1;
  int instance_count = 0;
};

struct ProgressFrame {
  FrameReport report;
  int done = 0, total = 0;  ///< frames, pre-roll included; done counts this one and those before a resume
  bool preroll = false;
  double seconds = 0;       ///< wall, this frame
  double seconds_left = 0;  ///< estimate
};

struct ProgressEnd {
  int exit_code = 0;
  std::string text;                  ///< one sentence
  std::vector<std::string> details;  ///< lines of a table
  double seconds = 0;                ///< wall, whole bake
};

class Progress {
 public:
  virtual ~Progress() = default;
  virtual void begin(const ProgressStart&) {}
  virtual void note(const std::string&) {}
  virtual void frame(const ProgressFrame&) {}
  virtual void end(const ProgressEnd&) {}
};

std::vector<std::string_view> progress_modes();
/// mode "": bar where `out` is a terminal, plain otherwise. An unknown mode is a usage error.
Result<std::unique_ptr<Progress>> make_progress(std::string_view mode, std::FILE* out);
/// One JSON object per event; times of day included. The file is made anew.
Result<std::unique_ptr<Progress>> make_json_log(const std::filesystem::path& file);
/// Hands every event to each.
std::unique_ptr<Progress> combine(std::vector<std::unique_ptr<Progress>> all);

/// "ok", or what is wrong with the frame in a few words.
std::string health(const FrameReport& report);
/// "4.2 s", "35 s", "1:05", "2:03:04".
std::string clock_text(double seconds);

}  // namespace ft::inline baker
