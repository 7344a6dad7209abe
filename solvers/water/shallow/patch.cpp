// See patch.h.
#include "solvers/water/shallow/patch.h"

#include <algorithm>
#include <cmath>

namespace ft::inline solvers {

void CellBox::include(const CellBox& o) {
  if (o.empty()) return;
  if (empty()) {
    *this = o;
    return;
  }
  i0 = std::min(i0, o.i0), k0 = std::min(k0, o.k0), i1 = std::max(i1, o.i1), k1 = std::max(k1, o.k1);
}

CellBox CellBox::inside(int nx, int nz, int margin) const {
  if (empty()) return {};
  return {std::max(0, i0 - margin), std::max(0, k0 - margin), std::min(nx, i1 + margin), std::min(nz, k1 + margin)};
}

void Patch::begin(const Flow& whole, const CellBox& box, bool alone) {
  const int nx = box.i1 - box.i0, nz = box.k1 - box.k0;
  if (flow.nx != nx || flow.nz != nz || flow.cell != whole.cell) flow = Flow(nx, nz, whole.cell);
  flow.x0 = whole.x0 + box.i0, flow.z0 = whole.z0 + box.k0;
  box_ = box;
  flow.sides = {box.i0 == 0 ? whole.sides[0] : FlowSide::k_held, box.i1 == whole.nx ? whole.sides[1] : FlowSide::k_held,
                box.k0 == 0 ? whole.sides[2] : FlowSide::k_held,
                box.k1 == whole.nz ? whole.sides[3] : FlowSide::k_held};
  const int g = Flow::k_ghosts;
  const auto take = [&](const std::vector<double>& from, std::vector<double>& to) {
    for (int k = -g; k <= nz + g; ++k) {
      const double* row = from.data() + whole.of(box.i0 - g, box.k0 + k);
      std::copy(row, row + nx + 2 * g + 1, to.data() + flow.of(-g, k));
    }
  };
  take(whole.bed, flow.bed);
  take(whole.bed_x, flow.bed_x);
  take(whole.bed_z, flow.bed_z);
  take(whole.edge, flow.edge);
  take(whole.lift, flow.lift);
  take(alone ? whole.h : whole.h1, flow.h);
  take(alone ? whole.u : whole.u1, flow.u);
  take(alone ? whole.w : whole.w1, flow.w);
  take(alone ? whole.qx : whole.qx1, flow.qx);
  take(alone ? whole.qz : whole.qz1, flow.qz);
  ghost_cells_.clear(), ghost_u_.clear(), ghost_w_.clear();
  const auto held = [&](int side) { return flow.sides[at(side)] == FlowSide::k_held; };
  for (int k = -g; k <= nz + g; ++k)
    for (int i = -g; i <= nx + g; ++i) {
      const bool rim_x = i <= 0 || i >= nx, rim_z = k <= 0 || k >= nz;
      if (!rim_x && !rim_z) continue;
      const Pair pair{flow.of(i, k), whole.of(box.i0 + i, box.k0 + k)};
      const bool x = (i < 0 && held(0)) || (i >= nx && held(1)), z = (k < 0 && held(2)) || (k >= nz && held(3));
      if (x || z) ghost_cells_.push_back(pair);
      if (x || z || (i == 0 && held(0))) ghost_u_.push_back(pair);
      if (x || z || (k == 0 && held(2))) ghost_w_.push_back(pair);
    }
}

void Patch::rim(const Flow& whole, const CellBox& box, double dt) {
  for (auto& side : rim_) side.clear();
  for (int k = box.k0; k < box.k1; ++k) {
    rim_[0].push_back(box.i0 > 0 ? passed_flux(whole, whole.of(box.i0, k), true, dt) : 0.0);
    rim_[1].push_back(box.i1 < whole.nx ? passed_flux(whole, whole.of(box.i1, k), true, dt) : 0.0);
  }
  for (int i = box.i0; i < box.i1; ++i) {
    rim_[2].push_back(box.k0 > 0 ? passed_flux(whole, whole.of(i, box.k0), false, dt) : 0.0);
    rim_[3].push_back(box.k1 < whole.nz ? passed_flux(whole, whole.of(i, box.k1), false, dt) : 0.0);
  }
}

double Patch::outflow_beside(const Flow& whole, const CellBox& box, double dt) {
  double all = step_outflow(whole, dt), in_box = 0;
  // The box's own share of it is what its patch says; the whole's idea of that is taken away again.
  const auto add = [&](std::size_t c, bool along_x, double outwards) {
    const double q = (along_x ? whole.qx1 : whole.qz1)[c];
    in_box += outwards * (q * outwards > 0 ? passed_flux(whole, c, along_x, dt) : q);
  };
  if (box.empty()) return all;
  for (int k = box.k0; k < box.k1; ++k) {
    if (box.i0 == 0 && whole.sides[0] == FlowSide::k_open) add(whole.of(0, k), true, -1);
    if (box.i1 == whole.nx && whole.sides[1] == FlowSide::k_open) add(whole.of(whole.nx, k), true, 1);
  }
  for (int i = box.i0; i < box.i1; ++i) {
    if (box.k0 == 0 && whole.sides[2] == FlowSide::k_open) add(whole.of(i, 0), false, -1);
    if (box.k1 == whole.nz && whole.sides[3] == FlowSide::k_open) add(whole.of(i, whole.nz), false, 1);
  }
  return all - in_box * whole.cell * dt;
}

void Patch::set_ghosts(const Flow& whole, double share) {
  const auto set = [&](const std::vector<Pair>& pairs, std::vector<double>& to, const std::vector<double>& from,
                       const std::vector<double>& start) {
    for (const Pair& p : pairs) to[p.here] = (1 - share) * start[p.there] + share * from[p.there];
  };
  set(ghost_cells_, flow.h, whole.h, whole.h1);
  set(ghost_u_, flow.u, whole.u, whole.u1);
  set(ghost_w_, flow.w, whole.w, whole.w1);
  set(ghost_u_, flow.qx, whole.qx, whole.qx1);
  set(ghost_w_, flow.qz, whole.qz, whole.qz1);
}

void Patch::hold_rim(const Flow& whole, double share) {
  const auto hold = [&](int side, int n, std::size_t here, std::size_t there, bool along_x) {
    if (flow.sides[at(side)] != FlowSide::k_held) return;
    const std::vector<double>&start = along_x ? whole.u1 : whole.w1, &end = along_x ? whole.u : whole.w;
    (along_x ? flow.u1 : flow.w1)[here] = (1 - share) * start[there] + share * end[there];
    (along_x ? flow.qx1 : flow.qz1)[here] = rim_[side][at(n)];
  };
  for (int k = 0; k < flow.nz; ++k) {
    hold(0, k, flow.of(0, k), whole.of(box_.i0, box_.k0 + k), true);
    hold(1, k, flow.of(flow.nx, k), whole.of(box_.i1, box_.k0 + k), true);
  }
  for (int i = 0; i < flow.nx; ++i) {
    hold(2, i, flow.of(i, 0), whole.of(box_.i0 + i, box_.k0), false);
    hold(3, i, flow.of(i, flow.nz), whole.of(box_.i0 + i, box_.k1), false);
  }
}

void Patch::keep_owed(double dt, double left) {
  const auto held = [&](int side) { return flow.sides[at(side)] == FlowSide::k_held; };
  const auto cut = [&](int i, int k) {
    const std::size_t c = flow.of(i, k);
    double owed = 0, inwards = 0;
    struct Face {
      double* q;
      double outwards;
      bool rim;
    };
    const Face faces[4] = {{&flow.qx1[c], -1, i == 0 && held(0)},
                           {&flow.qx1[c + 1], 1, i + 1 == flow.nx && held(1)},
                           {&flow.qz1[c], -1, k == 0 && held(2)},
                           {&flow.qz1[c + flow.row], 1, k + 1 == flow.nz && held(3)}};
    for (const Face& f : faces) (f.rim ? owed : inwards) += std::max(0.0, *f.q * f.outwards);
    const double allowed = std::max(0.0, (flow.h[c] - left / flow.cell * owed) * flow.cell / dt) * (1 - 1e-12);
    if (owed <= 0 || inwards <= allowed) return;
    for (const Face& f : faces)
      if (!f.rim && *f.q * f.outwards > 0) *f.q *= allowed / inwards;
  };
  for (int k = 0; k < flow.nz; ++k) {
    if (held(0)) cut(0, k);
    if (held(1) && flow.nx > 1) cut(flow.nx - 1, k);
  }
  for (int i = 0; i < flow.nx; ++i) {
    if (held(2)) cut(i, 0);
    if (held(3) && flow.nz > 1) cut(i, flow.nz - 1);
  }
}

double Patch::rim_speed(double gravity, int width) const {
  double most = 0;
  const auto held = [&](int side) { return flow.sides[at(side)] == FlowSide::k_held; };
  const auto look = [&](int i0, int i1, int k0, int k1) {
    for (int k = std::max(0, k0); k < std::min(flow.nz, k1); ++k)
      for (int i = std::max(0, i0); i < std::min(flow.nx, i1); ++i) {
        const std::size_t c = flow.of(i, k);
        most = std::max(most, std::max(std::abs(flow.u[c]), std::abs(flow.w[c])) +
                                  k_wave_share * std::sqrt(gravity * std::max(0.0, flow.h[c])));
      }
  };
  if (held(0)) look(0, width, 0, flow.nz);
  if (held(1)) look(flow.nx - width, flow.nx, 0, flow.nz);
  if (held(2)) look(0, flow.nx, 0, width);
  if (held(3)) look(0, flow.nx, flow.nz - width, flow.nz);
  return most;
}

void Patch::end(Flow& whole) const {
  const auto give = [&](const std::vector<double>& from, std::vector<double>& to, int more_x, int more_z) {
    for (int k = 0; k < flow.nz + more_z; ++k) {
      const double* row = from.data() + flow.of(0, k);
      std::copy(row, row + flow.nx + more_x, to.data() + whole.of(box_.i0, box_.k0 + k));
    }
  };
  give(flow.h, whole.h, 0, 0);
  give(flow.lift, whole.lift, 0, 0);
  give(flow.u, whole.u, 1, 0);
  give(flow.w, whole.w, 0, 1);
  give(flow.qx, whole.qx, 1, 0);
  give(flow.qz, whole.qz, 0, 1);
  fill_ghosts(whole, whole.h, -1);
  fill_ghosts(whole, whole.u, 0);
  fill_ghosts(whole, whole.w, 1);
  fill_ghosts(whole, whole.qx, 0);
  fill_ghosts(whole, whole.qz, 1);
}

}  // namespace ft::inline solvers
