#include "baker/plan/start_report.h"

#include <fmt/format.h>

#include <cmath>

#include "baker/plan/plan.h"

namespace ft::inline baker {
namespace {

std::string what_text(const BadStart& b) {
  if (!b.is_primary)
    return fmt::format("starts with {} crossings with {}", b.crossings,
                       b.cloth == b.other ? "itself" : "cloth \"" + b.other + "\"");
  std::string out = fmt::format("starts with {} crossings with \"{}\"", b.crossings, b.other);
  if (b.inside > 0) out += fmt::format(", {} vertices up to {:.1f} mm inside", b.inside, 1e3 * b.depth);
  return out;
}

}  // namespace

StartReport find_start(const BakePlan& plan) {
  StartReport out;
  out.preroll = plan.shot().preroll;
  out.fps = plan.shot().fps;
  for (const auto& group : plan.groups) group->add_start(plan, out);
  return out;
}

std::vector<std::string> start_lines(const StartReport& report) {
  std::vector<std::string> out;
  for (const BadStart& b : report.bad)
    out.push_back(fmt::format("cloth \"{}\" {} (vertex {} at ({:.3f}, {:.3f}, {:.3f}))", b.cloth, what_text(b),
                              b.vertex, b.place.x(), b.place.y(), b.place.z()));
  if (out.empty()) return out;
  if (report.preroll > 0)
    out.push_back(
        fmt::format("the {} frames of pre-roll are there to take out what starts through the body; what starts through "
                    "cloth is taken apart before them, in up to two seconds in which the body stands still",
                    report.preroll));
  else
    out.push_back(
        fmt::format("there is no pre-roll in which that could be sorted out: give the shot one (preroll = {} under "
                    "[shot]), in which the garment goes from its place on the bind pose into the first frame",
                    std::lround(report.fps)));
  return out;
}

}  // namespace ft::inline baker
