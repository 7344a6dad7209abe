// The walk of a frame: equal substeps no longer than the setup's; in each the prop's place at its end, if it is driven,
// and the scenery's, then the step. A prop that is to be released on contact is let go at the start of the first
// substep in which something comes into its reach.
#include "solvers/lockstep/lockstep_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>

#include "baker/core/state_points.h"
#include "baker/core/volume.h"
#include "solvers/cords/tubes.h"
#include "solvers/lockstep/lockstep_step.h"
#include "solvers/lockstep/passing.h"

namespace ft::inline solvers {
namespace {

double number_of(const State& state, const char* name) {
  const auto* values = state.find(name);
  CHECK(values && values->size() == 1);
  return values->front();
}

/// A driven prop that is held back by more than this is not let wait [m].
constexpr double k_missed = 1e-4;
constexpr int k_most_attempts = 100;

class LockstepSolver final : public Solver {
 public:
  explicit LockstepSolver(LockstepModel model) : model_(std::move(model)), step_(model_) {
    for (const CordSystem& c : model_.setup.cords) tubes_.emplace_back(c.graph, c.radius, c.name);
    const int first = model_.has_prop() ? model_.point_count() : 0;
    for (const Triangle& t : model_.skin) prop_triangles_.push_back({t[0] - first, t[1] - first, t[2] - first});
  }

  int system_count() const override { return static_cast<int>(tubes_.size()); }
  const Mesh& system_mesh(int system) const override { return tubes_[at(system)].mesh(); }
  void system_positions(const State& state, int system, std::span<Vec3> out) const override {
    const std::vector<Vec3> x = points_of(state, "x", at(model_.node_count()));
    const auto first = at(model_.first_point[at(system)]), end = at(model_.first_point[at(system) + 1]);
    tubes_[at(system)].place(std::span(x).subspan(first, end - first), out);
  }
  std::span<const Triangle> collider_triangles() const override { return prop_triangles_; }
  void collider_positions(const State& state, std::vector<Vec3>& out) const override {
    std::vector<Vec3> places;
    model_.spread(points_of(state, "x", at(model_.node_count())), places);
    out.assign(places.begin() + model_.point_count(), places.end());
  }
  bool moves_primary() const override { return model_.has_prop() && model_.setup.prop->two_way; }
  State initial_state() const override;
  FrameReport advance_frame(State& state) override;

 private:
  struct Moving {
    LockstepMotion motion;
    bool free = false;
    std::vector<double> through;  ///< per point, as LockstepContact::let_through()
    Vec3 hold_impulse = Vec3::Zero();
  };
  struct Unsettled {
    int steps = 0;
    double residual = 0;  ///< largest of what they still wanted to move [m]
  };
  void substep(double time, double h, double frame_time, int halvings, Moving& moving, Unsettled& unsettled,
               FrameReport& report);
  Incident incident_at(int point, Incident::Kind kind, const Moving& moving, const FrameReport& report) const;
  bool is_released(double time, double h, const Moving& moving);
  void begin_forces(FrameReport& report) const;
  void end_forces(const Moving& moving, double time, FrameReport& report) const;
  void tell_passing(const Moving& moving, FrameReport& report) const;
  void judge(const Moving& moving, FrameReport& report);
  void store(State& state, const Moving& moving) const;
  Moving load(const State& state) const;
  std::array<Vec3, 4> track(double time) const { return model_.frame.place(model_.setup.prop->track(time).pose); }

  LockstepModel model_;
  std::vector<CordTubes> tubes_;
  std::vector<Triangle> prop_triangles_;
  // Scratch only: forgotten between frames, one frame at a time.
  LockstepStep step_;
  std::mutex one_at_a_time_;
};

void LockstepSolver::store(State& state, const Moving& m) const {
  state.set("x", flat(m.motion.x));
  state.set("v", flat(m.motion.v));
  state.set("x_previous", flat(m.motion.x_previous));
  state.set("v_previous", flat(m.motion.v_previous));
  state.set("h_previous", {m.motion.h_previous});
  state.set("through", m.through);
  state.set("free", {m.free ? 1.0 : 0.0});
  state.set("hold_impulse", {m.hold_impulse.x(), m.hold_impulse.y(), m.hold_impulse.z()});
}

LockstepSolver::Moving LockstepSolver::load(const State& state) const {
  const std::size_t n = at(model_.node_count());
  Moving m;
  m.motion = {points_of(state, "x", n), points_of(state, "v", n), points_of(state, "x_previous", n),
              points_of(state, "v_previous", n), number_of(state, "h_previous")};
  const auto* through = state.find("through");
  CHECK(through && through->size() == at(model_.point_count()));
  m.through = *through;
  m.free = number_of(state, "free") != 0;
  m.hold_impulse = points_of(state, "hold_impulse", 1)[0];
  return m;
}

State LockstepSolver::initial_state() const {
  const LockstepSetup& setup = model_.setup;
  State state;
  state.frame = setup.first_frame - setup.preroll_frames;
  state.time = -setup.preroll_frames / setup.fps;
  Moving m;
  m.motion.x = model_.start;
  m.motion.v.assign(model_.start.size(), Vec3::Zero());
  if (model_.has_prop()) {
    const RigidMotion motion = setup.prop->track(state.time);
    for (const Vec3& p : model_.frame.place(motion.pose)) {
      m.motion.x.push_back(p);
      m.motion.v.push_back(motion.velocity_at(p));
    }
  }
  m.motion.x_previous = m.motion.x;
  m.motion.v_previous = m.motion.v;
  m.through.assign(model_.start.size(), 0);
  let_start_through(model_, state.time, m.through);
  store(state, m);
  return state;
}

/// At the start of a substep. A history on the track makes the integrator exact for the flight that follows.
bool LockstepSolver::is_released(double time, double h, const Moving& m) {
  const RigidProp& prop = *model_.setup.prop;
  if (!prop.two_way) return false;
  if (time >= prop.release - 1e-9 * h) return true;
  if (!prop.release_on_contact) return false;
  std::vector<Vec3> way;
  for (const Vec3& v : m.motion.v) way.push_back(h * v);
  const auto next = track(time + h);
  const std::size_t points = at(model_.point_count());
  for (std::size_t k = 0; k < 4; ++k) way[points + k] = next[k] - m.motion.x[points + k];
  step_.contact().find(m.motion.x, way);
  return step_.contact().meets_prop();
}

void LockstepSolver::substep(double time, double h, double frame_time, int halvings, Moving& m, Unsettled& unsettled,
                             FrameReport& report) {
  std::array<Vec3, 4> driven;
  bool is_driven = false;
  step_.contact().begin_step(time, time + h);
  if (model_.has_prop() && !m.free) {
    if (is_released(time, h, m)) {
      m.free = true;
      const RigidMotion now = model_.setup.prop->track(time);
      const std::size_t points = at(model_.point_count());
      const auto nodes = model_.frame.place(now.pose);
      const double back = m.motion.h_previous > 0 ? m.motion.h_previous : h;
      for (std::size_t k = 0; k < 4; ++k) {
        m.motion.x[points + k] = nodes[k];
        m.motion.v[points + k] = now.velocity_at(nodes[k]);
        // Constant acceleration before: BDF2 is exact for the flight from its first step on.
        m.motion.x_previous[points + k] =
            nodes[k] - back * m.motion.v[points + k] + 0.5 * back * back * model_.setup.gravity;
        m.motion.v_previous[points + k] = m.motion.v[points + k] - back * model_.setup.gravity;
      }
    } else {
      driven = track(time + h);
      is_driven = true;
    }
  }
  LockstepStepReport step;
  const LockstepMotion before = m.motion;
  const std::vector<double> through_before = m.through;
  for (int attempt = 0;; ++attempt) {
    step_.contact().let_through(m.through);
    step = step_.step(time + h, h, is_driven ? std::span<const Vec3>(driven) : std::span<const Vec3>(), m.motion);
    ++report.substeps;
    report.newton_iterations += step.newton_iterations;
    report.linear_iterations += step.newton_iterations;
    const bool late = step.scenery_late && halvings == model_.setup.most_halvings;  // else a shorter step is tried
    if (!step.finite || (step.missed <= k_missed && !late) || attempt > k_most_attempts) break;
    // What is driven goes its way: cords that stand in it and give way no further are let through.
    if (attempt == k_most_attempts || !let_blocking_through(step_.blocking(m.motion.x, is_driven), m.through)) {
      if (model_.setup.bodies.empty()) break;
      let_all_through(model_, m.through);
      attempt = k_most_attempts;
    }
    m.motion = before;
  }
  report.profile.narrow += step.seconds_contact;
  report.profile.assembly += step.seconds_assembly;
  report.profile.linear += step.seconds_linear;
  if (!(step.finite && step.settled) && halvings < model_.setup.most_halvings) {
    m.motion = before;
    m.through = through_before;
    for (const double start : {time, time + 0.5 * h})
      substep(start, 0.5 * h, frame_time, halvings + 1, m, unsettled, report);
    return;
  }
  if (!step.settled) {
    ++unsettled.steps;
    unsettled.residual = std::max(unsettled.residual, step.residual);
  }
  report.finite = report.finite && step.finite;
  if (!step.finite) return;
  m.hold_impulse += step.effective_step * step.hold_force;
  for (std::size_t row = 0; row < report.forces.size(); ++row) {
    InteractionForce& force = report.forces[row];
    const double size = step.on_met[row].force.norm();
    force.mean += (h / frame_time) * step.on_met[row];
    force.peak = std::max(force.peak, size);
    if (size > 0) force.contact_share = std::min(1.0, force.contact_share + h / frame_time);
  }
}

/// A row for each cord system and all that there is to meet.
void LockstepSolver::begin_forces(FrameReport& report) const {
  for (const CordSystem& c : model_.setup.cords)
    for (std::size_t met = 0; met < model_.met_count(); ++met) {
      InteractionForce& row = report.forces.emplace_back();
      row.system = c.name;
      if (model_.met_count() > 1 && (met > 0 || model_.has_prop())) row.primary = model_.name_of_met(met);
    }
}

/// Torques about centres; rows of what a cord system does not meet are left out.
void LockstepSolver::end_forces(const Moving& m, double time, FrameReport& report) const {
  std::vector<Vec3> centre(model_.met_count(), Vec3::Zero()), x;
  for (std::size_t k = 0; k < 4 && model_.has_prop(); ++k) centre[0] += 0.25 * m.motion.x[at(model_.point_count()) + k];
  for (std::size_t b = 0; b < model_.setup.bodies.size(); ++b) {
    const Trajectory& body = *model_.setup.bodies[b].trajectory;
    x.resize(at(body.surface().vertex_count()));
    body.sample(time, x);
    centre[b + 1] = volume_centre(x, body.surface().triangles);
  }
  std::vector<InteractionForce> kept;
  for (std::size_t row = 0; row < report.forces.size(); ++row) {
    const std::size_t system = row / centre.size(), met = row % centre.size();
    if (met == 0 ? !model_.has_prop() : !model_.meets(static_cast<int>(system), static_cast<int>(met))) continue;
    kept.push_back(std::move(report.forces[row]));
    kept.back().mean = kept.back().mean.moved(centre[met]);
  }
  report.forces = std::move(kept);
}

Incident LockstepSolver::incident_at(int point, Incident::Kind kind, const Moving& m, const FrameReport& report) const {
  Incident out;
  const int system = model_.system_of[at(point)];
  out.kind = kind;
  out.frame = report.frame;
  out.system = model_.cords_of(point).name;
  out.vertex = tubes_[at(system)].vertex_of(point - model_.first_point[at(system)]);
  out.place = m.motion.x[at(point)];
  return out;
}

void LockstepSolver::tell_passing(const Moving& m, FrameReport& report) const {
  const auto passes = [](double through) { return through != 0; };
  report.released_vertices = static_cast<int>(std::count_if(m.through.begin(), m.through.end(), passes));
  if (report.released_vertices == 0) return;
  const auto first = std::find_if(m.through.begin(), m.through.end(), passes);
  Incident incident = incident_at(static_cast<int>(first - m.through.begin()), Incident::Kind::k_released, m, report);
  incident.text = fmt::format("{} points are let through {}", report.released_vertices, passed_text(model_, m.through));
  report.incidents.push_back(std::move(incident));
}

void LockstepSolver::judge(const Moving& m, FrameReport& report) {
  const auto crossings = step_.contact().crossings(m.motion.x);
  report.crossings_body = report.crossings_drawn = static_cast<int>(crossings.size());
  std::vector<double> strain;
  double sum = 0;
  for (std::size_t i = 0; i < model_.cords.size(); ++i) {
    const double length = (m.motion.x[at(model_.cords[i][0])] - m.motion.x[at(model_.cords[i][1])]).norm();
    strain.push_back(std::max(0.0, length / model_.rest_length[i] - 1));  // slack is no strain
    sum += strain.back();
  }
  std::sort(strain.begin(), strain.end());
  report.strain_max = strain.back();
  report.strain_p99 = strain[strain.size() * 99 / 100];
  report.strain_mean = sum / static_cast<double>(strain.size());
  for (int i = 0; i < model_.point_count(); ++i)
    report.kinetic_energy += 0.5 * model_.mass[at(i)] * m.motion.v[at(i)].squaredNorm();
  if (crossings.empty()) return;
  Incident incident = incident_at(crossings[0].cord[0], Incident::Kind::k_crossing, m, report);
  incident.text = crossings[0].met == 0 ? "cords cross the prop"
                                        : "cords cross \"" + model_.name_of_met(at(crossings[0].met)) + "\"";
  report.incidents.push_back(std::move(incident));
}

FrameReport LockstepSolver::advance_frame(State& state) {
  const std::lock_guard lock(one_at_a_time_);
  const auto clock = std::chrono::steady_clock::now();
  const LockstepSetup& setup = model_.setup;
  const int number = state.frame + 1,
            substeps =
                std::max(setup.min_substeps, static_cast<int>(std::ceil(1 / (setup.fps * setup.longest_step) - 1e-9)));
  const double t0 = (state.frame - setup.first_frame) / setup.fps, t1 = (number - setup.first_frame) / setup.fps;
  Moving moving = load(state);
  FrameReport report;
  report.frame = number;
  begin_forces(report);
  step_.contact().begin_frame();
  step_.contact().forget_gap();
  Unsettled unsettled;
  for (int k = 0; k < substeps && report.finite; ++k)
    substep(t0 + (t1 - t0) * k / substeps, (t1 - t0) / substeps, t1 - t0, 0, moving, unsettled, report);
  if (unsettled.steps > 0) {
    Incident& incident = report.incidents.emplace_back();
    incident.kind = Incident::Kind::k_unsettled;
    incident.frame = number;
    incident.system = setup.cords.front().name;
    incident.depth = unsettled.residual;
    incident.text = fmt::format(
        "{} of {} steps ended before all was at rest: {:.1e} m were still wanted; a larger min_substeps helps",
        unsettled.steps, report.substeps, unsettled.residual);
  }
  end_forces(moving, t1, report);
  report.smallest_gap = std::min(step_.contact().smallest_gap(), step_.contact().widest_reach());
  judge(moving, report);
  tell_passing(moving, report);
  if (report.released_vertices > 0) hold_again(model_, step_.contact(), t1, moving.motion.x, moving.through);
  store(state, moving);
  state.frame = number;
  state.time = t1;
  report.profile.total = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return report;
}

}  // namespace

Result<std::unique_ptr<Solver>> make_lockstep_solver(LockstepSetup setup) {
  auto model = build_lockstep_model(std::move(setup));
  if (!model) return model.error();
  return std::unique_ptr<Solver>(std::make_unique<LockstepSolver>(std::move(*model)));
}

}  // namespace ft::inline solvers
