#include "baker/run/walk.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "baker/core/file.h"
#include "baker/core/parallel.h"
#include "baker/record/report_json.h"
#include "baker/run/finished_stages.h"
#include "baker/run/interaction.h"
#include "baker/run/pace.h"
#include "baker/run/signals.h"
#include "baker/run/writer_thread.h"
#include "baker/systems/interface/absent_runs.h"

namespace ft::inline baker {
namespace {

// A checkpoint is made after every frame, unless the state is so large that this would write more than this per frame
// [bytes].
constexpr std::uint64_t k_checkpoint_bytes_per_frame = 8 << 20;
constexpr int k_most_frames_between_checkpoints = 10;

using Clock = std::chrono::steady_clock;
double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

int checkpoint_interval(std::span<const State> states) {
  std::uint64_t bytes = 0;
  for (const State& state : states)
    for (const StateBlock& block : state.blocks) bytes += sizeof(double) * block.values.read().size();
  return std::clamp(static_cast<int>(bytes / k_checkpoint_bytes_per_frame) + 1, 1, k_most_frames_between_checkpoints);
}

bool finite(const Snapshot& snapshot) {
  return std::all_of(snapshot.systems.begin(), snapshot.systems.end(),
                     [](const FrameData& frame) { return all_finite(frame); });
}

class Walk {
 public:
  Walk(const BakePlan& plan, const Solvers& solvers, CacheSet& caches, const BakeFolder& folder, Manifest manifest,
       const RoomReport& room, Progress& progress)
      : plan_(plan),
        solvers_(solvers),
        caches_(caches),
        folder_(folder),
        manifest_(std::move(manifest)),
        earlier_(std::move(manifest_.frames)),
        room_(room),
        progress_(progress) {
    manifest_.frames.clear();
  }

  WalkResult run(std::optional<Checkpoint> from) {
    Status status = start(std::move(from));
    if (status) status = frames();
    // What was computed is kept, whatever happened; the first fault is the one that counts.
    if (const Status written = write_held(nullptr); status && !written) status = written;
    if (const Status written = writer_.finish(); status && !written) status = written;
    manifest_.systems = caches_.systems();
    if (status)
      status = complete();
    else if (status.error().kind != ErrorKind::k_output) {
      if (const Status written = write_manifest(); !written) status = written;
      if (status.error().kind == ErrorKind::k_interrupted)
        if (const Status written = write_report(); !written) status = written;
    }
    return {with_earlier_stages(), status, since(clock_)};
  }

 private:
  Status start(std::optional<Checkpoint> from);
  Status settle();
  Status frames();
  Status complete();
  Status write_report() const;
  /// The manifest with the frames of all stages so far.
  Manifest with_earlier_stages() const;
  Status write_manifest() const { return write_text_durably(folder_.manifest(), to_text(with_earlier_stages())); }
  FrameReport advance();
  /// Solvers number the vertices that they simulate, messages those of the garment's file.
  void number_as_in_file(std::size_t group, std::span<Incident> incidents) const;
  using SharedSnapshot = std::shared_ptr<const Snapshot>;
  SharedSnapshot take() const { return std::make_shared<const Snapshot>(caches_.take(states_)); }
  /// The snapshot of the states as they are: writes the one that is held, and holds this one.
  Status emit(SharedSnapshot snapshot, bool checkpoint);
  /// The held one, whose velocities need its neighbours; after: null at the end.
  Status write_held(const SharedSnapshot& after);
  Status save_checkpoint();  ///< of the states as they are
  static Status interrupted(std::string what);
  int begin() const { return plan_.shot().first_frame - plan_.shot().preroll; }

  const BakePlan& plan_;
  const Solvers& solvers_;
  CacheSet& caches_;
  const BakeFolder& folder_;
  Manifest manifest_;                       ///< its frames are those of this stage
  const std::vector<FrameReport> earlier_;  ///< frames of the stages before it
  const RoomReport& room_;
  Progress& progress_;
  const Clock::time_point clock_ = Clock::now();
  std::vector<State> states_;
  SharedSnapshot held_, before_;  ///< of the states as they are, not written yet; of the frame before it
  WriterThread writer_;
};

Status Walk::start(std::optional<Checkpoint> from) {
  if (from) {
    states_ = std::move(from->states);
    manifest_.frames = std::move(from->reports);
    CHECK(states_.size() == solvers_.size());
    if (manifest_.frames.empty()) return caches_.open(begin() - 1);
    const int frame = states_[0].frame;
    if (frame > begin()) before_ = caches_.from_numbers(frame - 1, from->before);
    if (frame > begin() && !before_)
      return input_error("is not of these systems", folder_.checkpoint().string(), "bake without --resume");
    if (const Status opened = caches_.open(frame - 1); !opened) return opened;
    held_ = take();
    return {};
  }
  // The old checkpoint goes first: it must never stand beside caches that are not its own. Of the stage before it may
  // stay, whose caches are closed.
  std::error_code error;
  if (plan_.stage == 0) std::filesystem::remove(folder_.checkpoint(), error);
  if (error) return output_error("cannot remove the old checkpoint: " + error.message(), folder_.checkpoint().string());
  for (const auto& solver : solvers_) states_.push_back(solver->initial_state());
  for (const State& state : states_) CHECK(state.frame == begin());
  manifest_.systems = caches_.systems();
  if (const Status written = write_manifest(); !written) return written;
  return caches_.open(begin() - 1);
}

void Walk::number_as_in_file(std::size_t group, std::span<Incident> incidents) const {
  const auto& outputs = plan_.groups[group]->outputs;
  for (Incident& incident : incidents)
    for (int s = 0; s < solvers_[group]->system_count() && incident.vertex >= 0; ++s)
      if (solvers_[group]->system_name(s) == incident.system) {
        incident.vertex = outputs[at(s)].in_file.vertex(incident.vertex);
        break;
      }
}

FrameReport Walk::advance() {
  FrameReport report;
  for (std::size_t g = 0; g < solvers_.size(); ++g) {
    const int expected = states_[g].frame + 1;
    FrameReport one = solvers_[g]->advance_frame(states_[g]);
    CHECK(states_[g].frame == expected && one.frame == expected);
    number_as_in_file(g, one.incidents);
    one.absent = caches_.as_cached(g, absent_of(*solvers_[g], states_[g]));
    report = g == 0 ? std::move(one) : merge(report, one);
  }
  return report;
}

Status Walk::write_held(const SharedSnapshot& after) {
  if (!held_) return {};
  const Status taken = writer_.submit(
      [this, held = held_, before = before_, after] { return caches_.write(*held, before.get(), after.get()); });
  before_ = std::exchange(held_, nullptr);
  return taken;
}

Status Walk::emit(SharedSnapshot snapshot, bool checkpoint) {
  if (!finite(*snapshot))
    return Error{ErrorKind::k_diverged,
                 "the solver returned positions that are not finite; nothing of this frame was written",
                 fmt::format("frame {}", snapshot->frame), "try more substeps ([solver] max_substeps)"};
  if (const Status taken = write_held(snapshot); !taken) return taken;
  held_ = std::move(snapshot);
  if (!checkpoint) return {};
  return save_checkpoint();
}

Status Walk::save_checkpoint() {
  Checkpoint now{plan_.inputs.fingerprint, plan_.stage, states_[0].frame, states_, manifest_.frames, {}};
  if (before_) now.before = caches_.to_numbers(*before_);
  return writer_.submit(
      [this, now = std::move(now)] { return write_file_durably(folder_.checkpoint(), parts_of(now).parts()); });
}

/// Garments that start through cloth are taken apart while the primary stands still at the start of the pre-roll.
Status Walk::settle() {
  const auto goes_on = [&](std::size_t g) { return solvers_[g]->settling(states_[g]).goes_on; };
  const Shot& shot = plan_.shot();
  const int total = shot.last_frame - states_[0].frame;
  Pace pace;
  while (manifest_.frames.empty()) {
    FrameReport report;
    bool any = false;
    const auto clock = Clock::now();
    if (signal_received() != 0) return interrupted("interrupted before the pre-roll");
    for (std::size_t g = 0; g < solvers_.size(); ++g) {
      if (!goes_on(g)) continue;
      FrameReport one = solvers_[g]->settle_frame(states_[g]);
      report = any ? merge(report, one) : std::move(one);
      any = true;
    }
    if (!any) break;
    pace.add(since(clock));
    progress_.frame({report, plan_.stage * total, plan_.stage_count * total, true, since(clock), pace.mean() * total});
    if (const Status saved = save_checkpoint(); !saved) return saved;
  }
  for (std::size_t g = 0; g < solvers_.size(); ++g) {
    const Settling settled = solvers_[g]->settling(states_[g]);
    if (settled.frames == 0) continue;
    std::string note = fmt::format(
        "cloth on \"{}\" started through cloth: before the pre-roll it had {} frames to get out of it, the body "
        "standing still; ",
        plan_.primaries[plan_.groups[g]->primary].name, settled.frames);
    note += settled.crossings == 0 ? std::string("no crossings are left")
                                   : fmt::format("{} crossings are left, which the frames name", settled.crossings);
    progress_.note(note);
    manifest_.notes.push_back(std::move(note));
  }
  return {};
}

Status Walk::interrupted(std::string what) {
  return Error{ErrorKind::k_interrupted, std::move(what), {}, "run again with --resume to go on"};
}

Status Walk::frames() {
  const Shot& shot = plan_.shot();
  const int total = shot.last_frame - begin();
  int vertices = 0, instances = 0;
  for (const auto& solver : solvers_)
    for (int s = 0; s < solver->system_count(); ++s)
      if (const SystemShape* shape = solver->system_shape(s)) {
        instances += static_cast<int>(shape->instances.ids.size());
        vertices += static_cast<int>(shape->curves.rest.size());
      } else
        vertices += solver->system_mesh(s).vertex_count();
  progress_.begin({shot.file.filename().string(), folder_.path.string(), shot.first_frame, shot.last_frame,
                   shot.preroll, states_[0].frame + 1, vertices, thread_count(), instances});
  if (const Status settled = settle(); !settled) return settled;
  Pace pace;
  if (manifest_.frames.empty()) {
    manifest_.frames.push_back(certify_start(plan_, solvers_, caches_, states_));
    if (const Status emitted = emit(take(), true); !emitted) return emitted;
  }
  const int interval = checkpoint_interval(states_);
  int newest_checkpoint = states_[0].frame;
  while (states_[0].frame < shot.last_frame) {
    if (signal_received() != 0) {
      if (newest_checkpoint != states_[0].frame) {
        if (const Status saved = save_checkpoint(); !saved) return saved;
      }
      return interrupted(fmt::format("interrupted after frame {}", states_[0].frame));
    }
    const auto clock = Clock::now();
    FrameReport report = advance();
    if (report.profile.total <= 0) report.profile.total = since(clock);
    manifest_.frames.push_back(report);
    const bool checkpoint = report.frame - newest_checkpoint >= interval || report.frame == shot.last_frame;
    if (checkpoint) newest_checkpoint = report.frame;
    if (const Status emitted = emit(take(), checkpoint); !emitted) return emitted;
    pace.add(since(clock));
    progress_.frame({report, plan_.stage * total + report.frame - begin(), plan_.stage_count * total,
                     report.frame < shot.first_frame, since(clock), pace.mean() * (shot.last_frame - report.frame)});
  }
  return {};
}

Status Walk::complete() {
  if (const Status closed = caches_.close(); !closed) return closed;
  manifest_.systems = caches_.systems();
  if (!plan_.is_last_stage()) {
    const Manifest whole = with_earlier_stages();
    return finish_stage(folder_, {plan_.inputs.fingerprint, plan_.stage, whole});
  }
  if (const Status written = write_report(); !written) return written;
  for (std::string& note : untouched_lines(interactions(with_earlier_stages(), plan_.primaries)))
    manifest_.notes.push_back(std::move(note));
  manifest_.complete = true;
  if (const Status written = write_manifest(); !written) return written;
  std::error_code ignored;  // a checkpoint of a complete bake does no harm
  std::filesystem::remove(folder_.checkpoint(), ignored);
  forget_stages(folder_, manifest_);
  return {};
}

Manifest Walk::with_earlier_stages() const {
  Manifest out = manifest_;
  out.frames = merged(earlier_, manifest_.frames);
  return out;
}

Status Walk::write_report() const {
  FrameProfile sum;
  std::vector<double> totals;
  Json frames = Json::array();
  const Manifest whole = with_earlier_stages();
  for (const FrameReport& frame : whole.frames) {
    frames.push_back(
        {{"frame", frame.frame}, {"milliseconds", 1e3 * frame.profile.total}, {"profile", to_json(frame.profile)}});
    if (frame.substeps > 0) totals.push_back(frame.profile.total);
    sum += frame.profile;
  }
  std::sort(totals.begin(), totals.end());
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  Json out = Json::object();
  out["threads"] = thread_count();
  out["wall_seconds"] = since(clock_);
  out["import_seconds"] = plan_.import_seconds;
  out["median_frame_seconds"] = totals.empty() ? 0.0 : totals[totals.size() / 2];
  out["peak_memory_bytes"] = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
  out["profile"] = to_json(sum);
  out["room"] = to_json(room_);
  out["interaction"] = to_json(interactions(whole, plan_.primaries), plan_.primaries);
  out["frames"] = std::move(frames);
  return write_text_durably(folder_.report(), to_text(out));
}

}  // namespace

FrameReport certify_start(const BakePlan& plan, const Solvers& solvers, const CacheSet& caches,
                          std::span<const State> states) {
  FrameReport report;
  report.frame = states[0].frame;
  report.smallest_gap = std::numeric_limits<double>::infinity();  // not measured
  for (std::size_t g = 0; g < solvers.size(); ++g) {
    plan.groups[g]->add_certificate(plan, *solvers[g], states[g], report);
    for (AbsentRuns& runs : caches.as_cached(g, absent_of(*solvers[g], states[g]))) {
      report.absent_vertices = std::max(report.absent_vertices, vertex_count(runs));
      report.absent.push_back(std::move(runs));
    }
  }
  return report;
}

WalkResult walk(const BakePlan& plan, const Solvers& solvers, CacheSet& caches, const BakeFolder& folder,
                Manifest manifest, std::optional<Checkpoint> from, const RoomReport& room, Progress& progress) {
  return Walk(plan, solvers, caches, folder, std::move(manifest), room, progress).run(std::move(from));
}

}  // namespace ft::inline baker
