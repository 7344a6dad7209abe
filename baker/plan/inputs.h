// What a bake depends on, found out without importing anything: the shot file with its overrides, the bytes of every
// file that it names, and the program. Two bakes with the same fingerprint write the same bytes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "baker/core/hash.h"
#include "baker/core/result.h"
#include "io/shot/ranges.h"
#include "io/shot/shot.h"

namespace ft::inline baker {

struct InputRecord {
  std::string role;  ///< "primary.mannequin.file"
  std::filesystem::path path;
  Hash128 content;  ///< of the bytes, buffers that a glTF keeps beside itself included
};

struct BakeInputs {
  Shot shot;
  std::vector<InputRecord> files;  ///< in the order of the shot file
  std::vector<std::pair<std::string, std::string>>
      settings;  ///< "cloth.dress.fabric" -> "\"cotton\""; neither paths nor gates
  Hash128 fingerprint;
};

/// What the registries of the floors below know, for read_shot().
ShotVocabulary shot_vocabulary();

/// frames: a part of the shot, else k_usage; the clip then starts that much later, so that a frame has the same pose in
/// any range. faults: every fault of the shot file, for printing.
Result<BakeInputs> read_inputs(const std::filesystem::path& shot_file, const std::vector<std::string>& overrides,
                               std::optional<FrameRange> frames, ShotFaults& faults);

/// From shot and files; called by read_inputs().
Hash128 fingerprint(const BakeInputs& inputs);

}  // namespace ft::inline baker
