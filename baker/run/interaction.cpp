#include "baker/run/interaction.h"

#include <fmt/format.h>

#include <algorithm>

#include "io/shot/shot_values.h"
#include "io/shot/words.h"

namespace ft::inline baker {
namespace {

/// Gathers one row.
class Sum {
 public:
  void add(const Vec3& force, const Vec3& torque, double peak) {
    force_.push_back(force.norm());
    torque_.push_back(torque.norm());
    impulse_ += force;
    peak_ = std::max(peak_, peak);
  }
  Interaction row(std::string primary, std::string secondary, double mass, double frame_time) const {
    Interaction out;
    out.primary = std::move(primary);
    out.secondary = std::move(secondary);
    out.frames = static_cast<int>(force_.size());
    out.force = spread(force_, 1);
    out.torque = spread(torque_, 1);
    if (mass > 0) out.acceleration = spread(force_, 1 / mass);
    out.peak = peak_;
    out.impulse = frame_time * impulse_;
    return out;
  }

 private:
  static Spread spread(const std::vector<double>& values, double factor) {
    if (values.empty()) return {};
    Spread out{std::numeric_limits<double>::infinity(), 0, 0};
    for (const double v : values) {
      out.min = std::min(out.min, factor * v);
      out.max = std::max(out.max, factor * v);
      out.mean += factor * v / static_cast<double>(values.size());
    }
    return out;
  }
  std::vector<double> force_, torque_;
  Vec3 impulse_ = Vec3::Zero();
  double peak_ = 0;
};

Json to_json(const Spread& s) {
  return Json{{"min", s.min}, {"mean", s.mean}, {"max", s.max}};
}

/// Those that are on a primary, and those that meet it, in the manifest's order.
std::vector<std::string> secondaries_of(const Manifest& manifest, const std::string& primary) {
  std::vector<std::string> out;
  for (const ManifestSystem& s : manifest.systems) {
    if (!is_secondary(s.role)) continue;
    const auto is_met = [&](const FrameReport& frame) {
      return std::any_of(frame.forces.begin(), frame.forces.end(),
                         [&](const InteractionForce& f) { return f.system == s.name && f.primary == primary; });
    };
    if (s.primary == primary || std::any_of(manifest.frames.begin(), manifest.frames.end(), is_met))
      out.push_back(s.name);
  }
  return out;
}

}  // namespace

std::vector<Interaction> interactions(const Manifest& manifest, const std::vector<PrimaryPlan>& primaries) {
  std::vector<Interaction> out;
  const double frame_time = 1 / manifest.fps;
  for (const PrimaryPlan& primary : primaries) {
    const std::vector<std::string> secondaries = secondaries_of(manifest, primary.name);
    const auto is_own = [&](const std::string& secondary) {
      return std::any_of(manifest.systems.begin(), manifest.systems.end(),
                         [&](const ManifestSystem& s) { return s.name == secondary && s.primary == primary.name; });
    };
    std::vector<Sum> sums(secondaries.size());
    std::vector<char> measured(secondaries.size(), 0);
    Sum together;
    for (const FrameReport& frame : manifest.frames) {
      if (frame.frame < manifest.first_written) continue;
      Wrench all;
      double peak = 0;
      bool any = false;
      for (const InteractionForce& f : frame.forces) {
        const auto own = std::find(secondaries.begin(), secondaries.end(), f.system);
        if (own == secondaries.end() || (f.primary.empty() ? !is_own(f.system) : f.primary != primary.name)) continue;
        measured[static_cast<std::size_t>(own - secondaries.begin())] = 1;
        if (f.contact_share <= 0) continue;
        sums[static_cast<std::size_t>(own - secondaries.begin())].add(f.mean.force, f.mean.torque, f.peak);
        all += f.mean;
        peak += f.peak;
        any = true;
      }
      if (any) together.add(all.force, all.torque, peak);
    }
    for (std::size_t s = 0; s < sums.size(); ++s) {
      out.push_back(sums[s].row(primary.name, secondaries[s], primary.mass.kilograms, frame_time));
      out.back().measured = measured[s] != 0;
    }
    if (sums.size() > 1) out.push_back(together.row(primary.name, {}, primary.mass.kilograms, frame_time));
  }
  return out;
}

std::vector<std::string> interaction_lines(const std::vector<Interaction>& interactions,
                                           const std::vector<PrimaryPlan>& primaries) {
  std::vector<std::string> out;
  for (const PrimaryPlan& primary : primaries) {
    const auto touches = [&](const Interaction& i) { return i.primary == primary.name && i.frames > 0; };
    if (std::none_of(interactions.begin(), interactions.end(), touches)) continue;
    out.push_back(fmt::format("forces on \"{}\" ({}), min / mean / max of the frames with contact:", primary.name,
                              primary.mass.text()));
    for (const Interaction& i : interactions) {
      if (!touches(i)) continue;
      const auto text = [](const Spread& s, const char* unit) {
        return fmt::format("{:.3g} / {:.3g} / {:.3g} {}", s.min, s.mean, s.max, unit);
      };
      out.push_back(fmt::format("  {:<16} {:>5} frames  {}  (peak {:.3g} N)  {}{}",
                                i.secondary.empty() ? "all together" : i.secondary, i.frames, text(i.force, "N"),
                                i.peak, text(i.torque, "N m"),
                                primary.mass.kilograms > 0 ? "  a = " + text(i.acceleration, "m/s2") : ""));
    }
  }
  for (std::string& line : untouched_lines(interactions)) out.push_back(std::move(line));
  return out;
}

std::vector<std::string> untouched_lines(const std::vector<Interaction>& interactions) {
  std::vector<std::string> out, told;
  for (const Interaction& i : interactions) {
    if (i.secondary.empty() || std::find(told.begin(), told.end(), i.secondary) != told.end()) continue;
    told.push_back(i.secondary);
    std::vector<std::string> primaries;
    bool touches = false;
    for (const Interaction& other : interactions) {
      if (other.secondary != i.secondary || !other.measured) continue;
      primaries.push_back(in_quotes(other.primary));
      touches = touches || other.frames > 0;
    }
    if (touches || primaries.empty()) continue;
    out.push_back(fmt::format("\"{}\" touches nothing in any frame: is it where {} {}?", i.secondary, joined(primaries),
                              primaries.size() > 1 ? "are" : "is"));
  }
  return out;
}

Json to_json(const std::vector<Interaction>& interactions, const std::vector<PrimaryPlan>& primaries) {
  Json masses = Json::object();
  for (const PrimaryPlan& p : primaries)
    masses[p.name] = {{"kilograms", p.mass.kilograms > 0 ? Json(p.mass.kilograms) : Json(nullptr)},
                      {"from", p.mass.text()}};
  Json rows = Json::array();
  for (const Interaction& i : interactions)
    rows.push_back({{"primary", i.primary},
                    {"secondary", i.secondary.empty() ? Json(nullptr) : Json(i.secondary)},
                    {"frames", i.frames},
                    {"force", to_json(i.force)},
                    {"torque", to_json(i.torque)},
                    {"effective_acceleration", to_json(i.acceleration)},
                    {"peak", i.peak},
                    {"impulse", {i.impulse.x(), i.impulse.y(), i.impulse.z()}}});
  return Json{{"masses", std::move(masses)}, {"rows", std::move(rows)}};
}

}  // namespace ft::inline baker
