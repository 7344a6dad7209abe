// Torture scenes: small, short, and each nasty in one way. One visible list (scenes.cpp) serves the tests
// (tests/torture) and the benchmark (tests/bench/run.sh torture NAME|all). A new scene is a function and a line in the
// list.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "solvers/cloth/cloth_solver.h"

namespace ft::torture {

/// What misses its strain_bar today may strain by so many times as much: beyond that it is torn [1].
constexpr double k_times_strained = 1.25;

struct Scene {
  std::string name;
  std::string what;  ///< one sentence
  ClothSetup (*make)() = nullptr;
  int frames = 24;  ///< 24 a second, no pre-roll: the walk goes from frame 1 to frame 1 + frames
  double strain_bar =
      0.1;  ///< p99 edge strain that no frame may exceed [1]: what this scene's pull stretches cloth to, and not more
  double speed_bar =
      10;  ///< root mean square speed that no frame may exceed [m/s]: twice what drives the scene, and 3 m/s
  bool has_room = true;  ///< false: for some frames there is none, cloth must be let through, named, and come back
  /// What is seen, where today something fails that is then listed and not run by default. Where only strain_bar is
  /// missed, all else is tested, and that strain stays below k_times_strained times it.
  std::string fails_today = {}, strained_today = {};
};

/// All scenes.
std::span<const Scene> scenes();
const Scene* find_scene(std::string_view name);

/// One frame with what the independent checker (tests/support/exact_crossings.h) finds in it.
struct CheckedFrame {
  FrameReport report;
  std::size_t crossings_body = 0, crossings_self = 0;
  double seconds = 0, cpu_seconds = 0;  ///< of the walk alone
  double speed = 0;                     ///< root mean square [m/s]
};

struct Walked {
  CheckedFrame start;  ///< nothing has moved; only its crossings are set
  std::vector<CheckedFrame> frames;
  int vertex_count = 0, triangle_count = 0;
};

/// Every cloth of a state as one surface, in the order of the garments.
struct AllCloth {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
};
AllCloth all_cloth(const Solver& solver, const State& state);

/// Walks a scene and checks every frame. `look` sees every state as soon as it is checked, the start included.
using Look = std::function<void(const Solver&, const State&, const CheckedFrame&)>;
/// `change` may alter the setup first: to find out what a failure depends on.
Walked walk(const Scene& scene, const Look& look = {}, const std::function<void(ClothSetup&)>& change = {});

}  // namespace ft::torture
