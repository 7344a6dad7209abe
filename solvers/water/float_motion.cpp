// See float_motion.h.
#include "solvers/water/float_motion.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "baker/core/smooth_step.h"

namespace ft::inline solvers {
namespace {

/// Of a sphere in unbounded fluid, for want of better for other bodies [1].
constexpr double k_added_mass = 0.5;
constexpr double k_ground_friction = 0.3;
constexpr int k_contact_sweeps = 8;
constexpr int k_meeting_passes = 2;

}  // namespace

FloatState read_float(std::span<const double> n) {
  FloatState s;
  s.motion.pose.position = Vec3(n[0], n[1], n[2]);
  s.motion.pose.rotation = Quat(n[6], n[3], n[4], n[5]);
  s.motion.velocity = Vec3(n[7], n[8], n[9]);
  s.motion.spin = Vec3(n[10], n[11], n[12]);
  s.added_mass = n[13];
  return s;
}

void write_float(const FloatState& s, std::span<double> n) {
  const Vec3 &p = s.motion.pose.position, &v = s.motion.velocity, &w = s.motion.spin;
  const Quat& q = s.motion.pose.rotation;
  const double all[k_float_numbers] = {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w(),
                                       v.x(), v.y(), v.z(), w.x(), w.y(), w.z(), s.added_mass};
  std::copy(std::begin(all), std::end(all), n.begin());
}

FloatingHull float_model(const FloatingBody& body) {
  FloatingHull m{body, 0, 0, contact_spheres(body)};
  for (const Triangle& t : body.triangles)
    m.volume += body.positions[at(t[0])].dot(body.positions[at(t[1])].cross(body.positions[at(t[2])])) / 6;
  const double r = std::cbrt(std::max(0.0, m.volume) * 0.75 / std::numbers::pi);
  m.spin_drag = 0.05 * body.drag * std::pow(r, 5);
  return m;
}

std::vector<const FloatingBody*> bodies_of(std::span<const FloatingHull> hulls) {
  std::vector<const FloatingBody*> out;
  for (const FloatingHull& hull : hulls) out.push_back(&hull.body);
  return out;
}

std::vector<RigidPose> poses_of(std::span<const FloatState> floats) {
  std::vector<RigidPose> out;
  for (const FloatState& f : floats) out.push_back(f.motion.pose);
  return out;
}

void float_positions(const FloatingHull& model, const RigidPose& pose, std::vector<Vec3>& positions) {
  positions.resize(model.body.positions.size());
  const Mat3 r = pose.rotation.toRotationMatrix();
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = pose.position + r * model.body.positions[i];
}

RigidPose moved(const RigidPose& pose, const Vec6& velocity, double dt) {
  RigidPose out = pose;
  out.position += dt * velocity.head<3>();
  const Vec3 turn = dt * velocity.tail<3>();
  const double angle = turn.norm();
  if (angle > 0) out.rotation = (Quat(Eigen::AngleAxisd(angle, turn / angle)) * pose.rotation).normalized();
  return out;
}

FloatStep prepare_float(const FloatingHull& model, FloatState& state, std::span<const Vec3> positions,
                        const FloatSurroundings& water, double gravity, double density, double dt) {
  FloatStep out;
  RigidMotion& motion = state.motion;
  const RigidMass& m = model.body.mass;
  double under = 0, deep = 0;
  if (water.any && model.volume > 0) {
    const double volume = hydrostatics(positions, model.body.triangles, water.level, 1, Vec3::Zero()).volume;
    under = std::clamp(volume / model.volume, 0.0, 1.0);
    const Box box = bounds(positions);
    // Added mass comes with the water above the body, up to half the body's height of it.
    deep = smooth_step((water.level - box.hi.y()) / (0.5 * (box.hi.y() - box.lo.y())));
  }
  const double added = k_added_mass * density * model.volume * deep;
  motion.velocity *= (m.mass + state.added_mass) / (m.mass + added);
  state.added_mass = added;
  const Mat3 turn = motion.pose.rotation.toRotationMatrix();
  const Mat3 inertia = turn * m.inertia * turn.transpose();
  out.mass.topLeftCorner<3, 3>() = (m.mass + added) * Mat3::Identity();
  out.mass.bottomRightCorner<3, 3>() = inertia;

  Vec3 v = motion.velocity + dt * m.mass / (m.mass + added) * Vec3(0, -gravity, 0);
  Vec3 spin = motion.spin - dt * inertia.ldlt().solve(motion.spin.cross(inertia * motion.spin));
  const Vec3 through = motion.velocity - water.velocity;
  const double speed = through.norm();
  if (under > 0 && speed > 0 && model.body.drag > 0) {
    const double area = facing_area(positions, model.body.triangles, through / speed);
    const double rate = 0.5 * density * model.body.drag * area * under * speed / (m.mass + added);
    const Vec3 slowed = water.velocity + (v - water.velocity) / (1 + dt * rate);
    out.drag = (m.mass + added) * (slowed - v) / dt;
    v = slowed;
  }
  if (under > 0) {
    const double largest = inertia.diagonal().maxCoeff();
    spin /= 1 + dt * density * model.spin_drag * under * motion.spin.norm() / largest;
  }
  out.free.head<3>() = v;
  out.free.tail<3>() = spin;
  return out;
}

void meet_one_another(std::span<const FloatingHull> models, std::span<FloatState> floats) {
  for (int pass = 0; pass < k_meeting_passes; ++pass)
    for (std::size_t a = 0; a < models.size(); ++a)
      for (std::size_t b = a + 1; b < models.size(); ++b)
        meet({&models[a].body.mass, &floats[a].motion, floats[a].added_mass}, models[a].contact,
             {&models[b].body.mass, &floats[b].motion, floats[b].added_mass}, models[b].contact, k_float_restitution);
}

Vec6 keep_above(const GroundCells& ground, std::span<const Vec3> positions, const Vec3& about, const Mat6& mass,
                const Vec6& velocity, double dt) {
  const Vec3 least(ground.x, 0, ground.z);
  const Vec3 most(ground.x + ground.cell * ground.nx, 0, ground.z + ground.cell * ground.nz);
  Vec6 v = velocity;
  const Mat6 inverse = mass.inverse();
  // Of the vertices that would be beyond a plane, the impulses that stop them, in turn.
  const auto push = [&](const Vec3& place, const Vec3& normal, double gap, double& given) {
    const Vec3 arm = place - about;
    Vec6 way;
    way << normal, arm.cross(normal);
    const double closing = way.dot(v) + gap / dt, ease = way.dot(inverse * way);
    const double before = given;
    given = std::max(0.0, given - closing / ease);
    v += inverse * way * (given - before);
    const Vec3 speed = v.head<3>() + v.tail<3>().cross(arm);
    const Vec3 slide = speed - speed.dot(normal) * normal;
    const double fast = slide.norm();
    if (given > before && fast > 1e-12) {
      Vec6 along;
      along.head<3>() = slide / fast;
      along.tail<3>() = arm.cross(slide) / fast;
      v -= inverse * along * std::min(fast / along.dot(inverse * along), k_ground_friction * (given - before));
    }
  };
  struct Touch {
    Vec3 place, normal;
    double gap, given;
  };
  std::vector<Touch> touches;
  for (const Vec3& p : positions) {
    const int i = std::clamp(static_cast<int>(std::floor((p.x() - ground.x) / ground.cell)), 0, ground.nx - 1);
    const int k = std::clamp(static_cast<int>(std::floor((p.z() - ground.z) / ground.cell)), 0, ground.nz - 1);
    const Vec3 then = p + dt * (v.head<3>() + v.tail<3>().cross(p - about));
    const double gap = p.y() - ground.bed[ground.first + at(i) + ground.row * at(k)];
    if (gap + then.y() - p.y() < 0) touches.push_back({p, Vec3::UnitY(), gap, 0});
    for (const int axis : {0, 2}) {
      if (then[axis] < least[axis] - 1e-9) touches.push_back({p, Vec3::Unit(axis), p[axis] - least[axis], 0});
      if (then[axis] > most[axis] + 1e-9) touches.push_back({p, -Vec3::Unit(axis), most[axis] - p[axis], 0});
    }
  }
  for (int sweep = 0; sweep < k_contact_sweeps; ++sweep)
    for (Touch& t : touches) push(t.place, t.normal, t.gap, t.given);
  return v;
}

}  // namespace ft::inline solvers
