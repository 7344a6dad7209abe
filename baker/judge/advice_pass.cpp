#include "baker/judge/advice_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "baker/core/volume.h"
#include "solvers/standins/fit.h"

namespace ft::inline baker {
namespace {

constexpr double k_window =
    0.5;  ///< of sustained contact that displacements are predicted for [s] (O'Brien et al. 2000)
/// What a final bake takes, in passes of preview quality: at least four, by the benchmark's scenes.
constexpr double k_final_cost = 4;

using Clock = std::chrono::steady_clock;
double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The value below which a share of them lies.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

/// Largest displacement that the accelerations make within any window, from rest.
double largest_displacement(std::span<const Vec3> acceleration, double dt) {
  const auto window = static_cast<std::size_t>(std::max(1.0, std::round(k_window / dt)));
  double largest = 0;
  for (std::size_t begin = 0; begin < acceleration.size(); ++begin) {
    Vec3 v = Vec3::Zero(), d = Vec3::Zero();
    for (std::size_t i = begin; i < std::min(begin + window, acceleration.size()); ++i) {
      d += dt * v + 0.5 * dt * dt * acceleration[i];
      v += dt * acceleration[i];
      largest = std::max(largest, d.norm());
    }
  }
  return largest;
}

}  // namespace

void gather(std::span<const Wrench> forces, std::span<const Vec3> centre, const Vec3& gravity, double mass, double fps,
            Evidence& e) {
  CHECK(forces.size() == centre.size());
  const double dt = 1 / fps;
  std::vector<double> sizes;
  std::vector<Vec3> acceleration;
  Vec3 impulse = Vec3::Zero();
  std::vector<ForceSample> samples;
  int against = 0, upright = 0, moving = 0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const Vec3& f = forces[i].force;
    if (mass > 0) acceleration.push_back(f / mass);
    impulse += dt * f;
    const double size = f.norm();
    if (size == 0) continue;
    sizes.push_back(size);
    if (f.dot(-gravity) > 0.9 * size * gravity.norm()) ++upright;
    if (i == 0) continue;
    const Vec3 v = (centre[i] - centre[i - 1]) / dt;
    ++moving;
    if (f.dot(v) < 0) ++against;
    samples.push_back({f, v, Vec3::Zero()});
  }
  e.mass_known = mass > 0;
  e.frames = static_cast<int>(sizes.size());
  if (e.frames == 0) return;
  e.upright_share = static_cast<double>(upright) / e.frames;
  if (moving > 0) e.dissipative_share = static_cast<double>(against) / moving;
  const StandInFit fit = fit_stand_in(samples);
  e.damping = fit.damping, e.damping_r2 = fit.r2;
  if (mass <= 0) return;
  e.acceleration_p95 = quantile(sizes, 0.95) / mass;
  e.acceleration_max = *std::max_element(sizes.begin(), sizes.end()) / mass;
  for (const double s : sizes) e.acceleration_mean += s / mass / static_cast<double>(sizes.size());
  e.displacement = largest_displacement(acceleration, dt);
  e.velocity_change = impulse.norm() / mass;
  std::vector<double> own;
  for (std::size_t i = 1; i + 1 < centre.size(); ++i)
    own.push_back(((centre[i + 1] - 2 * centre[i] + centre[i - 1]) / (dt * dt) - gravity).norm());
  if (!own.empty()) e.own_acceleration = quantile(own, 0.95);
}

Result<AdvicePass> run_advice_pass(const AdviceOptions& options, const BakeServices& services, ShotFaults& faults) {
  const auto clock = Clock::now();
  std::vector<std::string> overrides = options.overrides;
  overrides.push_back("shot.quality=preview");
  auto inputs = read_inputs(options.shot_file, overrides, {}, faults);
  if (!inputs) return inputs.error();
  // Whatever the shot file has them, forces are those on a primary that does not yield.
  for (const auto& secondary : inputs->shot.secondaries) secondary->coupling = "one-way";
  auto plan = make_plan(std::move(*inputs), services.importer, {});
  if (!plan) return plan.error();
  std::erase_if(plan->groups, [](const auto& group) { return group->outputs.empty(); });
  if (plan->groups.empty())
    return usage_error("has no secondary whose forces could be measured", options.shot_file.string(),
                       "stand-ins alone are met by bake");
  const Shot& shot = plan->shot();
  AdvicePass out;
  out.shot_frames = shot.last_frame - shot.first_frame + (shot.preroll > 0 ? 1 : 0);  // the very first is not walked to
  out.frames = out.shot_frames;
  double frame_seconds = 0;
  std::vector<FrameReport> reports;
  auto left = static_cast<double>(plan->groups.size());  // groups that share what is left of the time
  for (const auto& group : plan->groups) {
    const PrimaryPlan& primary = plan->primaries[group->primary];
    const double share = (options.seconds - since(clock)) / left--;
    const auto begin = Clock::now();
    auto solver = services.make_solver(*group);
    if (!solver) return solver.error();
    State state = (*solver)->initial_state();
    reports.clear();
    std::vector<Vec3> centre, pose(static_cast<std::size_t>(primary.trajectory->surface().vertex_count()));
    std::vector<Box> boxes;
    const auto walk_clock = Clock::now();
    int walked = 0;
    while (state.frame < shot.last_frame && since(begin) < share) {
      FrameReport report = (*solver)->advance_frame(state);
      ++walked;
      if (report.frame < shot.first_frame) continue;
      primary.trajectory->sample(state.time, pose);
      boxes.push_back(bounds(pose));
      centre.push_back(volume_centre(pose, primary.trajectory->surface().triangles));
      reports.push_back(std::move(report));
    }
    if (walked > 0) frame_seconds += since(walk_clock) / walked;
    const int measured = static_cast<int>(reports.size());
    out.frames = std::min(out.frames, measured);
    if (measured < out.shot_frames)
      out.notes.push_back(fmt::format("\"{}\": {} of {} frames were measured in the time given; --seconds gives more",
                                      primary.name, measured, out.shot_frames));
    for (const SystemOutput& secondary : group->outputs) {
      Evidence e;
      e.primary = primary.name;
      e.secondary = secondary.name();
      e.two_way_possible = find_system_kind(group->role())->section().why_not_two_way().empty();
      const std::string& own = plan->primaries[secondary.primary].name;
      std::vector<Wrench> forces(reports.size());
      for (std::size_t i = 0; i < reports.size(); ++i) {
        const FrameReport& r = reports[i];
        for (const InteractionForce& f : r.forces)
          if (f.system == e.secondary && (f.primary.empty() || f.primary == own)) forces[i] = f.mean;
        e.strain_p99 = std::max(e.strain_p99, r.strain_p99);
        e.crossing_frames += r.crossings_body + r.crossings_self > 0;
        e.released_frames += r.released_vertices > 0;
        e.finite = e.finite && r.finite;
      }
      for (std::size_t i = 0; i < forces.size(); ++i)
        if (forces[i].force != Vec3::Zero()) e.place.include(boxes[i]);
      gather(forces, centre, shot.solver.gravity, primary.mass.kilograms, shot.fps, e);
      out.pairs.push_back(std::move(e));
    }
  }
  for (const BakePlan& later : plan->later)
    for (const auto& group : later.groups)
      for (const SystemOutput& output : group->outputs)
        out.notes.push_back(
            fmt::format("\"{}\" is baked after what it refers to, and is not measured here", output.name()));
  const double frames = out.shot_frames + shot.preroll;
  for (Evidence& e : out.pairs) e.cycle_seconds = frames * frame_seconds;
  out.final_seconds = k_final_cost * frames * frame_seconds;
  for (const PrimaryPlan& p : plan->primaries)
    out.primary_lines.push_back(fmt::format("\"{}\": {}", p.name, p.mass.text()));
  out.notes.insert(out.notes.begin(), plan->notes.begin(), plan->notes.end());
  out.seconds = since(clock);
  return out;
}

}  // namespace ft::inline baker
