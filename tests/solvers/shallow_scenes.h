// Shallow water to test: rectangles of water without friction or splash, unless a test wants them.
#pragma once

#include <gtest/gtest.h>

#include "solvers/water/shallow/shallow_solver.h"
#include "tests/solvers/water_scenes.h"

namespace ft::test {

inline ShallowSetup still_water(int nx, int nz, double cell, double level) {
  ShallowSetup s;
  s.nx = nx, s.nz = nz, s.cell = cell, s.level = level;
  s.gravity = k_g;
  s.manning = s.viscosity = 0;
  s.splash.on = false;
  return s;
}

inline ShallowSolver solver_of(const ShallowSetup& s) {
  auto made = ShallowSolver::make(s);
  EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().text());
  return std::move(made).value();
}

}  // namespace ft::test
