// What the shot file says of cords, and their solver takes as it is.
#pragma once

namespace ft::inline solvers {

struct CordSettings {
  double mass = 0.03;      ///< of all cords together [kg], > 0
  double stretch = 3000;   ///< EA: force at a strain of 1 [N], > 0
  double bend = 0;         ///< EI along strands, which rest straight there [N m2]
  double damping = 1e-4;   ///< of stretch and bend, in units of their stiffness [s]
  double radius = 1.5e-3;  ///< of a cord, drawn and in contact [m]; contact begins at twice as much from the middle
  double friction = 0.4;   ///< Coulomb [1]
  double hold_stiffness = 2e4;  ///< of the springs that tie held points to the world [N/m]
  bool self_collision = false;
};

}  // namespace ft::inline solvers
