// Hair for tests and pictures: strands on the upper half of a ball, combed down from its top, that swing from side to
// side. A closed form of the phase of the swing, by directions of length 1: no strand ever changes its length.
#pragma once

#include <vector>

#include "baker/core/output_shape.h"

namespace ft::test {

struct CombedBall {
  int strands = 2000;
  int vertices = 32;         ///< of each strand, from 2
  double radius = 0.1;       ///< of the ball [m]
  Vec3 centre{0, 0.4, 0};    ///< of the ball [m]
  double length = 0.26;      ///< of the longest strands [m]; the shortest have three quarters of it
  double root_width = 4e-4;  ///< diameter, which the tip has a third of [m]
  double swing = 0.5;        ///< how far a tip turns to the side [rad]
  bool turned = false;       ///< the strands stand in the opposite order
};

/// At phase 0; ids are even numbers from 1000.
CurveSet combed_curves(const CombedBall& ball);

/// Of all vertices, strand by strand from its root [m]; a swing is 2 pi of phase.
std::vector<Vec3> combed_places(const CombedBall& ball, double phase);

}  // namespace ft::test
