#include "solvers/base/solver.h"

#include "baker/core/check.h"
#include "baker/core/output_frame.h"

namespace ft::inline solvers {
namespace {

constexpr ProfilePhase k_phases[] = {{"candidates", "candidate pairs", &FrameProfile::candidates},
                                     {"narrow", "contact", &FrameProfile::narrow},
                                     {"assembly", "assembly", &FrameProfile::assembly},
                                     {"linear", "linear solves", &FrameProfile::linear},
                                     {"certificate", "certificate", &FrameProfile::certificate},
                                     {"body", "body pose", &FrameProfile::body}};

}  // namespace

std::span<const ProfilePhase> profile_phases() {
  return k_phases;
}

FrameProfile& FrameProfile::operator+=(const FrameProfile& other) {
  for (const ProfilePhase& phase : k_phases) this->*phase.time += other.*phase.time;
  total += other.total;
  return *this;
}

const char* name(Incident::Kind kind) {
  switch (kind) {
    case Incident::Kind::k_crossing: return "crossing";
    case Incident::Kind::k_penetration: return "penetration";
    case Incident::Kind::k_released: return "released";
    case Incident::Kind::k_strain: return "strain";
    case Incident::Kind::k_start_inside: return "start inside";
    case Incident::Kind::k_rewind: return "rewind";
    case Incident::Kind::k_unsettled: return "unsettled";
    case Incident::Kind::k_open_seam: return "open seam";
    case Incident::Kind::k_cut_short: return "cut short";
  }
  return "unknown";
}

const Mesh& Solver::system_mesh(int) const {
  check_failed("a system that has no other shape is a mesh", __FILE__, __LINE__);
}

void Solver::system_positions(const State&, int, std::span<Vec3>) const {
  check_failed("a system that has no other shape is a mesh", __FILE__, __LINE__);
}

void Solver::system_frame(const State&, int, FrameData&) const {
  check_failed("a system that has a shape has frames", __FILE__, __LINE__);
}

const std::string& Solver::system_name(int system) const {
  const SystemShape* shape = system_shape(system);
  return shape ? shape->name : system_mesh(system).name;
}

}  // namespace ft::inline solvers
