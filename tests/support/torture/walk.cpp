// Walks a torture scene and has the independent checker look at every frame. See scene.h.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "tests/support/exact_crossings.h"
#include "tests/support/torture/scene.h"

namespace ft::torture {
namespace {

double cpu_clock() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double cloth_mass(const ClothSetup& setup) {
  double mass = 0;
  for (const ClothGarment& g : setup.garments)
    for (const Triangle& t : triangulate(g.mesh))
      mass += g.fabric.mass_per_area *
              triangle_area(g.mesh.positions[at(t[0])], g.mesh.positions[at(t[1])], g.mesh.positions[at(t[2])]);
  return mass;
}

void check(const Solver& solver, const State& state, const AllCloth& cloth, CheckedFrame& frame) {
  std::vector<Vec3> body;
  solver.collider_positions(state, body);
  frame.crossings_self = exact_own_crossings(cloth.positions, cloth.triangles).size();
  frame.crossings_body = 0;
  // A garment does not meet what is absent for it.
  int first = 0;
  for (int s = 0; s < solver.system_count(); ++s) {
    const int end = first + solver.system_mesh(s).vertex_count();
    std::vector<Triangle> own, shell;
    for (const Triangle& t : cloth.triangles)
      if (t[0] >= first && t[0] < end) own.push_back(t);
    const std::vector<char> absent = solver.collider_absent(state, s);
    const auto is_absent = [&](int b) { return !absent.empty() && absent[at(b)] != 0; };
    for (const Triangle& t : solver.collider_triangles())
      if (std::none_of(t.begin(), t.end(), is_absent)) shell.push_back(t);
    frame.crossings_body += exact_crossings(cloth.positions, own, body, shell).size() +
                            exact_crossings(body, shell, cloth.positions, own).size();
    first = end;
  }
}

}  // namespace

AllCloth all_cloth(const Solver& solver, const State& state) {
  AllCloth out;
  for (int s = 0; s < solver.system_count(); ++s) {
    const Mesh& mesh = solver.system_mesh(s);
    const int first = static_cast<int>(out.positions.size());
    out.positions.resize(out.positions.size() + mesh.positions.size());
    solver.system_positions(state, s, std::span(out.positions).subspan(at(first)));
    for (const Triangle& t : triangulate(mesh)) out.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return out;
}

Walked walk(const Scene& scene, const Look& look, const std::function<void(ClothSetup&)>& change) {
  ClothSetup setup = scene.make();
  if (change) change(setup);
  const double mass = cloth_mass(setup);
  auto made = make_cloth_solver(setup);
  CHECK(made.ok());
  Solver& solver = **made;
  State state = solver.initial_state();
  Walked out;
  AllCloth cloth = all_cloth(solver, state);
  out.vertex_count = static_cast<int>(cloth.positions.size());
  out.triangle_count = static_cast<int>(cloth.triangles.size());
  check(solver, state, cloth, out.start);
  if (look) look(solver, state, out.start);
  for (int f = 0; f < scene.frames; ++f) {
    CheckedFrame frame;
    const auto wall = std::chrono::steady_clock::now();
    const double cpu = cpu_clock();
    frame.report = solver.advance_frame(state);
    frame.cpu_seconds = cpu_clock() - cpu;
    frame.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
    frame.speed = std::sqrt(2 * frame.report.kinetic_energy / mass);
    cloth = all_cloth(solver, state);
    frame.report.finite = frame.report.finite && all_finite(cloth.positions);
    if (all_finite(cloth.positions)) check(solver, state, cloth, frame);
    if (look) look(solver, state, frame);
    out.frames.push_back(std::move(frame));
  }
  return out;
}

}  // namespace ft::torture
