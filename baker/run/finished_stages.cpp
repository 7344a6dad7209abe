#include "baker/run/finished_stages.h"

#include "baker/core/file.h"
#include "baker/record/report_json.h"
#include "baker/run/checkpoint.h"

namespace ft::inline baker {

Status finish_stage(const BakeFolder& folder, const FinishedStages& stages) {
  Manifest without_frames = stages.manifest;
  without_frames.frames.clear();
  const Checkpoint out{stages.fingerprint,     stages.last, stages.manifest.last_frame, {}, stages.manifest.frames,
                       to_text(without_frames)};
  if (const Status s = write_file_durably(folder.stages(), parts_of(out).parts()); !s) return s;
  return write_text_durably(folder.manifest(), to_text(stages.manifest));
}

Result<FinishedStages> read_finished_stages(const BakeFolder& folder) {
  auto bytes = read_file(folder.stages());
  if (!bytes) return bytes.error();
  auto stored = load_checkpoint(*bytes);
  if (!stored) return stored.error();
  auto manifest = manifest_from_text(stored->manifest, folder.stages().string());
  if (!manifest) return manifest.error();
  manifest->frames = std::move(stored->reports);
  return FinishedStages{stored->fingerprint, stored->stage, std::move(*manifest)};
}

void forget_stages(const BakeFolder& folder, const Manifest& manifest) {
  std::error_code ignored;
  std::filesystem::remove(folder.stages(), ignored);
  for (const ManifestSystem& system : manifest.systems) {
    std::filesystem::remove(folder.motion(system.name), ignored);
    std::filesystem::remove(folder.flow(system.name), ignored);
  }
}

std::vector<FrameReport> merged(std::span<const FrameReport> earlier, std::span<const FrameReport> later) {
  std::vector<FrameReport> out(earlier.begin(), earlier.end());
  for (std::size_t k = 0; k < later.size(); ++k) {  // both begin with the first frame of the pre-roll
    if (k >= out.size())
      out.push_back(later[k]);
    else
      out[k] = merge(out[k], later[k]);
  }
  return out;
}

}  // namespace ft::inline baker
