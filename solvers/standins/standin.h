// Stand-ins: cheap models of a secondary that the primary meets instead of it in a hybrid pass, so that it yields
// before the secondary is baked one-way (O'Brien, Zordan & Hodgins 2000, section 3.3). A stand-in is never a collision
// shape.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <string_view>

#include "baker/core/mesh.h"
#include "baker/core/result.h"
#include "baker/core/wrench.h"
#include "solvers/standins/body_state.h"

namespace ft::inline solvers {

using Vec6 = Eigen::Matrix<double, 6, 1>;  ///< translation and rotation, or force and torque
using Mat6 = Eigen::Matrix<double, 6, 6>;

/// Whether a stand-in acts beside what the clip's motion contains already, or in place of the support in it.
enum class Support { k_add, k_replace };
enum class VolumeShape { k_box, k_cone, k_mesh };

/// What a shot file says of a stand-in. A kind reads the members that its file names and leaves the others.
struct StandInSpec {
  static constexpr double k_unlimited = std::numeric_limits<double>::infinity();

  std::string name;                                 ///< for messages
  std::string kind;                                 ///< "damping", "mat", "water", "spring", "weight", "fitted"
  std::string stands_for;                           ///< name of the secondary
  Support support = Support::k_add;                 ///< mats and water only replace
  double gain = 1;                                  ///< of force and torque, >= 0; 0 nothing
  double from = -k_unlimited, until = k_unlimited;  ///< acts in between [s]
  double limit_force = k_unlimited;                 ///< largest force; torque goes with it [N], > 0

  VolumeShape shape = VolumeShape::k_box;
  Vec3 position = Vec3::Zero();  ///< centre of box and cone, of a mat's top, a place on the water
  double heading = 0;            ///< about the vertical [rad]
  Vec3 size = Vec3::Zero();      ///< of a box; of a mat in plan: x, z [m], > 0
  double radius_top = 0, radius_bottom = 0, height = 0;  ///< of a cone frustum with a vertical axis [m]
  Mesh mesh;                                             ///< closed; its vertices are moved by heading and position
  double soft_edge = 0;  ///< from nothing at the rim to all this far inside [m]; 0 sharp

  double damping = 0;                ///< c [kg/s]; a twine net 4
  Vec3 damping_axes = Vec3::Ones();  ///< factors of c along the shape's axes, >= 0
  double damping_quadratic = 0;      ///< c2 [kg/m]
  double damping_spin = 0;           ///< c_r [kg m2/s]
  double stiffness = 0;              ///< k [N/m]; a landing mat 66e3
  double stiffness_cubic = 0;        ///< k3 [N/m3]
  double damping_ratio = 0;          ///< of k under the body's mass; 0 springs back, 1 critical
  double density = 1000;             ///< of the water [kg/m3]
  double drag = 1;                   ///< Cd of the body below water; sphere 0.47, flat plate 1.2
  double slam = 0;                   ///< Cs where the surface is being entered; 0 to 5
  double length = 0;                 ///< at which a spring is slack [m]
  Vec3 anchor = Vec3::Zero();        ///< point of the body, from the centre of mass, body axes [m]
  double mass = 0;                   ///< carried [kg]
};

/// What a stand-in does to a body, about its centre of mass, and how that changes with time, place, velocity and
/// acceleration (of translation and rotation, world axes), to first order:
///   wrench + rate dt - stiffness dx - damping dv - inertia da
/// The step is exact where this is; what a kind leaves out of it only costs smaller steps. `inertia` must be complete.
struct StandInForce {
  Wrench wrench;
  Wrench rate;                    ///< by the samples' own velocities [N/s]
  Mat6 stiffness = Mat6::Zero();  ///< N/m, N m/rad
  Mat6 damping = Mat6::Zero();    ///< kg/s, kg m2/s
  Mat6 inertia = Mat6::Zero();    ///< kg, kg m2

  /// A force at an arm [m] with its derivatives by the place and the velocity there; `own` is the velocity of the place
  /// against the body [m/s].
  void add(const Vec3& arm, const Vec3& force, const Mat3& stiffness_there, const Mat3& damping_there,
           const Vec3& own = Vec3::Zero());
  StandInForce& operator+=(const StandInForce& other);
  StandInForce& operator*=(double factor);
};

class StandIn {
 public:
  explicit StandIn(StandInSpec spec) : spec_(std::move(spec)) {}
  virtual ~StandIn() = default;
  StandIn(const StandIn&) = delete;
  StandIn& operator=(const StandIn&) = delete;

  const StandInSpec& spec() const { return spec_; }
  /// Holds the body up as the ground of the clip did, which then has to go: needs support = "replace".
  virtual bool is_supporting() const { return false; }
  /// Only ever takes energy from the body.
  virtual bool is_dissipative() const { return false; }
  /// Whether it is at the body, give or take a margin [m]: whether it would carry what the clip has standing here.
  virtual bool reaches(const BodyState& body, double margin) const = 0;

  /// With gain, time gate and limit.
  StandInForce act(const BodyState& body) const;

 protected:
  /// The kind's own law: full gain, at all times, without a limit.
  virtual StandInForce law(const BodyState& body) const = 0;
  /// World to the shape's axes.
  Vec3 local(const Vec3& place) const { return turned().transpose() * (place - spec_.position); }
  /// Shape's axes to the world's.
  Mat3 turned() const { return Eigen::AngleAxisd(spec_.heading, Vec3::UnitY()).toRotationMatrix(); }

  /// From 0 at the rim to 1 at the soft edge's depth inside [m], without a kink.
  double ramp(double depth) const;

 private:
  StandInSpec spec_;
};

/// Matrix of a cross product: cross_matrix(a) b = a x b.
inline Mat3 cross_matrix(const Vec3& a) {
  Mat3 out;
  out << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return out;
}

}  // namespace ft::inline solvers
