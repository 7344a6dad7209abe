// The walk of a frame:
//   1. the collider at both ends; where the primary is cut to another place, cloth and collider at t0 go there first
//   2. substeps (substep_count.cpp); in each: collider and pins at its end, then BodyAdvance (carry, CCD, Newton,
//      truncation); once more with four times as many where a garment hangs on buttons and loses momentum
//   3. certificate.cpp: exact crossings. Any that a tangle does not explain: back to the frame's start with twice
//      the substeps, at most three times and as long as it helps
//   4. what of the collider is clear of the cloth comes back (absence.h); the report
#include "solvers/cloth/cloth_solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>

#include "baker/core/give_back.h"
#include "solvers/cloth/advance/body_advance.h"
#include "solvers/cloth/advance/body_ahead.h"
#include "solvers/cloth/advance/substep_count.h"
#include "solvers/cloth/advance/tangles.h"
#include "solvers/cloth/advance/work_limit.h"
#include "solvers/cloth/certify/certificate.h"
#include "solvers/cloth/certify/frame_incidents.h"
#include "solvers/cloth/embed/coarse_solver.h"
#include "solvers/cloth/embed/riding_solver.h"
#include "solvers/cloth/model/cloth_model.h"
#include "solvers/cloth/model/first_state.h"
#include "solvers/cloth/model/pins.h"
#include "solvers/cloth/model/settling.h"
#include "solvers/cloth/model/sewing.h"
#include "solvers/cloth/model/torn_body.h"
#include "solvers/cloth/solve/forces_on_bodies.h"

namespace ft::inline solvers {
namespace {

constexpr int k_rewinds = 3;
/// Where a shot asks for fewer substeps at most, so many count for what a frame may cost.
constexpr int k_least_counted = 32;
/// Where more than this share of the body is torn, nothing in the frame is worth solving for: the cloth is taken along
/// as it is [1].
constexpr double k_wreck = 0.4;
constexpr double k_fastest_wreck = 10;  ///< the speed that it has then, at most [m/s]
/// A frame in which Newton's method leaves a garment that is buttoned or zipped to others with more force than this
/// share of its weight, on average, is walked anew with so many times the substeps: cords are stiff and pull one way
/// only, and what the iterations leave is lost to a garment that swings on them. It fell half as far as it should.
constexpr double k_most_lost = 0.1;
constexpr int k_times_lost = 4;
double elapsed(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

class ClothSolver final : public Solver {
 public:
  explicit ClothSolver(std::unique_ptr<ClothModel> model)
      : model_(std::move(model)), advance_(*model_), certificate_(*model_), body_(model_->collider.get()) {
    mark_tangled(*model_, own_crossings(*model_, crossings_within(model_->start, model_->triangles)),
                 tangled_at_start_);
    if (!any_tangled(tangled_at_start_)) give_back(tangled_at_start_);
    if (model_->collider) {
      std::vector<Vec3> bind(at(model_->collider->vertex_count()));
      model_->collider->refined_bind(bind);
      torn_body_ = TornBody(bind, model_->collider->triangles(), model_->collider->part_of_vertex());
    }
    if (std::ranges::equal(model_->start, model_->contact.rest)) give_back(model_->start);
  }

  int system_count() const override { return static_cast<int>(model_->setup.garments.size()); }
  const Mesh& system_mesh(int system) const override { return model_->setup.garments[at(system)].mesh; }

  void system_positions(const State& state, int system, std::span<Vec3> out) const override {
    const auto* x = state.find("x");
    CHECK(x);
    const auto all = as_points(*x);
    const auto first = at(model_->first_vertex[at(system)]), end = at(model_->first_vertex[at(system) + 1]);
    CHECK(out.size() == end - first && end <= all.size());
    std::copy(all.begin() + static_cast<std::ptrdiff_t>(first), all.begin() + static_cast<std::ptrdiff_t>(end),
              out.begin());
  }

  std::span<const Triangle> collider_triangles() const override {
    return model_->collider ? model_->collider->triangles() : std::span<const Triangle>{};
  }
  void collider_positions(const State& state, std::vector<Vec3>& out) const override {
    out.clear();
    if (!model_->collider) return;
    const std::lock_guard lock(one_at_a_time_);
    if (const BodyPose* known = body_.known(state.time)) {
      out = known->feasible;
      return;
    }
    std::vector<Vec3> drawn;
    model_->collider->drawn(state.time, drawn);
    model_->collider->feasible(state.time, drawn, out);
  }

  std::vector<char> collider_absent(const State& state, int system) const override {
    if (!model_->collider) return {};
    const std::vector<char> all = absent_of(state);
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(model_->absence.place(system, 0));
    return {first, first + static_cast<std::ptrdiff_t>(model_->absence.body_count())};
  }

  State initial_state() const override { return first_state(*model_, tangled_at_start_); }
  FrameReport advance_frame(State& state) override;
  Settling settling(const State& state) const override { return settling_of(model_->setup, state); }
  FrameReport settle_frame(State& state) override;

 private:
  struct Frame;
  FrameReport advance(Frame frame, State& state);
  double walk(const Frame& frame, int substeps, ClothMotion& motion, FrameReport& report);
  void take_along(const Frame& frame, ClothMotion& motion, FrameReport& report) const;
  void find_torn(const Teleport* teleport, Frame& frame) const;

  std::unique_ptr<ClothModel> model_;
  TornBody torn_body_;
  std::vector<char> tangled_at_start_;  ///< as ClothMotion has it; empty: nothing is
  // Scratch only: forgotten between frames, one frame at a time.
  BodyAdvance advance_;
  Certificate certificate_;
  BodyAhead body_;
  mutable std::mutex one_at_a_time_;
};

struct ClothSolver::Frame {
  int number = 0;  ///< of its end
  double t0 = 0, t1 = 0;
  std::vector<char> torn;  ///< as TornBody::find()

  bool wrecked() const {
    return static_cast<double>(std::count(torn.begin(), torn.end(), char{1})) >
           k_wreck * static_cast<double>(torn.size());
  }
  /// What is too deep in the body, or torn.
  std::vector<char> not_met(std::span<const char> deep) const {
    std::vector<char> out(deep.begin(), deep.end());
    for (std::size_t b = 0; b < torn.size(); ++b) out[b] = static_cast<char>(out[b] | torn[b]);
    return out;
  }
};

/// Returns the mean of StepResult::lost_weight.
double ClothSolver::walk(const Frame& frame, int substeps, ClothMotion& m, FrameReport& report) {
  if (frame.wrecked()) return take_along(frame, m, report), 0.0;
  const double h = (frame.t1 - frame.t0) / substeps;
  double lost = 0;
  WorkLimit limit(std::max({substeps, model_->setup.max_substeps, k_least_counted}), !frame.torn.empty());
  bool hurried = false, slowed = false;
  int releases = 0;
  std::vector<Vec3> body = body_.start().feasible, pins(model_->pins.size()), pins_next(pins.size()), push;
  pin_targets(*model_, body_.start().drawn, pins);
  std::vector<char> deep = frame.not_met(body_.start().absent), deep_next;
  for (int k = 0; k < substeps; ++k) {
    const double t0 = frame.t0 + k * h;
    const auto clock = std::chrono::steady_clock::now();
    const BodyPose& next = body_.after(k, substeps);
    pin_targets(*model_, next.drawn, pins_next);
    report.profile.body += elapsed(clock);
    SubstepInput in;
    in.body_t0 = body;
    in.body_t1 = next.feasible;
    deep_next = frame.not_met(next.absent);
    in.deep_t1 = deep_next;
    in.pins_t0 = pins;
    in.pins_t1 = pins_next;
    in.h = h;
    in.time_t0 = t0;
    in.shortest = (frame.t1 - frame.t0) / 512;
    if (!m.absent.empty()) model_->absence.take_out(deep, deep_next, m.absent);
    if (!model_->sewn_until.empty()) {
      push.assign(m.x.size(), Vec3::Zero());
      if (ease_sewing(*model_, t0 + h, m.v, push)) in.push = push;
    }
    if (hold_jumps(*model_, t0, t0 + h)) m.h_previous = 0;
    // What is faster than the steps that there are can follow meets more with a power of its speed.
    if ((hurried || substeps >= model_->setup.max_substeps) && slow_down(*model_, h, m)) {
      m.h_previous = 0;
      slowed = true;
    }
    in.friction_share = sewing_friction(*model_, t0 + h);
    in.earlier_releases = releases;
    in.patience = limit.patience(substeps - 1 - k);
    const AdvanceReport step = advance_.substep(in, m);
    limit.spend(step.work);
    releases += step.releases;
    hurried = hurried || step.impatient;
    report.substeps += step.pieces;
    report.newton_iterations += step.newton_iterations;
    report.linear_iterations += step.linear_iterations;
    report.smallest_gap = std::min(report.smallest_gap, step.smallest_gap);
    report.finite = report.finite && step.finite;
    lost += step.lost_weight / substeps;
    add_forces(*model_, step.on_body, frame.t1 - frame.t0, report);
    report.profile.candidates += step.seconds_candidates;
    report.profile.assembly += step.seconds_assembly;
    report.profile.linear += step.seconds_linear;
    report.profile.narrow += step.seconds_contact;
    body = next.feasible;
    deep.swap(deep_next);
    pins.swap(pins_next);
  }
  if (hurried || slowed) report.incidents.push_back(haste_incident(*model_, m, hurried, report.frame));
  return lost;
}

/// The cloth goes where most of the body goes, and meets none of it.
void ClothSolver::take_along(const Frame& frame, ClothMotion& m, FrameReport& report) const {
  const double duration = frame.t1 - frame.t0;
  const Vec3 way = TornBody::common_move(body_.start().feasible, body_.end().feasible);
  const double speed = way.norm() / duration;
  const Vec3 v = (speed > k_fastest_wreck ? k_fastest_wreck / speed : 1.0) / duration * way;
  take_along_with(way, v, m);
  report.substeps = 1;
  const std::vector<OnBody> nothing(model_->setup.garments.size() * model_->body_count());
  add_forces(*model_, nothing, duration, report);
}

void ClothSolver::find_torn(const Teleport* teleport, Frame& frame) const {
  frame.torn = torn_body_.find(body_.start().feasible, body_.end().feasible, [&](int which) {
    std::vector<Vec3> x = model_->collider->refined(which < 0 ? 2 * frame.t0 - frame.t1 : 2 * frame.t1 - frame.t0);
    if (which < 0 && teleport) carry(*teleport, std::span(x));
    return x;
  });
}

FrameReport ClothSolver::advance_frame(State& state) {
  const std::lock_guard lock(one_at_a_time_);
  const ClothSetup& setup = model_->setup;
  Frame frame;
  frame.number = state.frame + 1;
  frame.t0 = (state.frame - setup.first_frame) / setup.fps;
  frame.t1 = (frame.number - setup.first_frame) / setup.fps;
  return advance(frame, state);
}

/// Before the pre-roll every pose is its first.
FrameReport ClothSolver::settle_frame(State& state) {
  const std::lock_guard lock(one_at_a_time_);
  const ClothSetup& setup = model_->setup;
  Frame frame;
  frame.number = state.frame;
  frame.t1 = (state.frame - setup.first_frame) / setup.fps;
  frame.t0 = frame.t1 - 1 / setup.fps;
  const FrameReport report = advance(frame, state);
  count_settled(report.crossings_self, state);
  return report;
}

FrameReport ClothSolver::advance(Frame frame, State& state) {
  const auto clock = std::chrono::steady_clock::now();
  const ClothSetup& setup = model_->setup;
  const auto body_clock = std::chrono::steady_clock::now();
  body_.begin(frame.t0, frame.t1);
  const bool goes_on = frame.number != state.frame;
  const Teleport* teleport = goes_on ? teleport_into(setup.teleports, frame.number) : nullptr;
  if (teleport) body_.cut(*teleport);
  if (model_->collider) find_torn(teleport, frame);
  FrameReport report, best_report;
  ClothMotion motion = take_motion(state, at(model_->vertex_count())), best;
  if (teleport) carry(*teleport, motion);
  const KeptMotion start(motion);
  const int substeps = substep_count(*model_, motion, frame.t1 - frame.t0, body_.start().feasible, body_.end().feasible,
                                     frame.not_met(body_.start().absent), frame.not_met(body_.end().absent));
  bool moved = false;
  int fewest = -1;
  FrameProfile spent;
  spent.body = elapsed(body_clock);
  for (int attempt = 0; attempt <= k_rewinds; ++attempt) {
    const auto walk_anew = [&](int count) {
      if (moved) motion = {};  // so that there are never two of them
      if (moved) motion = start.motion();
      moved = true;
      report = {};
      report.frame = frame.number;
      report.rewinds = attempt;
      report.smallest_gap = std::numeric_limits<double>::infinity();
      report.profile = spent;
      const double lost = walk(frame, count, motion, report);
      spent = report.profile;
      return lost;
    };
    if (walk_anew(substeps << attempt) > k_most_lost) walk_anew(k_times_lost * (substeps << attempt));
    if (!report.finite) motion = start.motion();  // the last finite state; the attempt counts as failed
    const auto certificate = std::chrono::steady_clock::now();
    const int avoidable = certificate_.certify(body_.end(), motion, report);
    report.profile.certificate += elapsed(certificate);
    spent = report.profile;
    const int score = report.finite ? avoidable : std::numeric_limits<int>::max();
    const bool better = fewest < 0 || score < fewest;
    if (better) {
      fewest = score;
      best_report = report;
      best = std::move(motion);
    }
    if (score == 0 || !better) break;
  }
  report = std::move(best_report);
  motion = std::move(best);
  report.profile = spent;
  finish_forces(*model_, body_.end().feasible, report);
  if (!std::isfinite(report.smallest_gap))
    report.smallest_gap = model_->contact.radius.empty() ? 0 : model_->contact.radius[0];
  const auto certificate = std::chrono::steady_clock::now();
  if (!frame.torn.empty()) {
    report.incidents.push_back(
        torn_incident(*model_, motion, {frame.torn, frame.wrecked(), body_.end().feasible, report.frame}));
    report.released_vertices += static_cast<int>(std::count(frame.torn.begin(), frame.torn.end(), char{1}));
  }
  certificate_.describe(frame.t1, body_.end().drawn, motion, report);
  report.profile.certificate += elapsed(certificate);
  store(state, motion);
  state.frame = frame.number;
  state.time = frame.t1;
  report.profile.total = elapsed(clock);
  return report;
}

}  // namespace

Result<std::unique_ptr<Solver>> make_cloth_solver(ClothSetup setup) {
  if (!setup.keep_short_edges)
    if (auto riding = make_riding_solver(setup, make_cloth_solver); !riding || *riding) return riding;
  if (setup.coarsen > 1) return make_coarse_solver(std::move(setup), make_cloth_solver);
  auto model = build_cloth_model(std::move(setup));
  if (!model) return model.error();
  return std::unique_ptr<Solver>(std::make_unique<ClothSolver>(std::move(*model)));
}

}  // namespace ft::inline solvers
