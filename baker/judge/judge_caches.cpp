#include "baker/judge/judge_caches.h"

#include <algorithm>
#include <limits>
#include <map>

#include "baker/record/cache_track.h"
#include "baker/record/report_json.h"
#include "baker/systems/interface/system.h"

namespace ft::inline baker {

Result<CacheJudgement> judge_caches(const std::filesystem::path& bake_folder) {
  auto manifest = read_manifest(bake_folder);
  if (!manifest) return manifest.error();
  CacheJudgement out;
  out.shot = manifest->shot;
  out.complete = manifest->complete;
  const CachedBake bake{bake_folder, *manifest};
  int frames = manifest->systems.empty() ? 0 : manifest->written_count();
  std::vector<CacheTrack> shaped;  // what is no mesh
  for (const ManifestSystem& system : manifest->systems) {
    if (!manifest->complete && !bake.has_cache(system)) {
      frames = 0;
      continue;
    }
    auto track = bake.open(system);
    if (!track) return track.error();
    frames = std::min(frames, track->reader->info().frame_count);
    if (track->shape() != OutputShape::k_mesh) shaped.push_back(std::move(*track));
  }
  std::vector<std::unique_ptr<JudgedGroup>> groups;
  for (const SystemKind* kind : system_kinds()) {
    auto judged = kind->judge(bake);
    if (!judged) return judged.error();
    for (auto& group : *judged) groups.push_back(std::move(group));
  }
  for (const auto& group : groups)
    for (std::string& note : group->notes())
      if (std::find(out.notes.begin(), out.notes.end(), note) == out.notes.end()) out.notes.push_back(std::move(note));
  out.frame_count = manifest->written_count();
  out.missing_frames = out.frame_count - frames;
  std::map<int, std::span<const AbsentRuns>> absent;
  for (const FrameReport& frame : manifest->frames) absent[frame.frame] = frame.absent;
  for (int i = 0; i < frames; ++i) {
    const int frame = manifest->first_written + i;
    for (FrameData data; const CacheTrack& track : shaped)
      if (const Status sound = track.read(i, data); !sound) return sound.error();
    std::optional<FrameReport> all;
    for (const auto& group : groups) {
      const auto report = group->judge(i, frame, absent[frame]);
      if (!report) return report.error();
      all = all ? merge(*all, *report) : *report;
    }
    if (!all) {  // nothing there can be judged
      all.emplace().frame = frame;
      all->smallest_gap = std::numeric_limits<double>::infinity();
    }
    out.frames.push_back(std::move(*all));
  }
  return out;
}

}  // namespace ft::inline baker
