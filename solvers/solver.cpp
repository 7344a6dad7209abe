#include "solvers/solver.h"

namespace ft {

const char* name(Incident::Kind kind) {
  switch (kind) {
    case Incident::Kind::k_crossing: return "crossing";
    case Incident::Kind::k_penetration: return "penetration";
    case Incident::Kind::k_released: return "released";
    case Incident::Kind::k_strain: return "strain";
    case Incident::Kind::k_start_inside: return "start inside";
    case Incident::Kind::k_rewind: return "rewind";
  }
  return "unknown";
}

}  // namespace ft
