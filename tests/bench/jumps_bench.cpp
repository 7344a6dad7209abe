// Where the feasible colliders of a shot jump, see tests/support/collider_jumps.h. For tests/bench/run.sh jumps.
//   jumps_bench SHOT.toml [POSES A SECOND] [MILLIMETRES]
// A line per jump, then how many there are and the longest.
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>

#include "baker/systems/cloth/cloth_group.h"
#include "tests/support/collider_jumps.h"

namespace ft {
namespace {

int print_jumps(const char* file, double rate, double least) {
  ShotFaults faults;
  auto inputs = read_inputs(file, {}, std::nullopt, faults);
  if (!inputs) return fmt::print("{}\n", inputs.error().text()), 2;
  auto plan = make_plan(std::move(*inputs), import_primary, {});
  if (!plan) return fmt::print("{}\n", plan.error().text()), 2;
  const Shot& shot = plan->shot();
  const double until = (shot.last_frame - shot.first_frame) / shot.fps;
  for (const auto& any : plan->groups) {
    const auto* cloths = dynamic_cast<const ClothGroup*>(any.get());
    if (!cloths || !cloths->setup.primary) continue;
    const ClothGroup& group = *cloths;
    double longest = 0;
    const auto jumps = test::collider_jumps(*group.setup.primary, group.setup.feasible, 0, until, rate, least);
    for (const test::ColliderJump& jump : jumps) {
      longest = std::max(longest, jump.length);
      fmt::print("{:.4f} s: vertex {} of {} by {:.1f} mm ({:.1f} -> {:.1f} mm from where it is drawn)\n", jump.time,
                 jump.vertex, group.setup.primary->surface().parts[at(jump.part)].name, 1e3 * jump.length,
                 1e3 * jump.before, 1e3 * jump.after);
    }
    fmt::print("RESULT scene=jumps body=\"{}\" rate={} jumps={} longest_mm={:.1f}\n",
               plan->primaries[group.primary].name, rate, jumps.size(), 1e3 * longest);
  }
  return 0;
}

}  // namespace
}  // namespace ft

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "--import-child") == 0) return ft::import_child_main(argc, argv);
  if (argc < 2) return fmt::print("usage: jumps_bench SHOT.toml [POSES A SECOND] [MILLIMETRES]\n"), 2;
  const double rate = argc > 2 ? std::atof(argv[2]) : 500, millimetres = argc > 3 ? std::atof(argv[3]) : 4;
  if (!(rate > 0) || !(millimetres > 0)) return fmt::print("poses a second and millimetres are numbers above 0\n"), 2;
  return ft::print_jumps(argv[1], rate, 1e-3 * millimetres);
}
