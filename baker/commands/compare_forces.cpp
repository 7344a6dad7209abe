#include "baker/commands/compare_forces.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

namespace ft::inline baker {
namespace {

using History = std::map<int, InteractionForce>;

/// System, primary -> frame -> force, of written frames.
std::map<std::pair<std::string, std::string>, History> histories(const Manifest& manifest) {
  std::map<std::pair<std::string, std::string>, History> out;
  for (const FrameReport& frame : manifest.frames) {
    if (frame.frame < manifest.first_written) continue;
    for (const InteractionForce& f : frame.forces) out[{f.system, f.primary}][frame.frame] = f;
  }
  return out;
}

ForceComparison compare(const History& a, const History& b) {
  ForceComparison out;
  for (const auto& [frame, in_a] : a) {
    const auto twin = b.find(frame);
    if (twin == b.end() || in_a.contact_share + twin->second.contact_share <= 0) continue;
    const Vec3 &fa = in_a.mean.force, &fb = twin->second.mean.force;
    out.frames.push_back({frame, fa.norm(), fb.norm(), (fa - fb).norm()});
  }
  for (std::size_t i = 0; i < out.frames.size(); ++i) {
    const ForceDifference& f = out.frames[i];
    out.mean_a += f.a / static_cast<double>(out.frames.size());
    out.mean_b += f.b / static_cast<double>(out.frames.size());
    out.max_a = std::max(out.max_a, f.a);
    out.max_b = std::max(out.max_b, f.b);
    if (out.worst < 0 || f.apart > out.frames[static_cast<std::size_t>(out.worst)].apart)
      out.worst = static_cast<int>(i);
  }
  return out;
}

}  // namespace

std::vector<ForceComparison> compare_forces(const Manifest& a, const Manifest& b) {
  const auto in_a = histories(a), in_b = histories(b);
  std::vector<ForceComparison> out;
  for (const ManifestSystem& s : a.systems) {
    for (const auto& [names, history] : in_a) {
      const auto twin = in_b.find(names);
      if (names.first != s.name || twin == in_b.end()) continue;
      ForceComparison forces = compare(history, twin->second);
      std::tie(forces.system, forces.primary) = names;
      if (forces.worst >= 0) out.push_back(std::move(forces));
    }
  }
  return out;
}

std::string to_text(const std::vector<ForceComparison>& forces) {
  std::string out;
  for (const ForceComparison& c : forces) {
    const ForceDifference& w = c.frames[static_cast<std::size_t>(c.worst)];
    out += fmt::format(
        "force of {}{}: mean {:.4g} N in a, {:.4g} N in b; largest {:.4g} and {:.4g} N; farthest apart in frame {}, by "
        "{:.4g} N\n",
        c.system, c.primary.empty() ? "" : " on " + c.primary, c.mean_a, c.mean_b, c.max_a, c.max_b, w.frame, w.apart);
  }
  return out;
}

Json to_json(const std::vector<ForceComparison>& forces) {
  Json out = Json::array();
  for (const ForceComparison& c : forces) {
    Json frames = Json::array();
    for (const ForceDifference& f : c.frames)
      frames.push_back({{"frame", f.frame}, {"a", f.a}, {"b", f.b}, {"apart", f.apart}});
    out.push_back({{"system", c.system},
                   {"primary", c.primary.empty() ? Json(nullptr) : Json(c.primary)},
                   {"mean_a", c.mean_a},
                   {"mean_b", c.mean_b},
                   {"max_a", c.max_a},
                   {"max_b", c.max_b},
                   {"worst_frame", c.frames[static_cast<std::size_t>(c.worst)].frame},
                   {"frames", std::move(frames)}});
  }
  return out;
}

}  // namespace ft::inline baker
