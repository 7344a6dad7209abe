#include "baker/run/bake_stage.h"

#include <fmt/format.h>

#include <algorithm>

#include "baker/core/file.h"
#include "baker/plan/plan_text.h"
#include "baker/plan/start_report.h"
#include "baker/run/finished_stages.h"
#include "baker/run/hybrid_files.h"
#include "baker/run/signals.h"
#include "baker/run/wind_file.h"

namespace ft::inline baker {
namespace {

void warn_of_space(const BakeFolder& folder, std::uint64_t expected, Progress& progress) {
  std::error_code error;
  const auto space = std::filesystem::space(folder.path, error);
  if (!error && space.available < expected)
    progress.note(fmt::format("the caches need about {}, and {} has only {} free", size_text(expected),
                              folder.path.string(), size_text(space.available)));
}

/// Files of an earlier bake that this one does not write: a cache that stays behind would be taken for a new one.
Status remove_left_behind(const BakeFolder& folder, const Manifest& before, const std::vector<ManifestSystem>& systems,
                          const std::vector<ManifestFile>& files) {
  const auto names = [](const std::vector<ManifestSystem>& of_systems, const std::vector<ManifestFile>& of_files) {
    std::vector<std::string> out;
    for (const ManifestSystem& s : of_systems) {
      out.push_back(s.topology);
      for (const ManifestCache& c : s.caches) out.push_back(c.file);
    }
    for (const ManifestFile& f : of_files) out.push_back(f.file);
    return out;
  };
  const std::vector<std::string> keep = names(systems, files);
  for (const std::string& file : names(before.systems, before.files)) {
    // Names come from a file on disk: only plain names inside the folder are ours to remove.
    if (file.empty() || file.find('/') != std::string::npos || file == "." || file == "..") continue;
    if (std::find(keep.begin(), keep.end(), file) != keep.end()) continue;
    std::error_code error;
    std::filesystem::remove(folder.path / file, error);
    if (error)
      return output_error("cannot remove a cache of the earlier bake: " + error.message(),
                          (folder.path / file).string());
  }
  return {};
}

}  // namespace

/// Notes, where there is no room, and what starts through something.
void StageBake::tell(const BakePlan& plan, Manifest& manifest) const {
  const auto is_new = [&](const std::string& note) {
    return std::find(manifest.notes.begin(), manifest.notes.end(), note) == manifest.notes.end();
  };
  if (plan.stage_count > 1) progress_.note(stage_line(plan));
  for (const std::string& note : plan.notes)
    if (plan.stage == 0 || is_new(note)) progress_.note(note), manifest.notes.push_back(note);
  for (const std::string& line : room_lines(room_.back(), k_room_lines)) progress_.note(line);
  for (std::string& line : start_lines(find_start(plan))) {
    progress_.note(line);
    if (plan.shot().preroll == 0) manifest.notes.push_back(std::move(line));
  }
}

Result<Solvers> StageBake::make_solvers(const BakePlan& plan) const {
  Solvers out;
  for (const auto& group : plan.groups) {
    auto solver = services_.make_solver(*group);
    if (!solver) return solver.error();
    out.push_back(std::move(*solver));
  }
  return out;
}

/// Beside the caches.
Status StageBake::write_files(const BakePlan& plan, Manifest& manifest) const {
  if (plan.stage == 0) {
    auto files = write_hybrid_files(plan, folder_.path, manifest.notes);
    if (!files) return files.error();
    manifest.files = std::move(*files);
    if (!plan.wind->is_still()) {
      const std::string text = wind_samples(plan);
      if (const Status s = write_text_durably(folder_.path / k_wind_file, text); !s) return s;
      manifest.files.push_back({k_wind_file, text.size(), hash_bytes(std::as_bytes(std::span(text))).hex()});
    }
  }
  for (const auto& group : plan.groups) {
    auto beside = group->files(plan, manifest.notes);
    if (!beside) return beside.error();
    for (const WrittenFile& file : *beside) {
      if (const Status s = write_file_durably(folder_.path / file.name, file.bytes); !s) return s;
      manifest.files.push_back({file.name, file.bytes.size(), hash_bytes(file.bytes).hex()});
    }
  }
  return {};
}

Result<WalkResult> StageBake::bake(BakePlan& plan, Manifest manifest) {
  room_.push_back(find_room(plan));
  if (from_ && from_->stage > plan.stage) {
    auto finished = read_finished_stages(folder_);
    if (!finished) return finished.error();
    return WalkResult{std::move(finished->manifest), {}, 0};
  }
  tell(plan, manifest);
  auto solvers = make_solvers(plan);
  if (!solvers) return solvers.error();
  if (signal_received() != 0) return Error{ErrorKind::k_interrupted, "interrupted before the first frame", {}, {}};
  CacheSet caches(plan, *solvers, folder_.path, manifest.systems);
  if (const Status written = write_files(plan, manifest); !written) return written.error();
  for (const auto& group : plan.groups)
    for (SystemOutput& output : group->outputs) output.mesh.reset();  // the caches have them, and forget them in turn
  warn_of_space(folder_, caches.expected_bytes(), progress_);
  if (!from_ && plan.stage == 0)
    if (const Status removed = remove_left_behind(folder_, before_, caches.systems(), manifest.files); !removed)
      return removed.error();
  std::optional<Checkpoint> from = std::exchange(from_, std::nullopt);
  return walk(plan, *solvers, caches, folder_, std::move(manifest), std::move(from), merged(room_), progress_);
}

Result<BakePlan> StageBake::plan_next(const BakePlan& plan, std::span<const Carrier> carriers) const {
  std::vector<PrimaryPlan> bodies;
  for (const Carrier& carrier : carriers) {
    auto body = moving_carrier(carrier, plan, folder_);
    if (!body) return body.error();
    bodies.push_back(std::move(*body));
  }
  return plan_next_stage(plan, std::move(bodies));
}

}  // namespace ft::inline baker
