#include "baker/judge/advice.h"

#include <fmt/format.h>

#include <array>

namespace ft::inline baker {
namespace {

struct ContextName {
  Context context;
  const char* name;
};
constexpr std::array<ContextName, 4> k_contexts = {{{Context::k_background, "background"},
                                                    {Context::k_far, "far"},
                                                    {Context::k_occluded, "occluded"},
                                                    {Context::k_hero, "hero"}}};

enum class Significance { k_none, k_between, k_full };

Significance judge_significance(const Evidence& e, Context context, const AdviceThresholds& t,
                                std::vector<std::string>& reasons) {
  const auto say = [&](std::string text) { reasons.push_back(std::move(text)); };
  if (e.frames == 0) {
    say("they never touch in the frames that were measured");
    return Significance::k_none;
  }
  if (context != Context::k_none && context != Context::k_hero) {
    for (const ContextName& c : k_contexts)
      if (c.context == context) say(fmt::format("unimportant by context: {}", c.name));
    return Significance::k_none;
  }
  if (!e.mass_known) {
    say("whether it is significant cannot be told without the primary's mass: write mass under the primary");
    return Significance::k_none;
  }
  const double a = e.acceleration_p95;
  if (a < t.insignificant) {
    say(fmt::format("insignificant: the effective acceleration of {:.3g} m/s2 (p95) is below {:g} m/s2", a,
                    t.insignificant));
    return Significance::k_none;
  }
  if (e.own_acceleration && a < t.overwhelmed * *e.own_acceleration) {
    say(fmt::format("insignificant: {:.3g} m/s2 (p95) is overwhelmed by the {:.3g} m/s2 of the primary's own motion", a,
                    *e.own_acceleration));
    return Significance::k_none;
  }
  if (e.displacement && *e.displacement < t.displacement) {
    say(fmt::format("insignificant: {:.3g} m/s2 (p95) last too short to move the primary by {:g} mm", a,
                    1e3 * t.displacement));
    return Significance::k_none;
  }
  if (a < t.significant) {
    say(
        fmt::format("between: an effective acceleration of {:.3g} m/s2 (p95), where below {:g} is not noticed and from "
                    "{:g} on is",
                    a, t.insignificant, t.significant));
    return Significance::k_between;
  }
  say(fmt::format("significant: an effective acceleration of {:.3g} m/s2 (p95), {:.3g} at most", a,
                  e.acceleration_max));
  return Significance::k_full;
}

/// Whether one-way can be baked; says why not.
bool judge_stability(const Evidence& e, const AdviceThresholds& t, std::vector<std::string>& reasons) {
  std::string fault;
  const auto add = [&](const std::string& text) { fault += (fault.empty() ? "" : ", ") + text; };
  if (!e.finite) add("the solver found no finite step");
  if (e.strain_p99 > t.strain)
    add(fmt::format("p99 strain is {:.3g} %, above {:g} %", 100 * e.strain_p99, 100 * t.strain));
  if (e.crossing_frames > 0) add(fmt::format("{} frames with crossings", e.crossing_frames));
  reasons.push_back(fault.empty()
                        ? fmt::format("one-way is stable: p99 strain {:.3g} %, no crossings", 100 * e.strain_p99)
                        : "one-way is unstable: " + fault);
  return fault.empty();
}

/// A stand-in that models the pattern of the force.
bool find_stand_in(const Evidence& e, const AdviceThresholds& t, std::vector<std::string>& reasons) {
  if (e.dissipative_share && *e.dissipative_share >= t.dissipative) {
    reasons.push_back(
        fmt::format("a damping volume models it: the force is against the motion in {:.0f} % of the frames; "
                    "c = {:.3g} kg/s explains {:.0f} % of it",
                    100 * *e.dissipative_share, e.damping, 100 * e.damping_r2));
    return true;
  }
  if (e.upright_share && *e.upright_share >= t.upright) {
    reasons.push_back(
        fmt::format("a grid of vertical springs models it: the force is upright in {:.0f} % of the frames",
                    100 * *e.upright_share));
    return true;
  }
  reasons.push_back("no stand-in models the pattern of the force");
  return false;
}

Coupling choose_significant(const Evidence& e, const AdviceThresholds& t, std::vector<std::string>& reasons) {
  // Two-way inherits the requirements of both; what it adds to a pass over a rigid primary is little.
  if (!e.two_way_possible) {
    reasons.push_back("two-way cannot be baked for it: only cords and rigid props are stepped together");
    if (find_stand_in(e, t, reasons)) return Coupling::k_hybrid;
    reasons.push_back("what comes nearest is hybrid, with the fitted stand-in and an eye on what it leaves out");
    return Coupling::k_hybrid;
  }
  if (e.cycle_seconds <= t.interactive) {
    reasons.push_back(fmt::format("two-way stays interactive: a coarse pass takes {:.2g} s, at most {:g} s",
                                  e.cycle_seconds, t.interactive));
    return Coupling::k_two_way;
  }
  reasons.push_back(fmt::format("two-way is beyond interactive: a coarse pass takes {:.2g} s, more than {:g} s",
                                e.cycle_seconds, t.interactive));
  if (find_stand_in(e, t, reasons)) return Coupling::k_hybrid;
  reasons.push_back("what is left is two-way, with a search for the primary's controls");
  return Coupling::k_two_way;
}

}  // namespace

const char* name(Coupling coupling) {
  switch (coupling) {
    case Coupling::k_one_way: return "one-way";
    case Coupling::k_hybrid: return "hybrid";
    case Coupling::k_two_way: return "two-way";
  }
  return "unknown";
}

std::optional<Context> context_from(const std::string& name) {
  for (const ContextName& c : k_contexts)
    if (name == c.name) return c.context;
  return {};
}

std::vector<std::string> context_names() {
  std::vector<std::string> out;
  for (const ContextName& c : k_contexts) out.emplace_back(c.name);
  return out;
}

std::vector<std::string> Evidence::stand_in_table() const {
  if (!(damping > 0) || place.empty()) return {};
  const Vec3 middle = 0.5 * (place.lo + place.hi), size = place.size();
  return {fmt::format("[standin.{}_field]", secondary),
          "kind = \"damping\"",
          fmt::format("for = \"{}\"", secondary),
          "shape = \"box\"",
          fmt::format("position = [{:.3g}, {:.3g}, {:.3g}]", middle.x(), middle.y(), middle.z()),
          fmt::format("size = [{:.3g}, {:.3g}, {:.3g}]", size.x(), size.y(), size.z()),
          fmt::format("damping = {:.3g}", damping)};
}

Advice advise(const Evidence& e, Context context, const AdviceThresholds& t) {
  Advice out;
  const Significance significance = judge_significance(e, context, t, out.reasons);
  if (e.displacement && e.frames > 0)
    out.reasons.push_back(fmt::format("the forces would move the primary by {:.3g} mm within half a second of contact",
                                      1e3 * *e.displacement));
  const bool stable = judge_stability(e, t, out.reasons);
  const Coupling unnoticed = stable ? Coupling::k_one_way : Coupling::k_hybrid;
  if (significance == Significance::k_none) {
    out.coupling = unnoticed;
    return out;
  }
  out.coupling = choose_significant(e, t, out.reasons);
  if (significance == Significance::k_between && unnoticed != out.coupling) out.also = unnoticed;
  return out;
}

Json to_json(const Evidence& e, const Advice& a) {
  const auto number = [](const std::optional<double>& v) { return v ? Json(*v) : Json(nullptr); };
  return Json{{"primary", e.primary},
              {"secondary", e.secondary},
              {"coupling", name(a.coupling)},
              {"also", a.also ? Json(name(*a.also)) : Json(nullptr)},
              {"reasons", a.reasons},
              {"evidence",
               {{"frames_with_contact", e.frames},
                {"mass_known", e.mass_known},
                {"effective_acceleration",
                 {{"p95", e.acceleration_p95}, {"mean", e.acceleration_mean}, {"max", e.acceleration_max}}},
                {"own_acceleration", number(e.own_acceleration)},
                {"displacement", number(e.displacement)},
                {"velocity_change", number(e.velocity_change)},
                {"strain_p99", e.strain_p99},
                {"frames_with_crossings", e.crossing_frames},
                {"frames_with_released", e.released_frames},
                {"finite", e.finite},
                {"cycle_seconds", e.cycle_seconds},
                {"dissipative_share", number(e.dissipative_share)},
                {"upright_share", number(e.upright_share)},
                {"two_way_possible", e.two_way_possible},
                {"damping", {{"c", e.damping}, {"r2", e.damping_r2}}}}}};
}

Json to_json(const AdviceThresholds& t) {
  return Json{{"insignificant", t.insignificant},
              {"significant", t.significant},
              {"overwhelmed", t.overwhelmed},
              {"displacement", t.displacement},
              {"strain", t.strain},
              {"dissipative", t.dissipative},
              {"upright", t.upright},
              {"interactive", t.interactive}};
}

}  // namespace ft::inline baker
