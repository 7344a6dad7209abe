// The two halves of a step, see flow.h. Tiles are copied into small arrays of fixed size with all their neighbours, so
// that every loop is one long row of simple arithmetic for the vector units, and tiles need nothing of one another.
//
// Momentum (Stelling and Duinmeijer 2003), in conservative form on the staggered grid, for the x face between cells L,
// R: (the fluxes q that brought h to where it is, so that h u is conserved to rounding)
//   du/dt = -[qR (uR - u) - qL (uL - u) + qT (uT - u) - qB (uB - u)] / (h_face dx) - g (head_R - head_L) / dx
// q are means of face fluxes in the cells and at the corners, uL..uB the velocity from upwind, limited by van Leer.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "baker/core/parallel.h"
#include "solvers/water/shallow/flow.h"
#include "solvers/water/shallow/flow_limits.h"

namespace ft::inline solvers {
namespace {

constexpr int k_tile = k_flow_tile;
constexpr int k_cols = k_tile + 8, k_rows = k_tile + 5;  ///< of a copied tile: 3 before, 2 or more behind
constexpr int k_all = k_rows * k_cols;
/// Depths that divide [m].
constexpr double k_thin = 1e-6;

struct alignas(64) Tile {
  double bx[k_all], bz[k_all], h[k_all], eta[k_all], head[k_all], u[k_all], w[k_all];
  double eta_x[k_all], eta_z[k_all], u_x[k_all], u_z[k_all], w_x[k_all], w_z[k_all];  ///< limited differences, halved
  double qx[k_all], qz[k_all];
  double u1[k_all], w1[k_all], qx1[k_all], qz1[k_all], root[k_all];
};

/// Copies the tile whose first cell is (i0, k0); beyond the ghosts the outermost ghost is repeated.
void copy_in(const Flow& f, const std::vector<double>& from, int i0, int k0, double* __restrict to) {
  const int first = -Flow::k_ghosts, last_x = f.nx + Flow::k_ghosts, last_z = f.nz + Flow::k_ghosts;
  const int begin = std::max(i0 - 3, first), end = std::min(i0 - 3 + k_cols, last_x + 1);
  for (int r = 0; r < k_rows; ++r) {
    const double* row = from.data() + f.of(0, std::clamp(k0 - 3 + r, first, last_z));
    double* out = to + r * k_cols;
    for (int i = i0 - 3; i < begin; ++i) out[i - i0 + 3] = row[begin];
    std::copy(row + begin, row + end, out + (begin - i0 + 3));
    for (int i = end; i < i0 - 3 + k_cols; ++i) out[i - i0 + 3] = row[end - 1];
  }
}

void copy_out(const Flow& f, const double* from, int i0, int k0, std::vector<double>& to) {
  const int ni = std::min(k_tile, f.nx - i0), nk = std::min(k_tile, f.nz - k0);
  for (int k = 0; k < nk; ++k) {
    const double* row = from + (k + 3) * k_cols + 3;
    std::copy(row, row + ni, to.data() + f.of(i0, k0 + k));
  }
}

void slopes(Tile& t) {
  const double* __restrict h = t.h;
  const double* __restrict eta = t.eta;
  const double* __restrict u = t.u;
  const double* __restrict w = t.w;
  double* __restrict ex = t.eta_x;
  double* __restrict ez = t.eta_z;
  double* __restrict ux = t.u_x;
  double* __restrict uz = t.u_z;
  double* __restrict wx = t.w_x;
  double* __restrict wz = t.w_z;
  constexpr int s = k_cols;
  for (int c = s + 1; c < k_all - s - 1; ++c) {
    const double wet_x = std::min(std::min(h[c - 1], h[c]), h[c + 1]);
    const double wet_z = std::min(std::min(h[c - s], h[c]), h[c + s]);
    const double sx = van_leer(eta[c] - eta[c - 1], eta[c + 1] - eta[c]);
    const double sz = van_leer(eta[c] - eta[c - s], eta[c + s] - eta[c]);
    ex[c] = wet_x > k_dry ? 0.5 * sx : 0.0;
    ez[c] = wet_z > k_dry ? 0.5 * sz : 0.0;
    ux[c] = 0.5 * van_leer(u[c] - u[c - 1], u[c + 1] - u[c]);
    uz[c] = 0.5 * van_leer(u[c] - u[c - s], u[c + s] - u[c]);
  }
  for (int c = s + 1; c < k_all - s - 1; ++c) {
    wx[c] = 0.5 * van_leer(w[c] - w[c - 1], w[c + 1] - w[c]);
    wz[c] = 0.5 * van_leer(w[c] - w[c - s], w[c + s] - w[c]);
  }
}

/// Of water through face c with velocity v; the cells beside it are c - back and c. Never more than twice what stands
/// upwind, so that nothing comes from dry ground.
inline double depth_of_face(const double* bed, const double* h, const double* eta, const double* slope, int c, int back,
                            double v) {
  const double from_low = eta[c - back] + slope[c - back], from_high = eta[c] - slope[c];
  const double h_low = h[c - back], h_high = h[c];
  const double level = v > 0 ? from_low : from_high, most = v > 0 ? h_low : h_high;
  return std::min(std::max(0.0, level - bed[c]), 2 * most);
}

/// y[c] = depth^(-1/3) of each face. A first guess from the bits of a float, within 4 %, then Newton's method.
void inverse_cube_roots(const double* __restrict h, int back, double* __restrict y) {
  alignas(64) float guess[k_all];
  for (int c = k_cols; c < k_all; ++c) guess[c] = static_cast<float>(std::max(k_thin, 0.5 * (h[c - back] + h[c])));
  for (int c = k_cols; c < k_all; ++c)
    guess[c] = std::bit_cast<float>(0x54a2fa8c - std::bit_cast<std::int32_t>(guess[c]) / 3);
  for (int c = k_cols; c < k_all; ++c) {
    const double x = std::max(k_thin, 0.5 * (h[c - back] + h[c]));
    double g = static_cast<double>(guess[c]);
    for (int n = 0; n < 3; ++n) g = g * (4 - x * g * g * g) * (1.0 / 3);
    y[c] = g;
  }
}

struct Friction {
  double manning = 0, viscous = 0;  ///< g n^2 and 3 nu
};

/// `a` is along the face's axis (back: to the cell before), `o` along the other one.
template <bool rough>
void momentum(const Tile& t, bool along_x, double dt, double cell, double gravity, const Friction& friction,
              const double* __restrict root, double* __restrict v1, double* __restrict q1) {
  constexpr int s = k_cols;
  const int a = along_x ? 1 : s, o = along_x ? s : 1;
  const double* __restrict b = along_x ? t.bx : t.bz;
  const double* __restrict h = t.h;
  const double* __restrict eta = t.eta;
  const double* __restrict head = t.head;
  const double* __restrict v = along_x ? t.u : t.w;
  const double* __restrict va = along_x ? t.u_x : t.w_z;
  const double* __restrict vo = along_x ? t.u_z : t.w_x;
  const double* __restrict qa = along_x ? t.qx : t.qz;
  const double* __restrict qo = along_x ? t.qz : t.qx;
  const double* __restrict ea = along_x ? t.eta_x : t.eta_z;
  const double* __restrict other = along_x ? t.w : t.u;
  const double by_cell = dt / cell;
  for (int c = 3 * s; c < k_all - 2 * s; ++c) {
    const double speed = v[c];
    const double h_face = std::max(k_thin, 0.5 * (h[c - a] + h[c]));
    const double q_high = 0.5 * (qa[c] + qa[c + a]), q_low = 0.5 * (qa[c - a] + qa[c]);
    const double q_left = 0.5 * (qo[c - a] + qo[c]), q_right = 0.5 * (qo[c - a + o] + qo[c + o]);
    // Both sides are read before one is chosen: the vector units do not branch.
    const double high_up = va[c], high_down = v[c + a] - va[c + a] - speed;
    const double low_up = v[c - a] + va[c - a] - speed, low_down = -va[c];
    const double right_up = vo[c], right_down = v[c + o] - vo[c + o] - speed;
    const double left_up = v[c - o] + vo[c - o] - speed, left_down = -vo[c];
    const double v_high = q_high > 0 ? high_up : high_down, v_low = q_low > 0 ? low_up : low_down;
    const double v_right = q_right > 0 ? right_up : right_down, v_left = q_left > 0 ? left_up : left_down;
    const double advected = (q_high * v_high - q_low * v_low + q_right * v_right - q_left * v_left) / h_face;
    double next = speed - by_cell * (advected + gravity * (head[c] - head[c - a]));
    if constexpr (rough) {
      const double across = 0.25 * (other[c - a] + other[c] + other[c - a + o] + other[c + o]);
      const double y2 = root[c] * root[c];
      next /= 1 + dt * (friction.manning * std::sqrt(speed * speed + across * across) * y2 * y2 +
                        friction.viscous * y2 * y2 * y2);
    }
    const double depth = depth_of_face(b, h, eta, ea, c, a, next);
    const double wet = depth > k_dry ? 1.0 : 0.0;
    v1[c] = next * wet;
    q1[c] = next * wet * depth;
  }
}

/// Open edges: waves leave as in water that goes on beyond at its level (Flather 1976).
double open_speed(double gravity, double h, double eta, double bed, double level) {
  const double depth = std::max(h, level - bed);
  return depth > k_dry ? std::sqrt(gravity / depth) * (eta - std::max(level, bed)) : 0.0;
}

void step_sides(Flow& f, double gravity) {
  const auto side = [&](int which, std::size_t inside, std::size_t outside, std::size_t face, bool along_x) {
    std::vector<double>&v1 = along_x ? f.u1 : f.w1, &q = along_x ? f.qx1 : f.qz1;
    if (f.sides[at(which)] == FlowSide::k_held) return;
    v1[face] = q[face] = 0;
    if (f.sides[at(which)] == FlowSide::k_wall) return;
    const double out = open_speed(gravity, f.h[inside], f.bed[inside] + f.h[inside], f.bed[inside], f.edge[outside]);
    v1[face] = which % 2 == 0 ? -out : out;
    q[face] = v1[face] * (out > 0 ? f.h[inside] : std::max(f.h[inside], f.edge[outside] - f.bed[inside]));
  };
  for (int k = 0; k < f.nz; ++k) {
    side(0, f.of(0, k), f.of(-1, k), f.of(0, k), true);
    side(1, f.of(f.nx - 1, k), f.of(f.nx, k), f.of(f.nx, k), true);
  }
  for (int i = 0; i < f.nx; ++i) {
    side(2, f.of(i, 0), f.of(i, -1), f.of(i, 0), false);
    side(3, f.of(i, f.nz - 1), f.of(i, f.nz), f.of(i, f.nz), false);
  }
}

struct Tiles {
  int across = 0;
  std::size_t count = 0;
  explicit Tiles(const Flow& f) : across((f.nx + k_tile - 1) / k_tile) {
    count = at(across) * at((f.nz + k_tile - 1) / k_tile);
  }
  int i0(std::size_t t) const { return static_cast<int>(t) % across * k_tile; }
  int k0(std::size_t t) const { return static_cast<int>(t) / across * k_tile; }
};

/// Smallest number of tiles for which waking the threads pays.
constexpr std::size_t k_tiles_a_block = 4;

}  // namespace

void step_velocities(Flow& f, const FlowLaws& laws, double dt) {
  const Tiles tiles(f);
  const Friction friction{laws.gravity * laws.manning * laws.manning, 3 * laws.viscosity};
  const bool rough = friction.manning > 0 || friction.viscous > 0;
  parallel_for(tiles.count, k_tiles_a_block, [&](std::size_t begin, std::size_t end) {
    Tile t;
    for (std::size_t n = begin; n < end; ++n) {
      const int i0 = tiles.i0(n), k0 = tiles.k0(n);
      copy_in(f, f.bed, i0, k0, t.eta);
      copy_in(f, f.bed_x, i0, k0, t.bx);
      copy_in(f, f.bed_z, i0, k0, t.bz);
      copy_in(f, f.h, i0, k0, t.h);
      copy_in(f, f.u, i0, k0, t.u);
      copy_in(f, f.w, i0, k0, t.w);
      copy_in(f, f.lift, i0, k0, t.head);
      for (int c = 0; c < k_all; ++c) {
        t.eta[c] += t.h[c];
        t.head[c] = t.eta[c] + t.head[c];
      }
      slopes(t);
      copy_in(f, f.qx, i0, k0, t.qx);
      copy_in(f, f.qz, i0, k0, t.qz);
      for (const bool along_x : {true, false}) {
        double *v1 = along_x ? t.u1 : t.w1, *q1 = along_x ? t.qx1 : t.qz1;
        if (rough) {
          inverse_cube_roots(t.h, along_x ? 1 : k_cols, t.root);
          momentum<true>(t, along_x, dt, f.cell, laws.gravity, friction, t.root, v1, q1);
        } else {
          momentum<false>(t, along_x, dt, f.cell, laws.gravity, friction, t.root, v1, q1);
        }
      }
      copy_out(f, t.u1, i0, k0, f.u1);
      copy_out(f, t.w1, i0, k0, f.w1);
      copy_out(f, t.qx1, i0, k0, f.qx1);
      copy_out(f, t.qz1, i0, k0, f.qz1);
    }
  });
  step_sides(f, laws.gravity);
}

double step_depths(Flow& f, const FlowLaws& laws, double dt, std::vector<double>* speeds) {
  const Tiles tiles(f);
  const double by_cell = dt / f.cell;
  constexpr int part = k_speed_tile, parts = k_tile / k_speed_tile;
  const int speeds_across = speed_tiles(f.nx);
  if (speeds) speeds->assign(at(speeds_across) * at(speed_tiles(f.nz)), 0.0);
  return parallel_max(tiles.count, k_tiles_a_block, 0.0, [&](std::size_t begin, std::size_t end) {
    constexpr int s = k_tile + 2;
    alignas(64) double factor[s * s];
    double fastest = 0;
    for (std::size_t n = begin; n < end; ++n) {
      const int i0 = tiles.i0(n), k0 = tiles.k0(n);
      const int ni = std::min(k_tile, f.nx - i0), nk = std::min(k_tile, f.nz - k0);
      for (int k = -1; k <= nk; ++k) {
        const std::size_t c0 = f.of(i0, k0 + k) - 1;
        const double* __restrict h = &f.h[c0];
        const double* __restrict qx = &f.qx1[c0];
        const double* __restrict qz = &f.qz1[c0];
        const double* __restrict qz_above = &f.qz1[c0 + f.row];
        double* __restrict out = factor + (k + 1) * s;
        for (int i = 0; i < ni + 2; ++i) {
          const double leaves =
              std::max(0.0, qx[i + 1]) + std::max(0.0, -qx[i]) + std::max(0.0, qz_above[i]) + std::max(0.0, -qz[i]);
          out[i] = draining(h[i], by_cell * leaves);
        }
      }
      // What comes in from outside is not cut.
      for (int k = -1; k <= nk; ++k) {
        double* out = factor + (k + 1) * s;
        if (k0 + k < 0 || k0 + k >= f.nz) std::fill(out, out + ni + 2, 1.0);
        if (i0 == 0) out[0] = 1;
        if (i0 + ni == f.nx) out[ni + 1] = 1;
      }
      alignas(64) double column_fastest[k_tile] = {};
      for (int k = 0; k < nk; ++k) {
        const std::size_t c0 = f.of(i0, k0 + k);
        const double* __restrict h = &f.h[c0];
        const double* __restrict qx = &f.qx1[c0];
        const double* __restrict qz = &f.qz1[c0];
        const double* __restrict qz_above = &f.qz1[c0 + f.row];
        const double* __restrict u = &f.u1[c0];
        const double* __restrict w = &f.w1[c0];
        const double* __restrict own = factor + (k + 1) * s + 1;
        const double* __restrict below = own - s;
        const double* __restrict above = own + s;
        double* __restrict h1 = &f.h1[c0];
        for (int i = 0; i < ni; ++i) {
          const double f_low = own[i - 1], f_own = own[i], f_high = own[i + 1], f_left = below[i], f_right = above[i];
          const double low = qx[i] * (qx[i] > 0 ? f_low : f_own), high = qx[i + 1] * (qx[i + 1] > 0 ? f_own : f_high);
          const double left = qz[i] * (qz[i] > 0 ? f_left : f_own),
                       right = qz_above[i] * (qz_above[i] > 0 ? f_own : f_right);
          const double next = h[i] - by_cell * ((high - low) + (right - left));
          h1[i] = next;
          const double speed = std::sqrt(std::max(u[i] * u[i], w[i] * w[i])) +
                               k_wave_share * std::sqrt(laws.gravity * std::max(next, 0.0));
          column_fastest[i] = std::max(column_fastest[i], speed);
        }
        if (k % part != part - 1 && k + 1 != nk) continue;
        for (int p = 0; p < parts && p * part < ni; ++p) {
          const double most = *std::max_element(column_fastest + p * part, column_fastest + (p + 1) * part);
          if (speeds) (*speeds)[at(i0 / part + p) + at(speeds_across) * at((k0 + k) / part)] = most;
          fastest = std::max(fastest, most);
        }
        std::fill(column_fastest, column_fastest + k_tile, 0.0);
      }
    }
    return fastest;
  });
}

}  // namespace ft::inline solvers
