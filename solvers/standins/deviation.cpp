#include "solvers/standins/deviation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

#include "solvers/standins/rigid_flight.h"

namespace ft::inline solvers {
namespace {

constexpr int k_halvings = 12;                ///< of the longest step, at most: 1 microsecond
constexpr double k_least_support = 0.05;      ///< of the weight: less is noise of a clip in flight
constexpr double k_standing_distance = 0.05;  ///< as near as feet that stand are to the ground in motion capture [m]

struct Response {
  Vec6 e = Vec6::Zero(), rate = Vec6::Zero();
};

/// M e'' = f0 + f1 t + f2 t^2 / 2 - K e - C e' from rest, at time h: a column of one matrix exponential.
Response respond(const Mat6& inverse_mass, const Mat6& k, const Mat6& c, const Vec6& f0, const Vec6& f1, const Vec6& f2,
                 double h) {
  if (f0.isZero(0) && f1.isZero(0) && f2.isZero(0)) return {};
  Eigen::Matrix<double, 15, 15> a = Eigen::Matrix<double, 15, 15>::Zero();
  a.block<6, 6>(0, 6).setIdentity();
  a.block<6, 6>(6, 0) = -inverse_mass * k;
  a.block<6, 6>(6, 6) = -inverse_mass * c;
  a.block<6, 1>(6, 12) = inverse_mass * f0;
  a.block<6, 1>(6, 13) = inverse_mass * f1;
  a.block<6, 1>(6, 14) = inverse_mass * f2;
  a(13, 12) = a(14, 13) = 1;
  const Eigen::Matrix<double, 15, 15> result = (h * a).exp();
  return {result.block<6, 1>(0, 12), result.block<6, 1>(6, 12)};
}

Vec6 stacked(const Vec3& a, const Vec3& b) {
  Vec6 out;
  out << a, b;
  return out;
}
Vec6 stacked(const Wrench& w) {
  return stacked(w.force, w.torque);
}

}  // namespace

/// A step of length h, and how far it may be off.
struct Deviation::Trial {
  DeviationState end;
  Vec6 impulse = Vec6::Zero();  ///< of the stand-ins
  double work = 0, peak = 0;
  double error = 0;  ///< m/s or rad/s, whichever is more
};

std::function<RigidMotion(double)> sampled_motion(double start, double dt, std::vector<RigidMotion> samples) {
  CHECK(dt > 0 && !samples.empty());
  return [start, dt, samples = std::move(samples)](double time) {
    const double place = std::clamp((time - start) / dt, 0.0, static_cast<double>(samples.size() - 1));
    const auto i = static_cast<std::size_t>(place);
    const double s = place - static_cast<double>(i);
    if (s == 0) return samples[i];
    const RigidMotion &a = samples[i], &b = samples[i + 1];
    const Vec3 way = b.pose.position - a.pose.position;
    RigidMotion out;
    out.pose.position =
        a.pose.position + s * s * (3 - 2 * s) * way + s * (1 - s) * dt * ((1 - s) * a.velocity - s * b.velocity);
    out.velocity = 6 * s * (1 - s) / dt * way + (1 - s) * (1 - 3 * s) * a.velocity - s * (2 - 3 * s) * b.velocity;
    out.pose.rotation = a.pose.rotation.slerp(s, b.pose.rotation);
    out.spin = (1 - s) * a.spin + s * b.spin;
    return out;
  };
}

bool DeviationState::is_zero() const {
  return offset.position.isZero(0) && offset.rotation.vec().isZero(0) && velocity.isZero(0) &&
         angular_momentum.isZero(0);
}

Deviation::Deviation(YieldingBody body, std::vector<std::unique_ptr<StandIn>> stand_ins, DeviationSettings settings)
    : body_(std::move(body)), stand_ins_(std::move(stand_ins)), settings_(settings) {}

Result<Deviation> Deviation::make(YieldingBody body, std::vector<std::unique_ptr<StandIn>> stand_ins,
                                  DeviationSettings s) {
  if (!(body.mass.mass > 0) || !(body.mass.inertia.diagonal().minCoeff() > 0))
    return usage_error("a body that yields needs its mass and moments of inertia", {}, "write mass under the primary");
  if (!(s.step > 0 && s.step <= 1.0 / 240)) return usage_error("the step of a hybrid pass is at most 1/240 s");
  if (!(s.tolerance > 0)) return usage_error("the tolerance of a hybrid pass must be above 0");
  if (!(s.omega > 0 && s.zeta >= 0 && s.window >= 0))
    return usage_error("coming back to the animation takes omega above 0, zeta and window of 0 or more");
  if (!(s.max_displacement > 0 && s.max_acceleration > 0))
    return usage_error("limits of displacement and acceleration must be above 0");
  if (!body.shape) body.shape = [](double) { return std::span<const ShapeSample>(); };
  return Deviation(std::move(body), std::move(stand_ins), s);
}

DeviationState Deviation::start(double time) const {
  DeviationState out;
  out.time = time;
  out.touched.assign(stand_ins_.size(), 0);
  return out;
}

std::vector<std::string> Deviation::untouched(const DeviationState& state) const {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < stand_ins_.size(); ++i)
    if (!state.touched[i]) out.push_back(stand_ins_[i]->spec().name);
  return out;
}

RigidMotion Deviation::adjusted(const DeviationState& s, const RigidMotion& clip) const {
  if (s.is_zero()) return clip;
  RigidMotion out = clip;
  out.pose.position += s.offset.position;
  out.velocity += s.velocity;
  out.pose.rotation = s.offset.rotation * clip.pose.rotation;
  const Vec3 momentum = world_inertia(body_.mass, clip.pose.rotation) * clip.spin + s.angular_momentum;
  out.spin = world_inertia(body_.mass, out.pose.rotation).ldlt().solve(momentum);
  return out;
}

/// Angular velocity of R_d [rad/s].
Vec3 Deviation::turning(const DeviationState& s, const RigidMotion& clip) const {
  if (s.is_zero()) return Vec3::Zero();
  return adjusted(s, clip).spin - s.offset.rotation * clip.spin;
}

StandInForce Deviation::force(const BodyState& body, std::vector<char>& touched) const {
  StandInForce out;
  for (std::size_t i = 0; i < stand_ins_.size(); ++i) {
    const StandInForce part = stand_ins_[i]->act(body);
    if (!part.wrench.force.isZero(0) || !part.wrench.torque.isZero(0)) touched[i] = 1;
    out += part;
  }
  const double acceleration = out.wrench.force.norm() / body.mass;
  if (acceleration > settings_.max_acceleration) out *= settings_.max_acceleration / acceleration;
  return out;
}

/// The clip in the middle of a step, where its support is to be replaced: what gives it this acceleration upwards on
/// top of gravity.
std::optional<RigidMotion> Deviation::carried(double upward, double middle) const {
  if (!(upward > k_least_support * settings_.gravity.norm())) return {};
  BodyState body;
  for (const auto& s : stand_ins_) {
    if (s->spec().support != Support::k_replace || middle < s->spec().from || middle >= s->spec().until) continue;
    if (body.mass == 0) {
      body.motion = body_.motion(middle), body.shape = body_.shape(middle);
      body.mass = body_.mass.mass, body.time = middle;
    }
    if (s->reaches(body, k_standing_distance)) return body.motion;
  }
  return {};
}

/// The deviation after h without stand-ins and without the way back.
DeviationState Deviation::drift(const DeviationState& from, const RigidMotion& clip, const RigidMotion& later,
                                double h) const {
  DeviationState out = from;
  out.time += h;
  out.offset.position += h * from.velocity;
  const Vec3 up = -settings_.gravity.normalized();
  // The support of the clip as what it changes: a landing may be an impulse within the step.
  const Vec3 change = later.velocity - clip.velocity - h * settings_.gravity;
  const double middle = from.time + 0.5 * h;
  if (const std::optional<RigidMotion> standing = carried(up.dot(change) / h, middle)) {
    const Vec3 way = later.pose.position - clip.pose.position - h * clip.velocity - 0.5 * h * h * settings_.gravity;
    const Vec3 yielding = settings_.move_axes.cwiseProduct(up);
    out.offset.position -= up.dot(way) * yielding;
    out.velocity -= up.dot(change) * yielding;
    // Its moment: all of the clip's but what friction has, which stays and acts at the lowest point.
    double lowest = 0;
    for (const ShapeSample& s : body_.shape(middle))
      lowest = std::min(lowest, up.dot(standing->pose.rotation * s.place));
    const Vec3 friction = body_.mass.mass * (change - up.dot(change) * up);
    Vec3 moment = world_inertia(body_.mass, later.pose.rotation) * later.spin -
                  world_inertia(body_.mass, clip.pose.rotation) * clip.spin - lowest * up.cross(friction);
    moment -= up.dot(moment) * up;
    out.angular_momentum -= settings_.turn_axes.cwiseProduct(moment);
  }
  if (!out.is_zero()) {
    const Vec3 first = turning(from, clip);
    DeviationState guess = out;
    guess.offset.rotation = rotation_by(h * first) * from.offset.rotation;
    out.offset.rotation = rotation_by(0.5 * h * (first + turning(guess, later))) * from.offset.rotation;
  }
  return out;
}

/// How much of the spring that brings the deviation back is there.
double Deviation::comeback_share(const DeviationState& state, bool touching, double middle) const {
  switch (settings_.comeback) {
    case Comeback::k_free: return 0;
    case Comeback::k_spring: return 1;
    case Comeback::k_hold: return touching ? 0 : 1;
    case Comeback::k_window:
      if (touching) return 0;
      return settings_.window > 0 ? std::clamp((middle - state.last_touch) / settings_.window, 0.0, 1.0) : 1;
  }
  return 0;
}

Deviation::Trial Deviation::attempt(const DeviationState& from, double h) const {
  const double middle = from.time + 0.5 * h;
  const RigidMotion clip = body_.motion(from.time), later = body_.motion(from.time + h);
  Trial out;
  out.end = drift(from, clip, later, h);
  DeviationState& end = out.end;
  BodyState body;  // the gate is judged in the middle: steps end on its edges
  body.mass = body_.mass.mass, body.time = middle;
  const RigidMotion begin = adjusted(from, clip), unforced = adjusted(end, later);
  body.acceleration = (unforced.velocity - begin.velocity) / h;
  body.spin_rate = (unforced.spin - begin.spin) / h;
  body.motion = begin, body.shape = body_.shape(from.time);
  const StandInForce start = force(body, end.touched);

  Mat6 mass = Mat6::Zero();
  mass.topLeftCorner<3, 3>() = body_.mass.mass * Mat3::Identity();
  mass.bottomRightCorner<3, 3>() = world_inertia(body_.mass, begin.pose.rotation);
  const Vec6 axes = stacked(settings_.move_axes, settings_.turn_axes);
  const Mat6 inverse_mass = axes.asDiagonal() * (mass + start.inertia).inverse() * axes.asDiagonal();
  const Vec6 w0 = stacked(start.wrench);
  const double share = comeback_share(from, !w0.isZero(0), middle);
  const bool back = settings_.comeback != Comeback::k_hold;
  const Mat6 k_back = back ? Mat6(share * settings_.omega * settings_.omega * mass) : Mat6(Mat6::Zero());
  const Mat6 c_back = share * 2 * settings_.zeta * settings_.omega * mass;

  const Vec6 v = stacked(begin.velocity, begin.spin), a = stacked(body.acceleration, body.spin_rate);
  const Vec6 d = stacked(from.offset.position, rotation_vector(from.offset.rotation));
  const Vec6 d_rate = stacked(from.velocity, turning(from, clip));
  const Vec6 d_rate_end = stacked(end.velocity, turning(end, later)), d_change = (d_rate_end - d_rate) / h;
  const Response r =
      respond(inverse_mass, start.stiffness + k_back, start.damping + c_back, w0 - k_back * d - c_back * d_rate,
              stacked(start.rate) - start.stiffness * v - start.damping * a - k_back * d_rate - c_back * d_change,
              -start.stiffness * a - k_back * d_change, h);

  end.offset.position += r.e.head<3>();
  end.velocity += r.rate.head<3>();
  end.offset.rotation = rotation_by(r.e.tail<3>()) * end.offset.rotation;
  end.angular_momentum += mass.bottomRightCorner<3, 3>() * r.rate.tail<3>();
  const RigidMotion motion = adjusted(end, later);
  body.motion = motion, body.shape = body_.shape(end.time);
  const Vec6 w1 = stacked(force(body, end.touched).wrench);

  const Vec6 moved = h * v + 0.5 * h * h * a + r.e;
  const Vec6 expected = w0 + h * stacked(start.rate) - start.stiffness * moved - start.damping * (h * a + r.rate);
  const Vec6 error = 0.5 * h * inverse_mass * (w1 - expected);
  out.error = std::max(error.head<3>().norm(), error.tail<3>().norm());
  if (!error.allFinite()) out.error = std::numeric_limits<double>::infinity();
  if (!w0.isZero(0) || !w1.isZero(0)) {
    end.last_touch = end.time;
    const Vec6 d_end = stacked(end.offset.position, rotation_vector(end.offset.rotation));
    out.impulse = mass * r.rate + 0.5 * h * k_back * (d + d_end) + c_back * (d_end - d);
    out.work = 0.5 * out.impulse.dot(v + stacked(motion.velocity, motion.spin));
    out.peak = std::max(w0.head<3>().norm(), w1.head<3>().norm());
  }
  return out;
}

Result<DeviationStep> Deviation::advance(DeviationState& state, double until) const {
  DeviationStep out;
  Vec6 impulse = Vec6::Zero();
  const double begin = state.time, shortest = std::ldexp(settings_.step, -k_halvings);
  double longest = settings_.step;
  while (state.time < until) {
    double end = std::min(state.time + longest, until);
    for (const auto& s : stand_ins_)
      for (const double edge : {s->spec().from, s->spec().until})
        if (edge > state.time && edge < end) end = edge;
    // A rest that is only rounding joins its step.
    if (until - end < 1e-9 * settings_.step) end = until;
    double h = end - state.time;
    Trial trial = attempt(state, h);
    while (trial.error > settings_.tolerance && h > shortest) trial = attempt(state, h /= 2);
    longest = std::min(settings_.step, 2 * h);
    if (!trial.end.offset.position.allFinite() || !trial.end.velocity.allFinite() ||
        !trial.end.angular_momentum.allFinite())
      return Error{ErrorKind::k_diverged,
                   fmt::format("the hybrid pass found no finite step at {:.4f} s", state.time),
                   {},
                   "a stand-in that is less stiff, or limit_force"};
    if (h == end - state.time) trial.end.time = end;
    state = std::move(trial.end);
    impulse += trial.impulse;
    out.work += trial.work;
    out.peak = std::max(out.peak, trial.peak);
    const double distance = state.offset.position.norm();
    if (distance > settings_.max_displacement) {
      const Vec3 outwards = state.offset.position / distance;
      state.offset.position = settings_.max_displacement * outwards;
      state.velocity -= std::max(0.0, state.velocity.dot(outwards)) * outwards;
    }
  }
  if (state.time > begin) {
    out.wrench.force = impulse.head<3>() / (state.time - begin);
    out.wrench.torque = impulse.tail<3>() / (state.time - begin);
  }
  out.motion = adjusted(state);
  return out;
}

}  // namespace ft::inline solvers
