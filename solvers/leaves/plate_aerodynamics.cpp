// See plate_aerodynamics.h. In the plate's axes, with w the velocity through the air, s the spin, M = m + added mass:
//
//   M w' = -s x M w + F + m R^T (g - u')        J s' = -s x J s - w x M w + T
//   F = sum over panels, with normal n, of  -1/2 rho S (A - B cos 2 alpha) |w| w + rho S C_T (w_n / |w|) (w_n w_t -
//   w_t^2 n)
//       + rho S C_R (a s) x w
//
// Runge-Kutta 4 after Lawson (1967): the drag that the plate has at the start of a step is taken out and integrated
// exactly.
#include "solvers/leaves/plate_aerodynamics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ft::inline solvers {
namespace {

constexpr double k_pi = std::numbers::pi;
/// Of the fastest of a plate's rates, a step [1]. Where strips begin to tumble is the same with 0.3 and 0.7.
constexpr double k_step = 0.5;
/// Spin about the normal is slowed by the edges alone [1].
constexpr double k_normal_damping = 0.05;

struct Rates {
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();  ///< 1/s, per axis
};

/// Coefficients of spin's damping: torque = -c * spin.
Vec3 spin_damping(const PlateModel& p, double speed, const Vec3& spin) {
  const auto across = [&](double a, double s) {
    return 0.5 * p.air_density * p.area * k_pi * a * a * a *
           (p.law.damping_speed * speed / a + p.law.damping_spin * std::abs(s));
  };
  const double a = p.half_chord[1];
  return {across(p.half_chord[0], spin[0]),
          k_normal_damping * p.air_density * p.area * a * a * (speed + a * std::abs(spin[1])),
          across(p.half_chord[2], spin[2])};
}

Vec3 panel_force(const PlateModel& p, const Vec3& w, double speed, const Vec3& normal) {
  const double along = w.dot(normal), squared = speed * speed;
  const Vec3 slide = w - along * normal;
  const double slide2 = squared - along * along;
  const double drag = 0.5 * (p.law.drag_a * squared - p.law.drag_b * (slide2 - along * along)) / speed;
  const double lift = p.law.lift_translation * along / speed;
  return p.air_density * p.area * (lift * (along * slide - slide2 * normal) - drag * w);
}

/// What the drag of now takes away, as rates.
Rates drag_rates(const PlateModel& p, const Vec3& w, const Vec3& spin) {
  const double speed = w.norm();
  const double half = 0.5 * p.air_density * p.area * speed;
  const double tangential = half * (p.law.drag_a - p.law.drag_b), normal = half * (p.law.drag_a + p.law.drag_b);
  return {Vec3(tangential, normal, tangential).cwiseQuotient(p.masses()),
          spin_damping(p, speed, spin).cwiseQuotient(p.inertias())};
}

/// The shortest of the times in which something about the plate changes, as a rate [1/s].
double fastest_rate(const PlateModel& p, const Vec3& w, const Vec3& spin) {
  const double speed = w.norm(), turning = spin.norm();
  const Vec3 masses = p.masses(), inertias = p.inertias();
  const double lightest = masses.minCoeff();
  const double drag =
      p.air_density * p.area * speed * std::max(p.law.lift_translation, 0.5 * p.law.face_on()) / lightest;
  const double lift = p.air_density * p.area * p.law.lift_rotation * p.half_chord.maxCoeff() * turning / lightest;
  const double munk = speed * std::sqrt(p.added_mass[1] / std::min(inertias[0], inertias[2]));
  return std::max({drag, lift, munk, turning});
}

struct Change {
  Vec3 place, velocity, spin;
  Eigen::Vector4d turn;
};

}  // namespace

PlateCoefficients strip_coefficients() {
  PlateCoefficients law;
  law.drag_a = 1.4;
  law.drag_b = 1.0;
  law.lift_translation = 1.2;
  law.lift_rotation = k_pi;
  law.damping_speed = law.damping_spin = 0.2;
  return law;
}

double PlateModel::terminal_speed(double gravity) const {
  return std::sqrt(2 * mass * gravity / (air_density * area * law.face_on()));
}

void add_air(PlateModel& p, bool finite, double thickness_ratio) {
  const double a = p.half_chord[0], b = p.half_chord[2], t2 = thickness_ratio * thickness_ratio;
  if (!finite) {
    const double length = p.area / (2 * a), per_length = k_pi * p.air_density * a * a * length;
    p.added_mass = Vec3(0, per_length, t2 * per_length);
    p.added_inertia = Vec3(per_length * a * a * (1 - t2) * (1 - t2) / 8, 0, 0);
    return;
  }
  // Of an ellipse with half axes a, b: 4/3 pi rho a b^2 / E(k), E by Ramanujan's length of its rim.
  const double big = 4 / k_pi * std::max(a, b), small = 4 / k_pi * std::min(a, b);
  const double rim = k_pi * (3 * (big + small) - std::sqrt((3 * big + small) * (big + 3 * small)));
  const double normal = 4.0 / 3 * k_pi * p.air_density * big * small * small / (rim / (4 * big));
  p.added_mass = Vec3(t2 * normal, normal, t2 * normal);
  // A disc has 2/15 of its added mass times r2; a long ellipse 1/10, about its length.
  const double length = 4 / k_pi * b, width = 4 / k_pi * a;
  p.added_inertia = 2.0 / 15 * normal * Vec3(width * width, 0, length * length);
}

PlateForce plate_force(const PlateModel& p, const Vec3& w, const Vec3& spin) {
  PlateForce out;
  const double speed = w.norm();
  if (speed > 1e-12) {
    if (p.fold == 0) {
      out.force = panel_force(p, w, speed, Vec3::UnitY());
    } else {
      // Each panel with its own velocity: then lift does no work, and a leaf gains nothing from its fold.
      const double c = std::cos(p.fold), n = std::sin(p.fold);
      for (const double side : {-1.0, 1.0}) {
        const Vec3 arm(0, 0, -side * p.panel_arm), at_panel = w + spin.cross(arm);
        const double panel_speed = at_panel.norm();
        if (panel_speed < 1e-12) continue;
        const Vec3 force = 0.5 * panel_force(p, at_panel, panel_speed, Vec3(0, c, side * n));
        out.force += force;
        out.torque += arm.cross(force);
      }
    }
    const Vec3 circulation(p.half_chord[0] * spin[0], 0, p.half_chord[2] * spin[2]);
    out.force += p.air_density * p.area * p.law.lift_rotation * circulation.cross(w);
  }
  out.torque -= spin_damping(p, speed, spin).cwiseProduct(spin);
  return out;
}

int advance_plate(const PlateModel& p, const Vec3& gravity, const PlateAir& air, double time, int most_steps,
                  PlateMotion& m) {
  const Vec3 masses = p.masses(), inertias = p.inertias();
  const Vec3 pull = gravity - air.change;
  int steps = 0;
  for (double done = 0; done < time;) {
    const double left = time - done;
    const double rate = fastest_rate(p, m.velocity, m.spin) + std::sqrt(pull.norm() / p.half_chord[1]);
    const int still = std::max(1, most_steps - steps);
    double h = std::max(k_step / rate, left / still);
    h = left / std::ceil(left / h - 1e-9);
    if (!(h > 0) || h > left) h = left;

    const Rates drag = drag_rates(p, m.velocity, m.spin);
    const auto decay = [&](const Vec3& r, double dt) { return Vec3(-dt * r).array().exp().matrix().eval(); };
    const Vec3 half_w = decay(drag.velocity, 0.5 * h), half_s = decay(drag.spin, 0.5 * h);
    const Vec3 full_w = half_w.cwiseProduct(half_w), full_s = half_s.cwiseProduct(half_s);
    const auto change = [&](double at_time, const Vec3& w, const Vec3& s, const Eigen::Vector4d& q) {
      Change out;
      const Quat turn(q);
      const PlateForce f = plate_force(p, w, s);
      const Vec3 momentum = masses.cwiseProduct(w);
      out.velocity = (f.force - s.cross(momentum)).cwiseQuotient(masses) +
                     (turn.conjugate() * pull).cwiseProduct(Vec3::Constant(p.mass).cwiseQuotient(masses)) +
                     drag.velocity.cwiseProduct(w);
      out.spin = (f.torque - s.cross(inertias.cwiseProduct(s)) - w.cross(momentum)).cwiseQuotient(inertias) +
                 drag.spin.cwiseProduct(s);
      out.place = turn * w + air.velocity + at_time * air.change;
      out.turn = 0.5 * (turn * Quat(0, s.x(), s.y(), s.z())).coeffs();
      return out;
    };
    const Vec3 w = m.velocity, s = m.spin;
    const Eigen::Vector4d q = m.turn.coeffs();
    const Change k1 = change(done, w, s, q);
    const Change k2 = change(done + 0.5 * h, half_w.cwiseProduct(w + 0.5 * h * k1.velocity),
                             half_s.cwiseProduct(s + 0.5 * h * k1.spin), q + 0.5 * h * k1.turn);
    const Change k3 = change(done + 0.5 * h, half_w.cwiseProduct(w) + 0.5 * h * k2.velocity,
                             half_s.cwiseProduct(s) + 0.5 * h * k2.spin, q + 0.5 * h * k2.turn);
    const Change k4 = change(done + h, full_w.cwiseProduct(w) + h * half_w.cwiseProduct(k3.velocity),
                             full_s.cwiseProduct(s) + h * half_s.cwiseProduct(k3.spin), q + h * k3.turn);
    m.velocity = full_w.cwiseProduct(w + h / 6 * k1.velocity) + h / 3 * half_w.cwiseProduct(k2.velocity + k3.velocity) +
                 h / 6 * k4.velocity;
    m.spin =
        full_s.cwiseProduct(s + h / 6 * k1.spin) + h / 3 * half_s.cwiseProduct(k2.spin + k3.spin) + h / 6 * k4.spin;
    m.place += h / 6 * (k1.place + 2 * (k2.place + k3.place) + k4.place);
    m.turn.coeffs() = q + h / 6 * (k1.turn + 2 * (k2.turn + k3.turn) + k4.turn);
    m.turn.normalize();
    // Where steps are as long as they are allowed to be and too long for the plate: it can gain no more energy than
    // gravity and the air's change give.
    if (h * rate > 1) {
      const auto energy = [&](const Vec3& v, const Vec3& t) {
        return v.dot(masses.cwiseProduct(v)) + t.dot(inertias.cwiseProduct(t));
      };
      const double most = std::sqrt(energy(w, s)) + std::sqrt(p.mass) * pull.norm() * h;
      const double now = std::sqrt(energy(m.velocity, m.spin));
      if (!(now < 1e100) || !m.turn.coeffs().allFinite()) {
        m.velocity.setZero(), m.spin.setZero();
        m.turn.coeffs() = q;
      } else if (now > most) {
        m.velocity *= most / now, m.spin *= most / now;
      }
    }
    if (!m.place.allFinite()) m.place = m.place.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
    ++steps;
    done += h;
    if (left - h <= 1e-12 * time) break;
  }
  return steps;
}

}  // namespace ft::inline solvers
