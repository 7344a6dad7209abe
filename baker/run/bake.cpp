#include "baker/run/bake.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>

#include "baker/core/file.h"
#include "baker/plan/plan_text.h"
#include "baker/plan/quality.h"
#include "baker/plan/start_report.h"
#include "baker/record/bake_folder.h"
#include "baker/run/bake_stage.h"
#include "baker/run/bake_status.h"
#include "baker/run/finished_stages.h"
#include "baker/run/interaction.h"
#include "baker/run/lock_file.h"
#include "baker/run/output_names.h"
#include "baker/run/signals.h"
#include "baker/run/walk.h"

namespace ft::inline baker {
namespace {

/// An error, or after a signal the interruption that is behind it (Ctrl-C reaches the import's child, too).
BakeResult failed(const Error& error, const ShotFaults& faults = {}) {
  BakeResult out;
  const int signal = signal_received();
  if (signal != 0 && error.kind != ErrorKind::k_interrupted) {
    out.exit_code = 128 + signal;
    out.faults.push_back("interrupted before the first frame");
    return out;
  }
  out.exit_code = error.kind == ErrorKind::k_interrupted && signal != 0 ? 128 + signal : exit_code(error.kind);
  out.faults = faults.messages.empty() ? std::vector<std::string>{error.text()} : faults.messages;
  return out;
}

/// Looks without making anything: the nearest folder that exists must be one that can be written.
Status check_writable(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::path nearest = std::filesystem::absolute(folder, error);
  while (!nearest.empty() && !std::filesystem::exists(nearest, error) && nearest != nearest.parent_path())
    nearest = nearest.parent_path();
  if (!std::filesystem::is_directory(nearest, error))
    return output_error("the output folder cannot be made: " + nearest.string() + " is not a folder", folder.string(),
                        "choose another with --out");
  if (::access(nearest.c_str(), W_OK | X_OK) != 0)
    return output_error("the output folder cannot be written", folder.string(), "choose another with --out");
  return {};
}

/// A try, on some of the frames or in preview quality, does not take the place of a finished bake of more of them or in
/// final quality, unless that is asked for.
Status keep_better_bake(const BakeOptions& options, const BakeStatus& status, const Manifest& now,
                        const BakeFolder& folder) {
  const Manifest& before = status.before;
  if (options.force || status.kind != BakeStatus::Kind::k_stale || !before.complete) return {};
  const bool within = before.first_frame <= now.first_frame && now.last_frame <= before.last_frame;
  const bool shorter = before.last_frame - before.first_frame != now.last_frame - now.first_frame;
  if (options.frames && within && shorter)
    return usage_error(fmt::format("there is a finished bake of frames {}-{}, which frames {}-{} would replace",
                                   before.first_frame, before.last_frame, now.first_frame, now.last_frame),
                       folder.path.string(),
                       "bake them into a folder of their own with --out, or replace it with --force");
  if (is_preview(now) && !is_preview(before))
    return usage_error("there is a finished bake in final quality, which a preview would replace", folder.path.string(),
                       "bake the preview into a folder of its own with --out, or replace the bake with --force");
  return {};
}

/// The checkpoint to go on from, if the user wants that and it can be.
Result<std::optional<Checkpoint>> find_checkpoint(const BakeOptions& options, const BakeFolder& folder,
                                                  const BakeInputs& inputs, const BakeStatus& status,
                                                  Progress& progress) {
  std::error_code error;
  if (!options.resume || !std::filesystem::exists(folder.checkpoint(), error)) return std::optional<Checkpoint>();
  auto bytes = read_file(folder.checkpoint());
  if (!bytes) return bytes.error();
  auto checkpoint = load_checkpoint(*bytes);
  if (!checkpoint) {
    progress.note(checkpoint.error().what + "; starting anew");
    return std::optional<Checkpoint>();
  }
  if (checkpoint->fingerprint != inputs.fingerprint) {
    std::string reasons;
    for (const std::string& reason : status.reasons) reasons += (reasons.empty() ? "" : "; ") + reason;
    return usage_error("the interrupted bake cannot be resumed: " + (reasons.empty() ? "its inputs changed" : reasons),
                       folder.path.string(), "run without --resume to start anew");
  }
  if (checkpoint->stage > 0) {
    const auto finished = read_finished_stages(folder);
    if (!finished || finished->fingerprint != inputs.fingerprint || finished->last + 1 != checkpoint->stage) {
      progress.note("what its earlier stages have come to is gone or spoilt; starting anew");
      return std::optional<Checkpoint>();
    }
  }
  return std::optional<Checkpoint>(std::move(*checkpoint));
}

std::string closing(const Manifest& manifest, const BakeFolder& folder) {
  int troubled = 0, incidents = 0;
  for (const FrameReport& frame : manifest.frames) {
    if (frame.frame < manifest.first_written) continue;
    troubled += health(frame) != "ok";
    incidents += static_cast<int>(frame.incidents.size());
  }
  std::string text = fmt::format("done: {} frames in {}", manifest.written_count(), folder.path.string());
  if (troubled > 0) text += fmt::format("; {} frames to look at, {} places in manifest.json", troubled, incidents);
  return text;
}

BakeResult run(const BakeOptions& options, const BakeServices& services, const BakeFolder& folder, BakeInputs inputs,
               const BakeStatus& status, Progress& progress) {
  if (const Status made = make_folders(folder.state()); !made) {
    Error error = made.error();
    if (error.hint.empty()) error.hint = "choose another folder with --out";
    return failed(error);
  }
  auto lock = LockFile::acquire(folder.lock());
  if (!lock) return failed(lock.error());
  auto checkpoint = find_checkpoint(options, folder, inputs, status, progress);
  if (!checkpoint) return failed(checkpoint.error());
  auto plan = make_plan(std::move(inputs), services.importer, folder.import_cache());
  if (!plan) return failed(plan.error());
  Manifest manifest = manifest_of(plan->inputs);
  plan->later.clear();
  StageBake stages{services, folder, status.before, std::move(*checkpoint), progress};
  WalkResult result{std::move(manifest), {}, 0};
  for (;;) {
    const std::vector<Carrier> carriers = plan->is_last_stage() ? std::vector<Carrier>() : carriers_of(*plan);
    auto walked = stages.bake(*plan, result.manifest);
    if (!walked && plan->stage == 0) return failed(walked.error());
    if (!walked) {
      result.status = walked.error();
      break;
    }
    walked->seconds += result.seconds;
    result = std::move(*walked);
    if (!result.status || plan->is_last_stage()) break;
    auto next = stages.plan_next(*plan, carriers);
    if (!next) {
      result.status = next.error();
      break;
    }
    plan = std::move(next);
  }
  Status baked = result.status;
  if (baked) baked = judge(result.manifest, gates_of(plan->shot()));
  BakeResult out;
  if (!baked) out = failed(baked.error());
  if (result.status && plan->shot().cache_volumes) out.volumes = folder.path;
  progress.end({out.exit_code, baked ? closing(result.manifest, folder) : baked.error().text(),
                interaction_lines(interactions(result.manifest, plan->primaries), plan->primaries), result.seconds});
  return out;
}

}  // namespace

Result<std::unique_ptr<Solver>> make_group_solver(SystemGroup& group) {
  return group.make_solver();
}

BakeResult bake(const BakeOptions& options, const BakeServices& services, Progress& progress) {
  const SignalGuard guard;
  ShotFaults faults;
  auto inputs = read_inputs(options.shot_file, options.overrides, options.frames, faults);
  if (!inputs) return failed(inputs.error(), faults);
  const BakeFolder folder = options.folder.empty() ? BakeFolder::beside(options.shot_file) : BakeFolder{options.folder};
  if (const Status apart = check_inputs_stay(*inputs, folder); !apart) return failed(apart.error());
  const Manifest now = manifest_of(*inputs);
  BakeStatus status = find_bake_status(folder, now);
  const Status kept = keep_better_bake(options, status, now, folder);
  if (options.explain) {
    BakeResult out{0, {describe(status, folder)}, {}};
    if (!kept) out.lines.push_back("this bake would be refused: " + kept.error().text());
    return out;
  }

  if (const Status writable = check_writable(folder.path); !writable) return failed(writable.error());
  if (options.dry_run) {
    std::error_code error;
    const bool cached = std::filesystem::is_directory(folder.import_cache(), error);
    auto plan =
        make_plan(std::move(*inputs), services.importer, cached ? folder.import_cache() : std::filesystem::path());
    if (!plan) return failed(plan.error());
    BakeResult out{0, plan_lines(*plan, folder.path), {}};
    for (std::string& line : room_lines(find_room(*plan), k_room_lines)) out.lines.push_back(std::move(line));
    StartReport start = find_start(*plan);
    for (const BakePlan& later : plan->later) {
      StartReport own = find_start(later);
      start.garment_count += own.garment_count;
      std::move(own.bad.begin(), own.bad.end(), std::back_inserter(start.bad));
    }
    for (std::string& line : start_lines(start)) out.lines.push_back("start: " + std::move(line));
    if (start.bad.empty() && start.garment_count > 0)
      out.lines.push_back("start: no garment crosses the body, itself or another");
    out.lines.push_back(describe(status, folder));
    if (!kept) out.lines.push_back("this bake would be refused: " + kept.error().text());
    return out;
  }
  if (status.kind == BakeStatus::Kind::k_up_to_date && !options.force) {
    BakeResult out;
    if (const Status judged = judge(status.before, gates_of(inputs->shot)); !judged) out = failed(judged.error());
    out.lines.push_back(describe(status, folder));
    if (inputs->shot.cache_volumes) out.volumes = folder.path;
    return out;
  }
  if (!kept) return failed(kept.error());
  if (status.kind == BakeStatus::Kind::k_stale) progress.note(describe(status, folder));
  if (status.kind == BakeStatus::Kind::k_unfinished && !options.resume)
    progress.note("an earlier bake was not finished; starting anew (--resume goes on with it)");
  return run(options, services, folder, std::move(*inputs), status, progress);
}

}  // namespace ft::inline baker
