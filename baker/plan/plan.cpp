#include "baker/plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>

#include "baker/plan/air.h"
#include "baker/plan/carrier.h"
#include "baker/plan/character_plan.h"
#include "baker/plan/known_motion.h"
#include "baker/plan/output_formats.h"
#include "baker/plan/preroll_speed.h"
#include "baker/plan/quality.h"
#include "io/shot/chains.h"

namespace ft::inline baker {
namespace {

constexpr double k_prop_step = 1.0 / 600;  ///< longest between samples of a prop's adjusted track [s]

/// Whether something asks for a primary that is one rigid body: a secondary that asks for it, or a coupling that moves
/// it.
bool has_to_be_rigid(const Shot& shot, const PrimaryPlan& primary) {
  return (is_hybrid(shot, primary.name) && !primary.yielding) ||
         std::any_of(shot.secondaries.begin(), shot.secondaries.end(),
                     [&](const auto& s) { return s->on == primary.name && s->section->needs_rigid_primary(); });
}

/// Its prop, and where it goes: along its track or, once stand-ins have been met, the adjusted one.
Status plan_prop(const Shot& shot, const PrimarySpec& spec, PrimaryPlan& primary, std::vector<std::string>& notes) {
  if (!spec.shape.empty()) {
    primary.prop = std::make_shared<const Prop>(prop_of_shape(spec, shot));
  } else if (has_to_be_rigid(shot, primary)) {
    auto prop = prop_of_trajectory(spec, shot, primary.trajectory, primary.mass.kilograms);
    if (!prop) return prop.error();
    primary.prop = std::make_shared<const Prop>(std::move(*prop));
  } else {
    return {};
  }
  primary.track = primary.prop->track;
  if (is_hybrid(shot, spec.name) && !primary.hybrid) {
    const Prop& prop = *primary.prop;
    YieldingBody body{prop.mass, prop.track, [samples = prop.samples](double) { return std::span(samples); }};
    auto pass = hybrid_pass(shot, spec, std::move(body), k_prop_step, Vec3::Ones());
    if (!pass) return pass.error();
    primary.track = [before = prop.track, after = sampled_motion(0, pass->dt, pass->motion)](double time) {
      return time < 0 ? before(time) : after(time);
    };
    std::ranges::move(pass->lines(spec.name), std::back_inserter(notes));
    primary.hybrid = std::make_shared<const HybridPass>(std::move(*pass));
  }
  primary.trajectory = prop_trajectory(*primary.prop, primary.track, shot.preroll / shot.fps);
  if (!spec.shape.empty()) {
    primary.mass = primary_mass(spec, *primary.trajectory);
    primary.info.format = spec.shape;
    primary.info.vertex_count = primary.trajectory->surface().vertex_count();
    primary.info.triangle_count = static_cast<int>(primary.trajectory->surface().triangles.size());
    primary.info.bind_bounds = bounds(bind_pose_of(*primary.trajectory));
    primary.info.up.assign(1, 'y');
  }
  return {};
}

/// Characters and props, with the pre-roll that the shot has now.
Status plan_primaries_once(BakePlan& plan, const Importer& importer, const std::filesystem::path& import_cache) {
  const Shot& shot = plan.shot();
  plan.primaries.clear();
  plan.notes = shot.notes;
  for (const PrimarySpec& spec : shot.primaries) {
    PrimaryPlan primary;
    primary.name = spec.name;
    if (spec.shape.empty()) {
      auto character = plan_character(shot, spec, importer, import_cache, plan.notes);
      if (!character) return character.error();
      primary = std::move(*character);
    }
    if (const Status planned = plan_prop(shot, spec, primary, plan.notes); !planned) return planned.error();
    plan.primaries.push_back(std::move(primary));
  }
  return {};
}

/// A pre-roll that the shot does not name becomes as long as its characters need to get to its first frame calmly.
Status plan_primaries(BakePlan& plan, const Importer& importer, const std::filesystem::path& import_cache) {
  if (const Status planned = plan_primaries_once(plan, importer, import_cache); !planned) return planned.error();
  Shot& shot = plan.inputs.shot;
  std::vector<std::pair<std::string, HastyPreroll>> hasty;
  for (const PrimaryPlan& primary : plan.primaries)
    if (const auto found = primary.prop ? std::nullopt : hasty_preroll(shot, *primary.trajectory))
      hasty.emplace_back(primary.name, *found);
  std::optional<int> taken;
  if (!hasty.empty() && !shot.preroll_given) {
    for (const auto& [name, found] : hasty) taken = std::max(taken.value_or(0), found.calm);
    shot.preroll = *taken;
    if (const Status planned = plan_primaries_once(plan, importer, import_cache); !planned) return planned.error();
  }
  for (const auto& [name, found] : hasty) plan.notes.push_back(found.text(name, taken));
  return {};
}

/// Whether some secondary is on the primary.
bool has_secondaries(const BakePlan& plan, std::size_t primary) {
  return std::any_of(plan.groups.begin(), plan.groups.end(), [&](const auto& group) {
    return std::any_of(group->outputs.begin(), group->outputs.end(),
                       [&](const SystemOutput& output) { return output.primary == primary; });
  });
}

/// What the kinds plan from: of the secondaries those of this stage, with what carries them among the primaries.
Shot shot_of_stage(const BakePlan& plan) {
  Shot out = plan.shot();
  for (std::size_t p = out.primaries.size(); p < plan.primaries.size(); ++p) {
    out.primaries.emplace_back();
    out.primaries.back().name = plan.primaries[p].name;
  }
  const std::vector<int> stages = stages_of(out.secondaries);
  Secondaries own;
  for (std::size_t i = 0; i < stages.size(); ++i)
    if (stages[i] == plan.stage) own.push_back(out.secondaries[i]);
  out.secondaries = std::move(own);
  return out;
}

/// Groups of all kinds, by their first primary; behind them primaries that yield and have no secondary.
Status plan_systems(BakePlan& plan) {
  const Shot shot = shot_of_stage(plan);
  for (const SystemKind* kind : system_kinds()) {
    auto groups = kind->plan(shot, plan);
    if (!groups) return groups.error();
    for (auto& group : *groups) plan.groups.push_back(std::move(group));
  }
  for (std::size_t p = 0; p < plan.primaries.size() && plan.stage == 0; ++p)
    if (plan.primaries[p].hybrid && !has_secondaries(plan, p))
      plan.groups.push_back(std::make_unique<BodyGroup>(p, shot.first_frame, shot.preroll, shot.fps));
  std::stable_sort(plan.groups.begin(), plan.groups.end(),
                   [](const auto& a, const auto& b) { return a->primary < b->primary; });
  return check_output_formats(plan);
}

/// So that what is wrong with a later stage shows now and not when the first is baked.
Status plan_later_stages(BakePlan& plan) {
  for (int stage = 1; stage < plan.stage_count; ++stage) {
    const BakePlan& before = stage == 1 ? plan : plan.later.back();
    std::vector<PrimaryPlan> carriers;
    for (const Carrier& carrier : carriers_of(before)) carriers.push_back(standing_carrier(carrier, before));
    auto next = plan_next_stage(before, std::move(carriers));
    if (!next) return next.error();
    plan.later.push_back(std::move(*next));
  }
  return {};
}

}  // namespace

Result<BakePlan> plan_next_stage(const BakePlan& before, std::vector<PrimaryPlan> carriers) {
  BakePlan plan;
  plan.inputs = before.inputs;
  plan.stage = before.stage + 1;
  plan.stage_count = before.stage_count;
  plan.primaries = before.primaries;
  plan.wind = before.wind;
  plan.import_seconds = before.import_seconds;
  for (PrimaryPlan& carrier : carriers) plan.primaries.push_back(std::move(carrier));
  if (const Status planned = plan_systems(plan); !planned) return planned.error();
  return plan;
}

Result<BakePlan> make_plan(BakeInputs inputs, const Importer& importer, const std::filesystem::path& import_cache) {
  BakePlan plan;
  plan.inputs = std::move(inputs);
  const Shot& shot = plan.shot();
  const auto clock = std::chrono::steady_clock::now();
  if (const Status planned = plan_primaries(plan, importer, import_cache); !planned) return planned.error();
  auto wind = plan_wind(shot, plan.primaries, plan.notes);
  if (!wind) return wind.error();
  plan.wind = std::move(*wind);
  if (is_preview(shot)) plan.notes.push_back(quality_note());
  plan.import_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();

  for (const int stage : stages_of(shot.secondaries)) plan.stage_count = std::max(plan.stage_count, stage + 1);
  if (const Status planned = plan_systems(plan); !planned) return planned.error();
  if (plan.groups.empty()) return usage_error("no secondary is on any primary", shot.file.string());
  if (const Status planned = plan_later_stages(plan); !planned) return planned.error();
  return plan;
}

}  // namespace ft::inline baker
