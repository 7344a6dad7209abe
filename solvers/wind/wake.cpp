#include "solvers/wind/wake.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "baker/core/smooth_step.h"
#include "solvers/wind/plain_flows.h"

namespace ft::inline solvers {
namespace {

using std::numbers::pi;

/// Of a sphere with C_d = 1 and that drag area.
double radius_of(double drag_area) {
  return std::sqrt(drag_area / pi);
}

constexpr double k_birth_width = 0.6;  ///< sigma_0 by the radius: the wake is never faster than 0.7 U
constexpr double k_spread = 0.055;     ///< c: sigma = 0.7 theta (x / theta)^(1/3), theta^2 = C_d A / (2 pi)
constexpr double k_swirl = 0.3;        ///< of the vortices at their middle, by the wake's velocity there
constexpr double k_reach = 3.5;        ///< widths; beyond there is nothing
constexpr double k_slow = 0.1;         ///< at its middle; up to this it is over, from twice as much on whole [m/s]
constexpr double k_whole = 2, k_fading = 3;  ///< what ground and air around leave of it after some seconds [s]
constexpr double k_near = 3, k_far = 4;      ///< between so many radii the flow ahead fades out
constexpr double k_eddies = 1.5;             ///< length of the larger eddies, by the radius of the largest body

/// Share of a Gaussian of width 1 below z.
double below(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

/// What one interval left.
struct Puff {
  Vec3 middle, way, side, up;  ///< way, side and up of length 1
  double half = 0;             ///< of the piece of path [m]
  double width = 0;            ///< sigma [m]
  double flow = 0;             ///< velocity times area across [m3/s]
  double reach2 = 0;           ///< of it all from the middle, squared [m2]

  Vec3 velocity(const Vec3& place) const {
    const Vec3 r = place - middle;
    if (r.squaredNorm() > reach2) return Vec3::Zero();
    const double along = r.dot(way), y = r.dot(side) / width, z = r.dot(up) / width, s = along / width,
                 h = half / width;
    const double across = std::exp(-0.5 * (y * y + z * z));
    // The piece of path, smeared: its density along the path times its length is 1 in the midst of a long row of
    // pieces.
    const double density = below(s + h) - below(s - h);
    const double speed = flow / (2 * pi * width * width) * density * across;
    return speed * (way - k_swirl * ((1 - y * y) * up + y * z * side));
  }
};

struct Ahead {
  Vec3 centre, velocity;
  double radius = 0;

  Vec3 flow(const Vec3& place) const {
    const Vec3 r = place - centre;
    const double distance = r.norm();
    if (distance >= k_far * radius) return Vec3::Zero();
    const double speed = velocity.norm();
    const double facing = distance > 0 && speed > 0 ? r.dot(velocity) / (distance * speed) : 1;
    const double share =
        smooth_step((facing + 0.5) / 0.7) * (1 - smooth_step((distance / radius - k_near) / (k_far - k_near)));
    return share * doublet_velocity(r, velocity, radius);
  }
};

/// Puffs of one interval, and the box around them.
struct Batch {
  std::vector<Puff> puffs;
  Eigen::AlignedBox3d box;
};

class WakeNow final : public AirNow {
 public:
  std::vector<Batch> batches;
  std::vector<Ahead> ahead;
  std::vector<TurbulentWaves::Wave> waves;
  double turbulence = 0;

  Vec3 velocity(const Vec3& place) const override {
    Vec3 left = Vec3::Zero(), sum = Vec3::Zero();
    for (const Batch& batch : batches) {
      if (!batch.box.contains(place)) continue;
      for (const Puff& puff : batch.puffs) left += puff.velocity(place);
    }
    for (const Ahead& body : ahead) sum += body.flow(place);
    sum += left;
    const double speed = left.norm();
    if (speed > 0 && turbulence > 0) sum += turbulence * speed * TurbulentWaves::velocity(waves, place);
    return sum;
  }
};

/// Share of an interval that is over.
double done(const BodyPaths& bodies, int sample, double time) {
  return std::clamp((time - bodies.time_of(sample)) / bodies.interval(), 0.0, 1.0);
}

double largest_radius(const BodyPaths& bodies) {
  double out = 1e-3;
  for (const BodyPath& path : bodies.paths()) out = std::max(out, radius_of(path.drag_area));
  return out;
}

}  // namespace

Wake::Wake(WindFieldSpec given)
    : WindField(std::move(given)),
      waves_(k_eddies * largest_radius(*spec().bodies), 0.2 * spec().bodies->fastest(), Vec3::Zero(), spec().seed) {
  for (const BodyPath& path : spec().bodies->paths()) {
    std::vector<double>& ways = ways_.emplace_back(1, 0.0);
    for (std::size_t s = 1; s < path.centres.size(); ++s) {
      const double speed = 0.5 * (path.velocities[s - 1].norm() + path.velocities[s].norm());
      ways.push_back(ways.back() + spec().bodies->interval() * speed);
    }
  }
}

Result<std::unique_ptr<WindField>> Wake::make(const WindFieldSpec& spec) {
  if (!spec.bodies) return usage_error("a wake needs the body that makes it", spec.name);
  if (!(spec.turbulence >= 0)) return usage_error("turbulence must be 0 or more", spec.name);
  return std::unique_ptr<WindField>(std::make_unique<Wake>(spec));
}

double Wake::width(double drag_area, double way) {
  const double birth = k_birth_width * radius_of(drag_area);
  return std::cbrt(birth * birth * birth + k_spread * drag_area * way);
}

double Wake::fastest() const {
  return (3 + spec().turbulence * waves_.most()) * spec().bodies->fastest();
}

std::unique_ptr<AirNow> Wake::at_time(double time) const {
  const BodyPaths& bodies = *spec().bodies;
  auto out = std::make_unique<WakeNow>();
  out->waves = waves_.at_time(spec().clock + time);
  out->turbulence = spec().turbulence;
  const int last = std::clamp(static_cast<int>(std::floor((time - bodies.first_time()) / bodies.interval())), -1,
                              bodies.samples() - 2);
  std::vector<double> way_now(ways_.size());
  for (std::size_t b = 0; b < ways_.size(); ++b) {
    const BodyPath& path = bodies.paths()[b];
    const Vec3 velocity = bodies.velocity(path, time);
    if (velocity != Vec3::Zero())
      out->ahead.push_back({bodies.centre(path, time), velocity, radius_of(path.drag_area)});
    if (last >= 0) way_now[b] = std::lerp(ways_[b][at(last)], ways_[b][at(last + 1)], done(bodies, last, time));
  }
  for (int s = 0; s <= last; ++s) {
    Batch batch;
    const double share = done(bodies, s, time);
    for (std::size_t b = 0; b < ways_.size(); ++b) {
      const BodyPath& path = bodies.paths()[b];
      const Vec3 velocity = 0.5 * (path.velocities[at(s)] + path.velocities[at(s + 1)]);
      const double speed = velocity.norm();
      if (!(speed > k_slow)) continue;
      Puff puff;
      puff.width = width(path.drag_area, std::max(0.0, way_now[b] - ways_[b][at(s)]));
      puff.flow = 0.5 * speed * path.drag_area;
      puff.flow *= 1 - smooth_step((time - bodies.time_of(s) - k_whole) / k_fading);
      puff.flow *= smooth_step(puff.flow / (2 * pi * puff.width * puff.width) / k_slow - 1);
      if (puff.flow == 0) continue;
      const double length = share * speed * bodies.interval();
      puff.half = 0.5 * length;
      puff.way = velocity / speed;
      puff.middle = path.centres[at(s)] + 0.5 * share * (path.centres[at(s + 1)] - path.centres[at(s)]);
      const Vec3 up = std::abs(puff.way.y()) < 0.9 ? Vec3::UnitY() : Vec3::UnitX();
      puff.side = puff.way.cross(up).normalized();
      puff.up = puff.side.cross(puff.way);
      const double reach = k_reach * puff.width + puff.half;
      puff.reach2 = reach * reach;
      batch.box.extend(Eigen::AlignedBox3d(puff.middle - Vec3::Constant(reach), puff.middle + Vec3::Constant(reach)));
      batch.puffs.push_back(puff);
    }
    if (!batch.puffs.empty()) out->batches.push_back(std::move(batch));
  }
  return out;
}

}  // namespace ft::inline solvers
