// See pond_solver.h: a pond as it is made, and before its first frame.
#include <algorithm>
#include <cmath>

#include "solvers/water/pond/pond_frame.h"

namespace ft::inline solvers {

PondSolver::PondSolver(PondSetup setup)
    : setup_(std::move(setup)),
      modes_(setup_.nx, setup_.nz, setup_.size_x, setup_.size_z, setup_.depth, setup_.gravity,
             setup_.tension / setup_.density) {
  for (const PondFloat& f : setup_.floats) {
    FloatModel m;
    m.shape = float_shape(f, setup_.density);
    m.mass = f.body.mass;
    m.drag = f.body.drag, m.restitution = f.restitution;
    m.first_part = part_count_;
    part_count_ += m.shape.parts.size();
    // A kernel narrower than the grid is the grid's; bodies of one size share theirs.
    const double depth = std::max(m.shape.depth, 0.7 * std::max(modes_.cell_x(), modes_.cell_z()));
    for (const FloatModel& other : floats_)
      if (std::abs(other.kernel->depth - depth) < 1e-3 * depth) m.kernel = other.kernel;
    if (!m.kernel) m.kernel = std::make_shared<KernelTable>(modes_, depth);
    floats_.push_back(std::move(m));
  }
  fastest_ = modes_.fastest();
}

PondSolver::~PondSolver() = default;

Result<std::unique_ptr<PondSolver>> PondSolver::make(PondSetup setup) {
  if (Status faults = check_pond(setup); !faults) return faults.error();
  if (setup.edges == PondEdge::k_open && setup.rim == 0) setup.rim = std::min(setup.size_x, setup.size_z) / 6;
  return std::unique_ptr<PondSolver>(new PondSolver(std::move(setup)));
}

State PondSolver::initial_state() const {
  State out;
  out.set("eta", std::vector<double>(modes_.size(), 0.0));
  out.set("potential", std::vector<double>(modes_.size(), 0.0));
  out.set("height", std::vector<double>(modes_.size(), 0.0));
  out.set("foam", std::vector<double>(modes_.size(), 0.0));
  PondMemory memory;
  for (std::size_t i = 0; i < floats_.size(); ++i) {
    RigidMotion m = setup_.floats[i].start;
    m.pose.position -= setup_.corner;
    memory.floats.motion.push_back(m);
    memory.floats.splash_energy.push_back(0), memory.floats.splash_speed.push_back(0);
    memory.floats.wake.push_back(Vec3::Zero());
    for (const FloatPart& p : floats_[i].shape.parts) memory.floats.volume.push_back(submerged(p, m.pose, 0).volume);
  }
  put(memory, out);
  return out;
}

}  // namespace ft::inline solvers
