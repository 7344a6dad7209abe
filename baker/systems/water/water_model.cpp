#include "baker/systems/water/water_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "baker/core/types.h"

namespace ft::inline baker {
namespace {

/// The waves that are judged: as long as this, or a quarter of the water's shorter side [m].
constexpr double k_wave = 1;
/// Shallow water may carry them so much too fast [1].
constexpr double k_most_fast = 0.1;
/// Below this depth water has to be able to leave its ground dry [m].
constexpr double k_puddle = 0.05;

}  // namespace

WaterAdvice advise_water(double depth, double along, double across, bool has_bed) {
  WaterAdvice out;
  out.wave = std::min(k_wave, 0.25 * std::min(along, across));
  const double kh = 2 * std::numbers::pi * depth / out.wave;
  out.too_fast = std::sqrt(kh / std::tanh(kh)) - 1;
  const std::string speed =
      fmt::format("shallow water would carry waves of {:.2g} m {:.0f} % too fast at a depth of {:.2g} m", out.wave,
                  100 * out.too_fast, depth);
  if (has_bed) {
    out.model = "shallow";
    out.reason = "its ground is a mesh, which only shallow water knows";
  } else if (depth < k_puddle || out.too_fast < k_most_fast) {
    out.model = "shallow";
    out.reason = depth < k_puddle ? fmt::format("water of {:.3g} cm may leave its ground dry", 100 * depth) : speed;
  } else {
    out.model = "pond";
    out.reason = speed;
  }
  return out;
}

std::string doubt_of_model(const std::string& model, const WaterAdvice& advice, double depth) {
  if (model != "pond" && advice.too_fast >= k_most_fast)
    return fmt::format("waves of {:.2g} m are {:.0f} % too fast in {} of {:.2g} m, and all have one speed", advice.wave,
                       100 * advice.too_fast, model == "paper" ? "the paper's water" : "shallow water", depth);
  if (model == "pond" && depth < k_puddle)
    return fmt::format("a pond never runs dry, and {:.3g} cm of water would", 100 * depth);
  return {};
}

std::vector<std::string> limits_of_model(const std::string& model, std::size_t floats) {
  std::vector<std::string> out;
  const auto note = [&](const char* text) { out.emplace_back(text); };
  if (floats > 1)
    note("what floats in it meets one another as balls or as boxes full of balls, which are round at their corners");
  if (model == "pond") {
    note("its waves are linear and do not break, its ground is even, and drag of bodies pushes no water back");
    return out;
  }
  note("water in whose place a body stands in the first frame is taken away, and booked as outflow");
  note(
      "bodies move it as columns: what hangs over water, such as a breaking wave, is not there; droplets are drawn "
      "by lot");
  if (model != "paper") return out;
  note(
      "water carries no momentum along: a dam that breaks keeps 0.56 of its depth at its place, not 4/9, and its front "
      "is less than half as fast; ground falls dry and is flooded, but run-up and bores are wrong");
  note(
      "bodies press on columns that give a little, drag of bodies pushes no water back, and the momentum of droplets "
      "is "
      "lost where they land");
  return out;
}

}  // namespace ft::inline baker
