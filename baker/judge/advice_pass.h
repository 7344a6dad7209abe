// The one-way pass that advice is given on: coarse, in memory, no longer than a few seconds. What does not fit is left
// out from the end of the shot.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "baker/judge/advice.h"
#include "baker/run/bake.h"

namespace ft::inline baker {

struct AdviceOptions {
  std::filesystem::path shot_file;
  std::vector<std::string> overrides;
  double seconds = 10;  ///< for everything, import included; the pass ends with the frame in which they are over
};

struct AdvicePass {
  std::vector<Evidence> pairs;             ///< every garment with its primary
  std::vector<std::string> notes;          ///< of the plan, and of what was not measured
  int frames = 0, shot_frames = 0;         ///< measured, and that could be
  double seconds = 0;                      ///< wall
  double final_seconds = 0;                ///< estimate of a final one-way bake of the shot
  std::vector<std::string> primary_lines;  ///< mass of each, and where it comes from
};

/// faults: every fault of the shot file.
Result<AdvicePass> run_advice_pass(const AdviceOptions& options, const BakeServices& services, ShotFaults& faults);

/// The evidence of one garment: forces on the primary and the primary's centre in successive frames; the rest of
/// `evidence` is left as it is. mass 0: not known, and nothing that needs it is filled in.
void gather(std::span<const Wrench> forces, std::span<const Vec3> centre, const Vec3& gravity, double mass, double fps,
            Evidence& evidence);

}  // namespace ft::inline baker
