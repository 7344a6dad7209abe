// The water of a rectangle of cells: thickness in cells, velocities on the faces between them (a staggered grid), with
// two rows of ghosts around. The whole domain is one, and so is a patch of it that takes shorter steps.
//
//        w(i,k+1)             cell (i, k) and its faces share one index, of(i, k): u is the face at its lower x,
//   u(i,k) [h(i,k)] u(i+1,k)  w the face at its lower z.
//         w(i,k)
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "solvers/water/shallow/shallow_setup.h"

namespace ft::inline solvers {

/// What bounds a Flow on one side.
enum class FlowSide {
  k_wall,
  k_open,
  k_held,  ///< velocities and fluxes of its faces, and the ghosts beyond, are given by who steps it
};

struct Flow {
  static constexpr int k_ghosts = 2;

  int nx = 0, nz = 0;
  int x0 = 0, z0 = 0;  ///< of its first cell, in the domain's cells
  std::size_t row = 0;
  double cell = 0;  ///< m
  std::array<FlowSide, 4> sides{};

  std::vector<double> bed;           ///< height of the ground [m]
  std::vector<double> bed_x, bed_z;  ///< of the ground at faces, see find_face_beds() [m]
  std::vector<double> h;             ///< thickness of the water [m], never below zero
  std::vector<double> lift;          ///< head above bed + h: not zero near bodies alone [m]
  std::vector<double> u, w;          ///< on faces [m/s]
  std::vector<double> qx, qz;  ///< on faces: depth times velocity in the step before, before draining was cut [m2/s]
  std::vector<double> h1, u1, w1, qx1, qz1;  ///< at the step's end; finish_step() swaps them
  std::vector<double> edge;                  ///< level beyond open sides, in the ghosts next to them [m]

  Flow() = default;
  Flow(int cells_x, int cells_z, double cell_size);
  std::size_t of(int i, int k) const {
    return static_cast<std::size_t>(k + k_ghosts) * row + static_cast<std::size_t>(i + k_ghosts);
  }
  std::size_t size() const { return bed.size(); }
};

/// What moves water that touches nothing.
struct FlowLaws {
  double gravity = k_gravity, manning = 0, viscosity = 0;
};

/// Thinner than this no water passes a face [m].
inline constexpr double k_dry = 1e-7;

/// Puts what lies behind walls and open sides into the ghosts of `values`: the mirror image. Faces along x have
/// `face` 0, along z 1, cells -1; velocities square to a wall change their sign.
void fill_ghosts(const Flow& flow, std::vector<double>& values, int face);

/// Heights of the ground at faces: half-way where it is smooth, the upper side's at a step. Once the bed is known.
void find_face_beds(Flow& flow);

/// First half of a step: velocities u1, w1 and fluxes qx1, qz1 of all faces from the state at its start. Stelling and
/// Duinmeijer (2003), advection and depth at faces limited by van Leer. Ghosts must be filled.
void step_velocities(Flow& flow, const FlowLaws& laws, double dt);

/// Depth at a face through which water goes with velocity v, from its upwind side [m]: the x face (z face) of cell c.
double face_depth(const Flow& flow, std::size_t c, bool along_x, double v);

/// Waves may go so much farther in a step than water [1]: for a step's length their speed counts by this.
inline constexpr double k_wave_share = 0.5;

/// Second half: thicknesses h1 from the fluxes, which are cut where a cell would lose more than it has (passed_flux()
/// says what has passed). The largest |velocity| + k_wave_share sqrt(g h) of a cell [m/s] of each tile goes to
/// `speeds`, if any (k_speed_tile x k_speed_tile cells a tile, x fastest); returns the largest.
double step_depths(Flow& flow, const FlowLaws& laws, double dt, std::vector<double>* speeds);

/// What passes face c in the step that is not finished yet, after the cut [m2/s].
double passed_flux(const Flow& flow, std::size_t c, bool along_x, double dt);

/// What has gone out over open sides in the step that is not finished yet [m3].
double step_outflow(const Flow& flow, double dt);

/// The highest place of the water; far below everything where all is dry [m].
double highest_water(const Flow& flow);

/// Makes the step's end its start, ghosts included.
void finish_step(Flow& flow);

/// Of the state as it is, as step_depths() gives them.
void flow_speeds(const Flow& flow, const FlowLaws& laws, std::vector<double>& speeds);

inline constexpr int k_flow_tile = 32, k_speed_tile = 8;
constexpr int speed_tiles(int cells) {
  return (cells + k_speed_tile - 1) / k_speed_tile;
}

}  // namespace ft::inline solvers
