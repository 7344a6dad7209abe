// What changes while cloth moves: positions, velocities, the history of the integrator, and what is let pass.
#pragma once

#include <vector>

#include "baker/core/state.h"
#include "baker/core/teleport.h"
#include "baker/core/types.h"

namespace ft::inline solvers {

struct ClothMotion {
  std::vector<Vec3> x, v;
  std::vector<Vec3> x_previous, v_previous;  ///< one step of h_previous before
  std::vector<Vec3> x_older, v_older;        ///< and one of h_older before that
  double h_previous = 0, h_older = 0;        ///< s; 0: no history
  std::vector<char> absent;   ///< per garment and vertex of the collider (absence.h): 1 it does not meet it, else 0
  std::vector<char> tangled;  ///< per cloth vertex: 1 near a place where cloth crosses cloth, else 0
};

/// Position, velocity and history to the new place.
void carry(const Teleport& teleport, ClothMotion& motion);

/// Writes the motion into blocks of a state, bit for bit.
void store(State& state, const ClothMotion& motion);

/// The motion of `count` vertices that store() wrote, whose blocks it leaves empty; a state without it is a fault of
/// the program.
ClothMotion take_motion(State& state, std::size_t count);
/// Of a state with such a motion: ClothMotion::absent.
std::vector<char> absent_of(const State& state);

/// A motion in less than half the room, from which cloth can start once more: positions to the bit, velocities and the
/// last step to seven digits; what is older is forgotten.
class KeptMotion {
 public:
  explicit KeptMotion(const ClothMotion& motion);
  ClothMotion motion() const;

 private:
  std::vector<Vec3> x_;
  std::vector<Vec3f> v_, v_previous_;
  std::vector<Vec3f> to_previous_;  ///< from x [m]
  double h_previous_;
  std::vector<char> absent_;
  std::vector<char> tangled_;  ///< empty: nothing is
};

/// The cloth goes along with a body that it does not meet: by a way [m], and at a velocity [m/s] from then on.
void take_along_with(const Vec3& way, const Vec3& velocity, ClothMotion& motion);

}  // namespace ft::inline solvers
