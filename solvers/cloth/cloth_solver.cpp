// The walk of a frame:
//   1. the collider at both ends; where the primary is cut to another place, cloth and collider at t0 go there first
//   2. substeps from the body's speed near the cloth, from how fast the cloth turns and from its own speed in edges; in
//      each: collider and pins at its end, then BodyAdvance (carry, CCD, Newton, truncation); once more with four
//      times as many where a garment hangs on buttons and Newton's method does not like it
//   3. certificate.cpp: exact crossings. Any that released cloth does not explain: back to the frame's start with twice
//      the substeps, at most three times and as long as it helps
//   4. parts that no cloth touches any more hold the cloth again; the report
#include "solvers/cloth/cloth_solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>

#include "baker/core/parallel.h"
#include "baker/core/volume.h"
#include "solvers/cloth/body_advance.h"
#include "solvers/cloth/body_ahead.h"
#include "solvers/cloth/certificate.h"
#include "solvers/cloth/cloth_model.h"
#include "solvers/cloth/coarse_solver.h"
#include "solvers/cloth/sewing.h"
#include "solvers/cloth/tangles.h"
#include "solvers/cloth/untangle.h"

namespace ft {
namespace {

constexpr int k_rewinds = 3;
/// What the ends of an edge may move against each other in one substep, by its length at rest (of all edges, see
/// turning()): cloth that whips about turns and strains by as much, and Newton's method starts that far from the
/// answer.
constexpr double k_most_turn = 0.2;
/// A frame in which Newton's method leaves a garment that is buttoned or zipped to others with more force than this
/// share of its weight, on average, is walked anew with so many times the substeps: cords are stiff and pull one way
/// only, and what the iterations leave is lost to a garment that swings on them. It fell half as far as it should.
constexpr double k_most_lost = 0.1;
constexpr int k_times_lost = 4;
/// What vertices may move against the mean motion of their garment in one substep, in its typical edges (see
/// scatter()): pairs that may meet grow with a power of it, and folds of fine cloth are cheaper in more and shorter
/// steps.
constexpr double k_most_scatter = 1.25;

double elapsed(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

class ClothSolver final : public Solver {
 public:
  explicit ClothSolver(std::unique_ptr<ClothModel> model)
      : model_(std::move(model)), advance_(*model_), certificate_(*model_), body_(model_->collider.get()) {
    mark_tangled(*model_, own_crossings(*model_, crossings_within(model_->start, model_->triangles)),
                 tangled_at_start_);
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

  State initial_state() const override;
  FrameReport advance_frame(State& state) const override;

 private:
  struct Frame;
  void add_forces(const AdvanceReport& step, double duration, FrameReport& report) const;
  double walk(const Frame& frame, int substeps, ClothMotion& motion, FrameReport& report) const;
  bool hold_jumps(double time_t0, double time_t1) const;
  bool push_cloth(double time, ClothMotion& motion, std::vector<Vec3>& push) const;
  int choose_substeps(const Frame& frame, const ClothMotion& motion) const;
  double turning(const ClothMotion& motion) const;
  double scatter(const ClothMotion& motion) const;
  double substeps_of_body(const Frame& frame, const ClothMotion& motion) const;

  std::unique_ptr<ClothModel> model_;
  std::vector<double> tangled_at_start_;  ///< as ClothMotion has it
  // Scratch only: forgotten between frames, one frame at a time.
  mutable BodyAdvance advance_;
  mutable Certificate certificate_;
  mutable BodyAhead body_;
  mutable int expected_substeps_ = 1;  ///< those of the last frame; of no effect on any result
  mutable std::mutex one_at_a_time_;
};

struct ClothSolver::Frame {
  int number = 0;  ///< of its end
  double t0 = 0, t1 = 0;
};

State ClothSolver::initial_state() const {
  State state;
  const ClothSetup& setup = model_->setup;
  state.frame = setup.first_frame - setup.preroll_frames;
  state.time = -setup.preroll_frames / setup.fps;
  ClothMotion m;
  m.x = model_->start;
  m.v.assign(m.x.size(), Vec3::Zero());
  m.released.assign(m.x.size(), -1.0);
  m.tangled = tangled_at_start_;
  // A history of constant acceleration makes the integrator exact for free fall from the first step on.
  const double h = 1.0 / (setup.fps * setup.min_substeps);
  m.x_previous = m.x_older = m.x;
  m.v_previous = m.v_older = m.v;
  for (std::size_t i = 0; i < m.x.size(); ++i) {
    if (model_->unused[i]) continue;
    m.x_previous[i] += 0.5 * h * h * setup.gravity;
    m.v_previous[i] -= h * setup.gravity;
    m.x_older[i] += 2 * h * h * setup.gravity;
    m.v_older[i] -= 2 * h * setup.gravity;
  }
  for (const PinPoint& pin : model_->pins) {
    if (pin.hold.share(state.time) == 0) continue;
    m.x_previous[at(pin.vertex)] = m.x_older[at(pin.vertex)] = m.x[at(pin.vertex)];
    m.v_previous[at(pin.vertex)] = m.v_older[at(pin.vertex)] = m.v[at(pin.vertex)];
  }
  // Nor does cloth that is still to be sewn fall.
  std::vector<Vec3> eased(m.x.size(), Vec3::Zero());
  if (ease_sewing(*model_, state.time, std::vector<Vec3>(m.x.size(), Vec3::Zero()), eased))
    for (std::size_t i = 0; i < m.x.size(); ++i)
      if (eased[i] != Vec3::Zero()) m.x_previous[i] = m.x_older[i] = m.x[i], m.v_previous[i] = m.v_older[i] = m.v[i];
  m.h_previous = m.h_older = h;
  store(state, m);
  return state;
}

int ClothSolver::choose_substeps(const Frame& frame, const ClothMotion& m) const {
  const ClothSetup& setup = model_->setup;
  const double dt = frame.t1 - frame.t0;
  const double own = std::max(dt * turning(m) / k_most_turn, dt * scatter(m) / k_most_scatter);
  const double wanted = std::ceil(std::max(own, substeps_of_body(frame, m)));
  return static_cast<int>(std::clamp<double>(wanted, setup.min_substeps, setup.max_substeps));
}

/// How fast the ends of the edges move against each other, by their lengths at rest; both root mean square [1/s], so
/// that an edge counts as much as the cloth that it is in, and tiny ones hardly.
double ClothSolver::turning(const ClothMotion& m) const {
  const RestEdges& rest = model_->rest_edges;
  const Vec2 squares =
      parallel_sum(rest.edges.size(), 1024, Vec2(0, 0), [&](std::size_t begin, std::size_t end) -> Vec2 {
        Vec2 sum(0, 0);
        for (std::size_t k = begin; k < end; ++k) {
          const auto [a, b] = rest.edges[k];
          sum += Vec2((m.v[at(a)] - m.v[at(b)]).squaredNorm(), rest.lengths[k] * rest.lengths[k]);
        }
        return sum;
      });
  return squares[1] > 0 ? std::sqrt(squares[0] / squares[1]) : 0;
}

/// How fast the vertices of a garment move against its mean motion, by its typical edge; root mean square over all
/// garments [1/s]. What may meet in a step grows with it: folds of fine cloth that pass each other.
double ClothSolver::scatter(const ClothMotion& m) const {
  double sum = 0;
  for (std::size_t g = 0; g + 1 < model_->first_vertex.size(); ++g) {
    const auto first = at(model_->first_vertex[g]), count = at(model_->first_vertex[g + 1]) - first;
    const Vec3 total = parallel_sum(count, 1024, Vec3(0, 0, 0), [&](std::size_t begin, std::size_t end) -> Vec3 {
      Vec3 own(0, 0, 0);
      for (std::size_t i = first + begin; i < first + end; ++i) own += m.v[i];
      return own;
    });
    const Vec3 mean = total / static_cast<double>(std::max<std::size_t>(count, 1));
    sum += parallel_sum(count, 1024, 0.0,
                        [&](std::size_t begin, std::size_t end) {
                          double own = 0;
                          for (std::size_t i = first + begin; i < first + end; ++i)
                            own += (m.v[i] - mean).squaredNorm();
                          return own;
                        }) /
           (model_->typical_edge[g] * model_->typical_edge[g]);
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(m.v.size(), 1)));
}

/// So many that the body moves no farther against the cloth in one than the setup says.
double ClothSolver::substeps_of_body(const Frame& frame, const ClothMotion& m) const {
  const ClothSetup& setup = model_->setup;
  const std::vector<Vec3>& body_t0 = body_.start().feasible;
  const std::vector<Vec3>& body_t1 = body_.end().feasible;
  if (body_t0.empty()) return 0;
  // Speed of the body relative to the cloth's own mean motion, where cloth is near.
  const double dt = frame.t1 - frame.t0, cell = 0.06;
  Vec3 mean = Vec3::Zero();
  for (const Vec3& v : m.v) mean += v * (dt / static_cast<double>(m.v.size()));
  std::vector<std::array<int, 3>> cells;
  cells.reserve(m.x.size());
  const auto cell_of = [&](const Vec3& p) {
    return std::array<int, 3>{static_cast<int>(std::floor(p.x() / cell)), static_cast<int>(std::floor(p.y() / cell)),
                              static_cast<int>(std::floor(p.z() / cell))};
  };
  for (const Vec3& p : m.x) cells.push_back(cell_of(p));
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  const auto is_near = [&](const Vec3& from, const Vec3& way, double length) {
    // What starts before the cloth and ends behind it was near on its way.
    const int stops = 1 + static_cast<int>(std::min(length / cell, 256.0));
    for (int stop = 0; stop <= stops; ++stop) {
      const auto c = cell_of(from + (static_cast<double>(stop) / stops) * way);
      for (int k = 0; k < 27; ++k)
        if (std::binary_search(cells.begin(), cells.end(),
                               std::array<int, 3>{c[0] + k % 3 - 1, c[1] + k / 3 % 3 - 1, c[2] + k / 9 - 1}))
          return true;
    }
    return false;
  };
  double radius = 1e-3;
  for (const double r : model_->contact.radius) radius = std::max(radius, r);
  const double travel = setup.travel * radius;
  // The fastest first: the first that is near decides, and slow ones change nothing.
  std::vector<std::pair<double, std::size_t>> by_speed;
  for (std::size_t i = 0; i < body_t0.size(); ++i) {
    const double speed = (body_t1[i] - body_t0[i] - mean).norm();
    if (speed > setup.min_substeps * travel) by_speed.emplace_back(-speed, i);
  }
  std::sort(by_speed.begin(), by_speed.end());
  double fastest = 0;
  for (const auto& [negative_speed, i] : by_speed) {
    if (!is_near(body_t0[i], body_t1[i] - mean - body_t0[i], -negative_speed)) continue;
    fastest = -negative_speed;
    break;
  }
  return fastest / travel;
}

/// Adds what a substep did to the body; torques are about the origin until the frame is over.
void ClothSolver::add_forces(const AdvanceReport& step, double duration, FrameReport& report) const {
  report.forces.resize(step.on_body.size());
  for (std::size_t g = 0; g < step.on_body.size(); ++g) {
    InteractionForce& sum = report.forces[g];
    sum.system = model_->setup.garments[g].name;
    sum.mean += (1 / duration) * step.on_body[g].impulse;
    sum.peak = std::max(sum.peak, step.on_body[g].peak);
    sum.contact_share = std::min(1.0, sum.contact_share + step.on_body[g].contact_time / duration);
  }
}

/// Returns the mean of StepResult::lost_weight.
double ClothSolver::walk(const Frame& frame, int substeps, ClothMotion& m, FrameReport& report) const {
  const double h = (frame.t1 - frame.t0) / substeps;
  double lost = 0;
  std::vector<Vec3> body = body_.start().feasible, pins(model_->pins.size()), pins_next(pins.size()), push;
  pin_targets(*model_, body_.start().drawn, pins);
  for (int k = 0; k < substeps; ++k) {
    const double t0 = frame.t0 + k * h;
    const auto clock = std::chrono::steady_clock::now();
    const BodyPose& next = body_.after(k, substeps);
    pin_targets(*model_, next.drawn, pins_next);
    report.profile.body += elapsed(clock);
    SubstepInput in;
    in.body_t0 = body;
    in.body_t1 = next.feasible;
    in.pins_t0 = pins;
    in.pins_t1 = pins_next;
    in.h = h;
    in.time_t0 = t0;
    in.shortest = (frame.t1 - frame.t0) / 512;
    if (push_cloth(t0 + h, m, push)) in.push = push;
    if (hold_jumps(t0, t0 + h)) m.h_previous = 0;
    in.friction_share = sewing_friction(*model_, t0 + h);
    const AdvanceReport step = advance_.substep(in, m);
    report.substeps += step.pieces;
    report.newton_iterations += step.newton_iterations;
    report.linear_iterations += step.linear_iterations;
    report.smallest_gap = std::min(report.smallest_gap, step.smallest_gap);
    report.finite = report.finite && step.finite;
    lost += step.lost_weight / substeps;
    add_forces(step, frame.t1 - frame.t0, report);
    report.profile.candidates += step.seconds_candidates;
    report.profile.assembly += step.seconds_assembly;
    report.profile.linear += step.seconds_linear;
    report.profile.narrow += step.seconds_contact;
    body = next.feasible;
    pins.swap(pins_next);
  }
  return lost;
}

/// Something lets go or takes hold at once. The integrator is then started anew by a step of implicit Euler: the
/// history knows nothing of the new force, and cloth that is let go would stay behind free fall by half a substep for
/// good.
bool ClothSolver::hold_jumps(double time_t0, double time_t1) const {
  const auto jumps = [&](const auto& point) { return point.hold.jumps(time_t0, time_t1); };
  const auto& attachments = model_->attachments;
  return std::any_of(model_->pins.begin(), model_->pins.end(), jumps) ||
         std::any_of(attachments.begin(), attachments.end(), jumps);
}

/// What accelerates the cloth besides its forces: the way out of tangles, which are marked anew, and the ease of
/// sewing. False when nothing does.
bool ClothSolver::push_cloth(double time, ClothMotion& m, std::vector<Vec3>& push) const {
  const bool tangled = any_tangled(m.tangled), sewn = !model_->sewn_until.empty();
  if (!tangled && !sewn) return false;
  push.assign(m.x.size(), Vec3::Zero());
  if (tangled) {
    const std::vector<Crossing> crossings = own_crossings(*model_, crossings_within(m.x, model_->triangles));
    mark_tangled(*model_, crossings, m.tangled);
    untangling(m.x, model_->triangles, crossings, push);
  }
  const bool eased = sewn && ease_sewing(*model_, time, m.v, push);
  return tangled || eased;
}

FrameReport ClothSolver::advance_frame(State& state) const {
  const std::lock_guard lock(one_at_a_time_);
  const auto clock = std::chrono::steady_clock::now();
  const ClothSetup& setup = model_->setup;
  Frame frame;
  frame.number = state.frame + 1;
  frame.t0 = (state.frame - setup.first_frame) / setup.fps;
  frame.t1 = (frame.number - setup.first_frame) / setup.fps;
  const auto body_clock = std::chrono::steady_clock::now();
  body_.begin(frame.t0, frame.t1, expected_substeps_);
  ClothMotion start = load_motion(state, at(model_->vertex_count()));
  if (const Teleport* teleport = teleport_into(setup.teleports, frame.number)) {
    carry(*teleport, start);
    body_.cut(*teleport);
  }
  const int substeps = expected_substeps_ = choose_substeps(frame, start);
  FrameReport report, best_report;
  ClothMotion motion, best;
  int fewest = -1;
  FrameProfile spent;
  spent.body = elapsed(body_clock);
  for (int attempt = 0; attempt <= k_rewinds; ++attempt) {
    const auto walk_anew = [&](int count) {
      motion = start;
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
    if (!report.finite) motion = start;  // the last finite state; the attempt counts as failed
    const auto certificate = std::chrono::steady_clock::now();
    const int avoidable = certificate_.certify(body_.end().feasible, motion, report);
    report.profile.certificate += elapsed(certificate);
    spent = report.profile;
    const int score = report.finite ? avoidable : std::numeric_limits<int>::max();
    const bool better = fewest < 0 || score < fewest;
    if (better) {
      fewest = score;
      best_report = report;
      best = motion;
    }
    if (score == 0 || !better) break;
  }
  report = std::move(best_report);
  motion = std::move(best);
  report.profile = spent;
  const Vec3 centre = volume_centre(body_.end().feasible, collider_triangles());
  for (InteractionForce& force : report.forces) force.mean = force.mean.moved(centre);
  if (!std::isfinite(report.smallest_gap))
    report.smallest_gap = model_->contact.radius.empty() ? 0 : model_->contact.radius[0];
  const auto certificate = std::chrono::steady_clock::now();
  certificate_.describe(body_.end().drawn, motion, report);
  report.profile.certificate += elapsed(certificate);
  store(state, motion);
  state.frame = frame.number;
  state.time = frame.t1;
  report.profile.total = elapsed(clock);
  return report;
}

}  // namespace

Result<std::unique_ptr<Solver>> make_cloth_solver(ClothSetup setup) {
  if (setup.coarsen > 1) return make_coarse_solver(std::move(setup));
  auto model = build_cloth_model(std::move(setup));
  if (!model) return model.error();
  return std::unique_ptr<Solver>(std::make_unique<ClothSolver>(std::move(*model)));
}

}  // namespace ft
