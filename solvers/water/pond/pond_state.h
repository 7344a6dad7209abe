// What a pond remembers, as structs for the code and as named columns of numbers in the State.
#pragma once

#include "baker/core/state.h"
#include "solvers/water/pond/float_dynamics.h"

namespace ft::inline solvers {

/// Sums since the start of the bake.
struct PondAccount {
  double driven = 0;    ///< volume that driven bodies have put into the waves [m3]
  double cavities = 0;  ///< that open cavities have [m3]
  double outflow = 0;   ///< m3
  double next_droplet = 1;
  double slam = 0, drag = 0, contact = 0, absorbed = 0, wind = 0,
         thrown = 0;  ///< J: lost, lost, lost, left, given, in splashes
};

/// A disc of air below the surface, where a body has passed.
struct CavitySlice {
  double x = 0, z = 0, depth = 0, thickness = 0;  ///< pool [m]; thickness below zero: just opened
  double square = 0, rate = 0;                    ///< of its radius [m2], [m2/s]
  double acts_at = 0;                             ///< depth from which its volume pushes the surface [m]
  double body = 0;                                ///< index of the driven body
};

/// What is remembered of a driven body.
struct Crossing {
  double widest = 0;        ///< radius of its widest section at the surface in this passage [m]
  double armed = 0;         ///< 1: a cavity opens behind its tail
  double sealed = 0;        ///< 1: its cavity has closed at the top; no air follows
  double crown_energy = 0;  ///< J, not yet thrown
  double crown_speed = 0;   ///< m/s
  double crown_x = 0, crown_z = 0, crown_radius = 0;  ///< m
  double cavity_energy = 0;                           ///< most of this passage [J]
};

/// Views of the columns of a State; all to be put back by put().
struct PondMemory {
  Floats floats;
  std::vector<Droplet> droplets;
  std::vector<CavitySlice> cavities;
  std::vector<Crossing> crossings;
  PondAccount account;
};

PondMemory take(const State& state, std::size_t float_count, std::size_t part_count);
void put(const PondMemory& memory, State& state);

}  // namespace ft::inline solvers
