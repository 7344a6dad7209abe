// The same water in each of its models, for tests of what they share.
#pragma once

#include "solvers/water/paper/paper_core.h"
#include "solvers/water/pond/pond_core.h"
#include "solvers/water/shallow/shallow_core.h"
#include "tests/solvers/water_scenes.h"

namespace ft::test {

/// 2 x 2 m of water about the origin, its surface at y = 0.
inline std::unique_ptr<WaterCore> water_of(const std::string& model, std::vector<PlacedFloat> floats, double depth,
                                           bool splash) {
  if (model == "pond") {
    PondSetup s;
    s.corner = Vec3(-1, 0, -1);
    s.size_x = s.size_z = 2, s.nx = s.nz = 32, s.depth = depth, s.gravity = k_g;
    s.splash.on = splash;
    for (PlacedFloat& f : floats) s.floats.push_back({f.body, f.start, 0.3});
    return std::move(pond_core(s)).value();
  }
  const auto fill = [&](auto& s) {
    s.origin = Vec2(-1, -1), s.nx = s.nz = 40, s.cell = 0.05, s.gravity = k_g;
    s.bed.assign(1600, -depth), s.level = 0;
    s.floats = floats;
    s.splash.on = splash;
  };
  if (model == "paper") {
    PaperSetup s;
    fill(s);
    return std::move(paper_core(s)).value();
  }
  ShallowSetup s;
  fill(s);
  return std::move(shallow_core(s)).value();
}

/// Of that water, in the axes of its state.
inline Vec3 middle_of(const std::string& model) {
  return model == "pond" ? Vec3(1, 0, 1) : Vec3(0, 0, 0);
}

}  // namespace ft::test
