// Linear solvers on the systems of a cloth step: a square metre of cotton, two corners held, sagging and wrinkled, 8
// substeps per frame at 24 fps. Prints for each size and tolerance the iterations and the time of a solve, set-up of
// the preconditioner included.
//   linear_bench [threads [cells]]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "baker/core/parallel.h"
#include "solvers/energies/registry.h"
#include "solvers/linear/linear_system.h"
#include "tests/support/scripted_body.h"

using namespace ft;

namespace {

struct System {
  std::vector<Vec3> rest, x, right_side;
  std::vector<char> fixed;
  ClothTopology topology;
  std::vector<std::unique_ptr<Energy>> energies;
  BlockPattern pattern;
  double inertia = 0;

  explicit System(int cells) {
    const Mesh sheet = make_sheet(1, cells, 0);
    rest = x = sheet.positions;
    for (Vec3& p : x) {
      const Vec3 q = p;
      p.y() = -0.3 * std::cos(3 * q.x()) * (0.5 - q.z()) + 0.006 * std::sin(40 * q.x() + 9 * q.z());
      p.x() *= 0.97;
    }
    fixed.assign(x.size(), 0);
    fixed[0] = fixed[static_cast<std::size_t>(cells)] = 1;
    const Fabric* cotton = find_fabric("cotton");
    const ClothPiece piece{0, sheet.vertex_count(), *cotton};
    topology = make_cloth_topology(rest, triangulate(sheet), std::span(&piece, 1));
    energies = make_cloth_energies(topology, {});
    std::vector<std::vector<std::array<int, 4>>> stencils;
    for (const auto& energy : energies) stencils.push_back(energy->stencils());
    pattern = make_pattern(sheet.vertex_count(), stencils);
    const double step = 2.0 / 3 / (24 * 8);
    inertia = 1 / (step * step);
    std::vector<Vec3> still(x.size(), Vec3::Zero());
    StepContext context;
    context.h = 1.0 / (24 * 8);
    context.beta_h = step;
    context.x_t0 = x;
    context.v_t0 = still;
    for (const auto& energy : energies) energy->begin_step(context);
    right_side.assign(x.size(), Vec3::Zero());
    for (const auto& energy : energies) energy->add_gradient(x, right_side);
    for (std::size_t i = 0; i < x.size(); ++i)
      right_side[i] = -right_side[i] + topology.mass[i] * Vec3(0, -k_gravity, 0);
  }

  void fill(BlockMatrix& m) const {
    for (std::size_t i = 0; i < x.size(); ++i)
      m.blocks[static_cast<std::size_t>(pattern.diagonal[i])].diagonal().array() +=
          static_cast<float>(topology.mass[i] * inertia);
    for (const auto& energy : energies) energy->add_hessian(x, m);
  }
};

}  // namespace

int main(int argc, char** argv) {
  const ThreadLimit threads(argc > 1 ? std::atoi(argv[1]) : 1);
  std::printf("| N | preconditioner | tolerance | iterations | ms |\n|---|---|---|---|---|\n");
  for (const int cells : {50, 100, 200}) {
    if (argc > 2 && std::atoi(argv[2]) != cells) continue;
    const System system(cells);
    for (const auto kind :
         {LinearSettings::Preconditioner::k_block_jacobi, LinearSettings::Preconditioner::k_multigrid})
      for (const double tolerance : {1e-1, 3e-2, 1e-2, 1e-3}) {
        LinearSystem solver(system.pattern, system.rest, {kind, tolerance, 2000});
        std::vector<Vec3> solution(system.x.size());
        std::vector<double> times;
        LinearReport report;
        for (int k = 0; k < 15; ++k) {
          system.fill(solver.begin());
          solver.add_pair_terms({});
          const auto start = std::chrono::steady_clock::now();
          report = solver.solve(system.right_side, system.fixed, solution);
          times.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        }
        std::sort(times.begin(), times.end());
        std::printf("| %d | %s | %g | %d%s | %.2f |\n", cells,
                    kind == LinearSettings::Preconditioner::k_multigrid ? "multigrid" : "block Jacobi", tolerance,
                    report.iterations, report.converged ? "" : " (not reached)", 1e3 * times[7]);
      }
  }
}
