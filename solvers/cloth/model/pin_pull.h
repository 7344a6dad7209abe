// What a pin does to its vertex in one solve: a spring that pulls no harder than its limit, so that contact wins, and a
// drag on what has slipped off and comes back. Without the drag the work of tearing the cloth off would come back as
// speed, and what a pinch or a ball has pulled out would be slung.
#pragma once

#include "solvers/cloth/model/cloth_model.h"
#include "solvers/energies/limited_spring.h"

namespace ft::inline solvers {

class PinPull {
 public:
  /// What has slipped off comes back no faster than this by the pin's pull alone [m/s]: what falls by 0.2 m. 0.1 creeps
  /// back, 20 is slung as without a drag.
  static constexpr double k_return_speed = 2;

  /// x_t0, v_t0: of the vertex at the start [m, m/s]; target: of the pin at the end, which it has gone to by
  /// target_motion [m]; h: of the solve [s]; time: at its end [s].
  PinPull(const PinPoint& pin, const Vec3& x_t0, const Vec3& v_t0, const Vec3& target, const Vec3& target_motion,
          double h, double time)
      : share_(pin.hold.share(time)),
        stiffness_(share_ * pin.stiffness),
        limit_(share_ * pin.max_pull),
        along_(x_t0 + target_motion),
        target_(target) {
    const Vec3 off = along_ - target;
    const bool slipped = off.norm() * pin.stiffness > pin.max_pull;
    if (slipped && off.dot(v_t0 - target_motion / h) < 0) drag_ = limit_ / (k_return_speed * h);
  }

  bool holds() const { return share_ > 0; }
  double energy(const Vec3& x) const { return spring(x).energy + 0.5 * drag_ * (x - along_).squaredNorm(); }  ///< J
  Vec3 gradient(const Vec3& x) const { return spring(x).secant * (x - target_) + drag_ * (x - along_); }      ///< N
  double stiffness(const Vec3& x) const { return spring(x).secant + drag_; }                                  ///< N/m

 private:
  LimitedSpring spring(const Vec3& x) const { return limited_spring((x - target_).norm(), stiffness_, limit_); }

  double share_, stiffness_, limit_;  ///< of its force [1], N/m, N
  double drag_ = 0;                   ///< N/m, against the way from along_ on
  Vec3 along_;                        ///< where the vertex would be if it kept its place beside the pin
  Vec3 target_;
};

}  // namespace ft::inline solvers
