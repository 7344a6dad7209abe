// Scratch of a frame of the pond: see pond_frame.cpp.
#pragma once

#include "solvers/water/pond/cavity.h"
#include "solvers/water/pond/float_contact.h"
#include "solvers/water/pond/pond_solver.h"
#include "solvers/water/pond/skin_volume.h"
#include "solvers/water/pond/volume_layers.h"

namespace ft::inline solvers {

struct PondSolver::Frame {
  Frame(const PondModes& modes, double unit) : layers(modes, unit) {}
  PondMemory memory;
  std::vector<double> eta, potential, foam, feed;  ///< feed: what a slice gives to the surface, in waves; may be empty
  FloatScratch floats;
  WaveStepScratch waves;
  FloatLosses losses;
  VolumeLayers layers;
  std::span<const double> heights;  ///< at the frame's start
  CavityEvents events;
  std::vector<SkinPoints> skins;
  PondReport report;
  int frame = 0;
};

}  // namespace ft::inline solvers
