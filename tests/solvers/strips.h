// Strips of cloth in vacuum that are buttoned or zipped to each other: for the tests of attachments.
#pragma once

#include <gtest/gtest.h>

#include "solvers/cloth/model/attach.h"
#include "solvers/cloth/model/cloth_model.h"
#include "solvers/validation/scene_parts.h"

namespace ft {

inline constexpr int k_columns = 3, k_rows = 9;  ///< of a strip
inline constexpr int k_strip = (k_columns + 1) * (k_rows + 1);

/// 6 x 18 cm in the plane z, from (x, y) to the right and down [m]; vertex (i, j) is i + 4 j.
inline ClothGarment strip(const char* name, double x, double y, double z = 0) {
  ClothGarment out;
  out.name = name;
  out.mesh = rectangle_mesh(k_columns, k_rows, [=](double s, double t) { return Vec3(x + 0.06 * s, y - 0.18 * t, z); });
  return out;
}

inline ClothPin pin_of(std::vector<int> vertices, int to = -1) {
  ClothPin pin;
  pin.vertices = std::move(vertices);
  pin.to = to;
  return pin;
}

inline ClothSetup in_vacuum(std::vector<ClothGarment> garments) {
  ClothSetup setup;
  setup.first_frame = 0;
  setup.preroll_frames = 0;
  setup.air_density = 0;
  setup.garments = std::move(garments);
  return setup;
}

inline std::unique_ptr<ClothModel> model_of(const ClothSetup& setup) {
  auto model = build_cloth_model(setup);
  EXPECT_TRUE(model) << (model ? "" : model.error().text());
  return std::move(*model);
}

inline std::vector<State> states_of(const ClothSetup& setup, int frames) {
  auto solver = make_cloth_solver(setup);
  EXPECT_TRUE(solver) << (solver ? "" : solver.error().text());
  std::vector<State> out = {(*solver)->initial_state()};
  for (int f = 0; f < frames; ++f) {
    out.push_back(out.back());
    const FrameReport report = (*solver)->advance_frame(out.back());
    EXPECT_EQ(report.crossings_self, 0) << f;
  }
  return out;
}

/// From what a cord hangs on to what hangs on it [m].
inline Vec3 cord(const AttachPoint& p, std::span<const Vec3> x) {
  Vec3 d = x[at(p.vertex)];
  for (std::size_t k = 0; k < 3; ++k) d -= p.weight[k] * x[at(p.triangle[k])];
  return d;
}

}  // namespace ft
