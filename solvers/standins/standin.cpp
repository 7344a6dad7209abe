#include "solvers/standins/standin.h"

namespace ft::inline solvers {

void StandInForce::add(const Vec3& arm, const Vec3& force, const Mat3& stiffness_there, const Mat3& damping_there,
                       const Vec3& own) {
  wrench.add(arm, force);
  rate.add(arm, -stiffness_there * own);
  rate.torque += own.cross(force);
  // A rotation r moves the place by r x arm = -[arm] r, and the arm of the force with it.
  const Mat3 x = cross_matrix(arm);
  const auto put = [&](Mat6& all, const Mat3& there) {
    if (there.isZero(0)) return;
    all.topLeftCorner<3, 3>() += there;
    all.topRightCorner<3, 3>() -= there * x;
    all.bottomLeftCorner<3, 3>() += x * there;
    all.bottomRightCorner<3, 3>() -= x * there * x;
  };
  put(stiffness, stiffness_there);
  put(damping, damping_there);
  stiffness.bottomRightCorner<3, 3>() -= cross_matrix(force) * x;
}

StandInForce& StandInForce::operator+=(const StandInForce& other) {
  wrench += other.wrench, rate += other.rate;
  stiffness += other.stiffness, damping += other.damping, inertia += other.inertia;
  return *this;
}

StandInForce& StandInForce::operator*=(double factor) {
  wrench = factor * wrench, rate = factor * rate;
  stiffness *= factor, damping *= factor, inertia *= factor;
  return *this;
}

double StandIn::ramp(double depth) const {
  if (!(depth > 0)) return 0;
  if (depth >= spec_.soft_edge) return 1;
  const double t = depth / spec_.soft_edge;
  return t * t * (3 - 2 * t);
}

StandInForce StandIn::act(const BodyState& body) const {
  if (body.time < spec_.from || body.time >= spec_.until || spec_.gain == 0) return {};
  StandInForce out = law(body);
  if (spec_.gain != 1) out *= spec_.gain;
  const double size = out.wrench.force.norm();
  if (size > spec_.limit_force) out *= spec_.limit_force / size;
  return out;
}

}  // namespace ft::inline solvers
