// What a frame costs as the mesh gets finer: the square of 1 m on a sphere as in the benchmark's scene S1 (the sphere
// swings from frame 10 on instead of 40), the same frames with ever more vertices. For tests/bench/run.sh size.
//   size_bench [--frames N] [CELLS ...]
// A line per size, then the exponent of CPU time against vertices, fitted over all of them. Every frame's cloth is
// checked by the independent checker; 1 is returned when it finds a crossing.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numbers>

#include "tests/support/torture/scene.h"
#include "tests/support/torture/shapes.h"

namespace ft::torture {
namespace {

int cells = 0;  ///< along a side of the square; a Scene makes its setup without arguments

ClothSetup square_on_sphere() {
  Shape ball;
  make_sphere(0.25, 32, 64, ball.points, ball.triangles);
  RigidParts body;
  body.add("ball", ball, [](double t) {
    const double swings = std::max(0.0, t - 10 / 24.0);
    return shift({0.3 * std::sin(2 * std::numbers::pi * swings), 0, 0});
  });
  ClothGarment square;
  square.name = "square";
  square.mesh = grid("square", cells, cells, false, [](double s, double t) { return Vec3(s - 0.5, 0.3, t - 0.5); });
  ClothSetup setup;
  setup.primary = body.build();
  setup.preroll_frames = 0;
  setup.garments.push_back(std::move(square));
  return setup;
}

struct Cost {
  double vertices = 0, cpu = 0;
};

/// Slope of log(cpu) over log(vertices), least squares.
double exponent(const std::vector<Cost>& costs) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const double n = static_cast<double>(costs.size());
  for (const Cost& c : costs) {
    const double u = std::log(c.vertices), v = std::log(c.cpu);
    x += u / n, y += v / n, xx += u * u / n, xy += u * v / n;
  }
  return (xy - x * y) / (xx - x * x);
}

int main_of(int argc, char** argv) {
  Scene scene;
  scene.name = "square_on_sphere";
  scene.make = square_on_sphere;
  scene.frames = 30;
  std::vector<int> sizes;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--frames") == 0 && i + 1 < argc)
      scene.frames = std::max(1, std::atoi(argv[++i]));
    else
      sizes.push_back(std::clamp(std::atoi(argv[i]), 4, 2000));
  }
  if (sizes.empty()) sizes = {50, 100, 200, 400};
  std::vector<Cost> costs;
  std::size_t all_crossings = 0;
  for (const int size : sizes) {
    cells = size - 1;
    const Walked walked = walk(scene);
    double cpu = 0, wall = 0, worst = 0;
    std::size_t crossings = 0;
    FrameProfile profile;
    for (const CheckedFrame& f : walked.frames) {
      cpu += f.cpu_seconds / scene.frames;
      wall += f.seconds / scene.frames;
      worst = std::max(worst, f.seconds);
      crossings += f.crossings_body + f.crossings_self;
      profile += f.report.profile;
    }
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    fmt::print("n={} vertices={} cpu={:.4f} wall={:.4f} worst={:.3f} crossings={} rss_mb={}; ms a frame:", size,
               walked.vertex_count, cpu, wall, worst, crossings, usage.ru_maxrss / 1024);
    for (const ProfilePhase& phase : profile_phases())
      fmt::print(" {} {:.0f}", phase.title, 1e3 * profile.*phase.time / scene.frames);
    fmt::print("\n");
    std::fflush(stdout);
    all_crossings += crossings;
    costs.push_back({static_cast<double>(walked.vertex_count), cpu});
  }
  if (costs.size() > 1)
    fmt::print("RESULT scene=size frames={} exponent={:.3f} crossings={}\n", scene.frames, exponent(costs),
               all_crossings);
  return all_crossings > 0 ? 1 : 0;
}

}  // namespace
}  // namespace ft::torture

int main(int argc, char** argv) {
  return ft::torture::main_of(argc, argv);
}
