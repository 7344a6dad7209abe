// See hair_solver.h: states, and the walk of a frame. Setting up is in hair_make.cpp, what four strands do in a step
// in hair_advance.cpp.
#include "solvers/hair/hair_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "baker/core/check.h"
#include "baker/core/output_frame.h"
#include "baker/core/parallel.h"
#include "baker/core/rigid.h"
#include "baker/core/state_points.h"
#include "solvers/hair/hair_group.h"

namespace ft::inline solvers {
namespace {

/// The farthest that a body or a root goes in a step. With it no vertex gets into a head that is shaken by 5 cm eight
/// times a second (hair_test.cpp) [m].
constexpr double k_way = 0.008;

/// What roots go in the mean [m].
Vec3 common_way(std::span<const RootFrame> now, std::span<const RootFrame> after) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t s = 0; s < now.size(); ++s) sum += after[s].place - now[s].place;
  return sum / static_cast<double>(now.size());
}

/// All guides of a state without their ghosts.
struct GuidesOfState {
  std::vector<Vec3> x, v, director;
  GuidesOfState(const State& state, std::size_t n) {
    const auto all_x = as_points(*state.find("x")), all_v = as_points(*state.find("v")),
               all_m = as_points(*state.find("m"));
    for (std::size_t s = 0; s < all_x.size() / n; ++s) {
      const auto own = [&](auto all) { return all.subspan(s * n + 1, n - 1); };
      x.insert(x.end(), own(all_x).begin(), own(all_x).end());
      v.insert(v.end(), own(all_v).begin(), own(all_v).end());
      add_directors(all_m.subspan(s * (n - 1), n - 1), director);
    }
  }
  GuidesNow now() const { return {x, v, director}; }
};

}  // namespace

std::vector<RootFrame> HairSolver::roots_at(double time) const {
  std::vector<Vec3> scalp(at(setup_.scalp->surface().vertex_count()));
  setup_.scalp->sample(time, scalp);
  std::vector<RootFrame> out;
  roots_->frames(scalp, out);
  return out;
}

State HairSolver::initial_state() const {
  State state;
  state.frame = setup_.first_frame - setup_.preroll_frames;
  state.time = -setup_.preroll_frames / setup_.fps;
  const std::vector<RootFrame> now = roots_at(state.time);
  std::vector<double> x, m;
  for (std::size_t s = 0; s < setup_.strands.size(); ++s) {
    for (const Vec3& p : groom_[s]) {
      const Vec3 q = now[s].carry(roots_->bind()[s], p);
      x.insert(x.end(), {q.x(), q.y(), q.z()});
    }
    for (std::size_t j = 0; j + 1 < at(n_); ++j) {
      const Vec3 d = now[s].turn * (roots_->bind()[s].turn.transpose() * directors_[s * at(n_ - 1) + j]);
      m.insert(m.end(), {d.x(), d.y(), d.z()});
    }
  }
  const std::size_t count = x.size();
  state.set("x_before", x);
  state.set("x", std::move(x));
  state.set("v", std::vector<double>(count));
  state.set("v_before", std::vector<double>(count));
  state.set("m", std::move(m));
  state.set("tension", std::vector<double>(count / 3));
  state.set("step", std::vector<double>(1));
  return state;
}

void HairSolver::system_positions(const State& state, int system, std::span<Vec3> positions) const {
  CHECK(is_ridden(system));
  ridden_->place(GuidesOfState(state, at(n_)).now(), roots_at(state.time), positions);
}

void HairSolver::system_frame(const State& state, int system, FrameData& frame) const {
  frame = {};
  if (system == 1)
    return between_->place(GuidesOfState(state, at(n_)).now(), state.time, frame.positions, frame.velocities);
  const auto x = as_points(*state.find("x")), v = as_points(*state.find("v"));
  for (std::size_t s = 0; s < setup_.strands.size(); ++s)
    for (std::size_t i = 1; i < at(n_); ++i) {
      frame.positions.push_back(x[s * at(n_) + i].cast<float>());
      frame.velocities.push_back(v[s * at(n_) + i].cast<float>());
    }
}

/// Velocities are those that the step ends with if nothing changes, so that what falls together is not braked.
void HairSolver::feel_crowd(const State& state, double h, std::span<const RootFrame> roots, std::vector<Vec3>& push,
                            std::vector<Vec3>& flow) {
  if (!crowd_) return;
  std::vector<Vec3> combed, now;
  for (std::size_t s = 0; s < roots.size(); ++s)
    combed.push_back(roots_->bind()[s].place), now.push_back(roots[s].place);
  const Eigen::Isometry3d to_world = rigid_fit(combed, now), to_groom = to_world.inverse();
  const auto all_x = as_points(*state.find("x")), all_v = as_points(*state.find("v")),
             before = as_points(*state.find("v_before"));
  std::vector<Vec3> x, v;
  for (std::size_t k = 0; k < all_x.size(); ++k) {
    if (k % at(n_) == 0) continue;  // a ghost
    x.push_back(to_groom * all_x[k]);
    v.push_back(to_groom.linear() * (2 * all_v[k] - before[k]));
  }
  crowd_->feel(x, v, h, push, flow);
  for (Vec3& p : push) p = to_world.linear() * p;
  for (Vec3& u : flow) u = to_world.linear() * u;
}

bool HairSolver::jumps_into(int frame) const {
  return std::ranges::find(setup_.teleports, frame) != setup_.teleports.end();
}

void HairSolver::carry(State& state, std::span<const RootFrame> now, std::span<const RootFrame> after) const {
  const auto each = [&](const char* block, std::size_t per_strand, const auto& carried) {
    std::vector<double>& values = state.block(block);
    for (std::size_t k = 0; k < values.size() / 3; ++k) {
      const std::size_t s = k / per_strand;
      const Vec3 v = carried(s, Vec3(values[3 * k], values[3 * k + 1], values[3 * k + 2]));
      for (std::size_t a = 0; a < 3; ++a) values[3 * k + a] = v[static_cast<int>(a)];
    }
  };
  const auto place = [&](std::size_t s, const Vec3& p) { return after[s].carry(now[s], p); };
  const auto turn = [&](std::size_t s, const Vec3& v) { return Vec3(after[s].turn * (now[s].turn.transpose() * v)); };
  for (const char* block : {"x", "x_before"}) each(block, at(n_), place);
  for (const char* block : {"v", "v_before"}) each(block, at(n_), turn);
  each("m", at(n_) - 1, turn);
}

FrameReport HairSolver::advance_frame(State& state) {
  const auto clock = std::chrono::steady_clock::now();
  FrameReport report;
  report.frame = state.frame + 1;
  report.smallest_gap = std::numeric_limits<double>::infinity();  // not measured
  const double t0 = (state.frame - setup_.first_frame) / setup_.fps,
               t1 = (report.frame - setup_.first_frame) / setup_.fps;
  bodies_.start_at(t0);
  bodies_.end_at(t1);
  std::vector<RootFrame> before, now = roots_at(t0), after = roots_at(t1);
  if (jumps_into(report.frame)) {
    carry(state, now, after);
    bodies_.advance();
    state.block("step")[0] = 0;
    state.frame = report.frame;
    state.time = t1;
    report.substeps = 1;
    add_force({}, 0, t1, report);
    for (const char* own : {"hair_steps", "hair_iterations", "hair_unsettled"}) report.own[own] = 0;
    certify(state, report);
    report.profile.total = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
    return report;
  }
  double way = bodies_.way();
  std::vector<Wrench> impulses;
  for (std::size_t s = 0; s < now.size(); ++s) way = std::max(way, (after[s].place - now[s].place).norm());
  const int wanted = static_cast<int>(std::min(std::ceil(way / k_way), 1e6));
  const int steps = std::clamp(wanted, setup_.least_steps, setup_.most_steps);
  const double h = (t1 - t0) / steps;
  const bool goes_on = std::abs(state.find("step")->at(0) - h) < 1e-9 * h;
  before = jumps_into(state.frame) ? now : roots_at(t0 - h);
  std::vector<Vec3> push, flow;
  std::vector<int> iterations(rods_.size(), 0), unsettled(rods_.size(), 0), passages(rods_.size(), 0);
  for (int k = 0; k < steps; ++k) {
    const double end = k + 1 == steps ? t1 : t0 + h * (k + 1);
    after = roots_at(end);
    bodies_.end_at(end, common_way(now, after));
    Step step;
    step.h = h;
    step.first = k == 0 && !goes_on;
    step.roots_before = before, step.roots_now = now, step.roots_after = after;
    std::unique_ptr<AirNow> air;
    if (setup_.wind && !setup_.wind->is_still()) air = setup_.wind->at_time(end);
    step.air = air.get();
    feel_crowd(state, h, now, push, flow);
    step.push = push, step.flow = flow;
    step.x = state.block("x").data(), step.x_before = state.block("x_before").data();
    step.v = state.block("v").data(), step.v_before = state.block("v_before").data();
    step.m = state.block("m").data(), step.tension = state.block("tension").data();
    step.iterations = iterations.data(), step.unsettled = unsettled.data();
    step.passages = passages.data();
    parallel_for(rods_.size(), 1, [&](std::size_t begin, std::size_t finish) {
      thread_local Work work;
      for (std::size_t g = begin; g < finish; ++g) advance_group(step, g, work);
    });
    impulses.push_back(impulse_on_scalp(state, h, air.get()));
    bodies_.advance();
    std::swap(before, now);
    std::swap(now, after);
  }
  state.block("step")[0] = h;
  state.frame = report.frame;
  state.time = t1;
  report.substeps = steps;
  add_force(impulses, h, t1, report);
  double sum = 0, rest = 0;
  int passed = 0;
  for (std::size_t g = 0; g < rods_.size(); ++g) sum += iterations[g], rest += unsettled[g], passed += passages[g];
  report.newton_iterations = static_cast<int>(sum);
  report.own["hair_steps"] = steps;
  report.own["hair_iterations"] = sum / (steps * static_cast<double>(rods_.size()));
  report.own["hair_unsettled"] = rest;
  const auto say = [&](const std::string& text) {
    Incident& incident = report.incidents.emplace_back();
    incident.kind = Incident::Kind::k_unsettled;
    incident.frame = report.frame;
    incident.system = setup_.name;
    incident.place = as_points(*state.find("x"))[1];
    incident.text = text;
  };
  if (wanted > setup_.most_steps)
    say(fmt::format(
        "a body or a root goes {:.2g} m in this frame, {:.0f} mm in each of {} steps: strands may not keep up "
        "with it; more frames per second help",
        way, 1e3 * way / steps, steps));
  if (passed > 0) say(fmt::format("{} segments of strands went through a sheet", passed));
  if (rest > 0) say(fmt::format("{:.0f} times a strand did not settle in a step, nor in pieces of it", rest));
  certify(state, report);
  report.profile.total = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return report;
}

}  // namespace ft::inline solvers
