// What a shot says of a pond: the pool, what floats in it, wind and splashes. See pond_solver.h.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "baker/core/result.h"
#include "solvers/water/water_body.h"

namespace ft::inline solvers {

enum class PondEdge {
  k_wall,  ///< waves come back
  k_open,  ///< waves leave: a rim takes them
};

struct PondFloat {
  FloatingBody body;
  RigidMotion start;         ///< world
  double restitution = 0.3;  ///< of contact [1]; 0 dead, 1 elastic
};

struct SplashSettings {
  bool on = true;
  double energy_share = 0.3;       ///< of what an impact loses, to droplets [1]; 0 none, 0.6 a firework
  double droplet_diameter = 0.02;  ///< usual size [m]; 0.004 spray, 0.03 lumps. Impacts set their number by it
  int most_droplets = 60000;       ///< in the air at once; larger ones beyond it
  double slowest = 1;              ///< impacts slower than this make none [m/s]
  double cavity_slice = 0.05;      ///< thickness of the slices of a cavity [m]
  double cavity_opening = 0.02;  ///< share of a body's speed with which its cavity widens [1]; 0.02 rip entry, 0.2 bad
  double cavity_speed = 2;       ///< bodies that sink slower than this leave no cavity [m/s]
  double jet_share = 0.15;       ///< of a cavity's energy, to the jet [1]
  double foam_life = 4;          ///< s to 1/e
};

struct PondSetup {
  std::string name = "pond";
  Vec3 corner = Vec3::Zero();       ///< least x and z; y: the level at rest [m]
  double size_x = 10, size_z = 10;  ///< m
  int nx = 256, nz = 256;           ///< cells; even, 8 to 4096
  double depth = 2;                 ///< m
  PondEdge edges = PondEdge::k_wall;
  double rim = 0;              ///< width of the open edge's rim [m]; 0: a sixth of the shorter side
  double gravity = k_gravity;  ///< m/s2
  double density = 1000;       ///< kg/m3
  double tension = 0;          ///< surface tension [N/m]; 0.072 water, felt by ripples shorter than 5 cm
  Vec2 wind = Vec2::Zero();    ///< x and z at 10 m height [m/s]: a ruffle of short waves; 0 none
  std::uint64_t seed = 1;
  double steps_per_second = 240;  ///< at least
  std::vector<PondFloat> floats;
  SplashSettings splash;
};

/// All faults of a setup, in one text; none where there are none.
Status check_pond(const PondSetup& setup);

}  // namespace ft::inline solvers
