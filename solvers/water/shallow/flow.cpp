// See flow.h.
#include "solvers/water/shallow/flow.h"

#include <algorithm>
#include <cmath>

namespace ft::inline solvers {

Flow::Flow(int cells_x, int cells_z, double cell_size)
    : nx(cells_x), nz(cells_z), row(at(cells_x + 2 * k_ghosts + 1)), cell(cell_size) {
  const std::size_t n = row * at(nz + 2 * k_ghosts + 1);
  for (auto* v : {&bed, &bed_x, &bed_z, &h, &lift, &u, &w, &h1, &u1, &w1, &qx, &qz, &qx1, &qz1, &edge})
    v->assign(n, 0.0);
}

void fill_ghosts(const Flow& flow, std::vector<double>& values, int face) {
  const int nx = flow.nx, nz = flow.nz, g = Flow::k_ghosts;
  // Along x: cells -1, -2 mirror 0, 1; faces -1 mirrors 1 around the face 0.
  const int last_x = face == 0 ? nx : nx - 1, last_z = face == 1 ? nz : nz - 1;
  for (int side = 0; side < 2; ++side) {
    if (flow.sides[at(side)] == FlowSide::k_held) continue;
    const bool wall = flow.sides[at(side)] == FlowSide::k_wall;
    for (int k = 0; k <= last_z; ++k)
      for (int d = 1; d <= g; ++d) {
        const int to = side == 0 ? -d : last_x + d;
        if (to > nx + g) continue;
        if (face == 0) {
          const int from = std::clamp(side == 0 ? d : last_x - d, 0, nx);
          values[flow.of(to, k)] = wall ? -values[flow.of(from, k)] : values[flow.of(side == 0 ? 0 : nx, k)];
        } else {
          const int from = std::clamp(side == 0 ? d - 1 : last_x - d + 1, 0, last_x);
          values[flow.of(to, k)] = values[flow.of(from, k)];
        }
      }
  }
  for (int side = 2; side < 4; ++side) {
    if (flow.sides[at(side)] == FlowSide::k_held) continue;
    const bool wall = flow.sides[at(side)] == FlowSide::k_wall;
    for (int d = 1; d <= g; ++d) {
      const int to = side == 2 ? -d : last_z + d;
      if (to > nz + g) continue;
      for (int i = -g; i <= nx + g; ++i) {
        if (face == 1) {
          const int from = std::clamp(side == 2 ? d : last_z - d, 0, nz);
          values[flow.of(i, to)] = wall ? -values[flow.of(i, from)] : values[flow.of(i, side == 2 ? 0 : nz)];
        } else {
          const int from = std::clamp(side == 2 ? d - 1 : last_z - d + 1, 0, last_z);
          values[flow.of(i, to)] = values[flow.of(i, from)];
        }
      }
    }
  }
}

void finish_step(Flow& f) {
  f.h.swap(f.h1);
  f.u.swap(f.u1);
  f.w.swap(f.w1);
  f.qx.swap(f.qx1);
  f.qz.swap(f.qz1);
  fill_ghosts(f, f.qx, 0);
  fill_ghosts(f, f.qz, 1);
  fill_ghosts(f, f.h, -1);
  fill_ghosts(f, f.u, 0);
  fill_ghosts(f, f.w, 1);
}

}  // namespace ft::inline solvers
