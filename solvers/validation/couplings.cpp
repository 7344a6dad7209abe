// Ropes, rigid props, stand-ins, and what follows on a spring.
#include <cmath>
#include <numbers>

#include "baker/core/equimomental.h"
#include "baker/core/shapes.h"
#include "baker/core/state_points.h"
#include "solvers/cords/generators.h"
#include "solvers/follow/damped_oscillator.h"
#include "solvers/lockstep/lockstep_solver.h"
#include "solvers/standins/deviation.h"
#include "solvers/standins/registry.h"
#include "solvers/validation/scenes.h"

namespace ft::inline solvers {
namespace {

constexpr double k_g = 9.81;

/// The state after so many frames; nothing where the setup is refused.
State walked(const LockstepSetup& setup, int frames) {
  auto solver = make_lockstep_solver(setup);
  if (!solver) return {};
  State state = (*solver)->initial_state();
  for (int f = 0; f < frames; ++f) (*solver)->advance_frame(state);
  return state;
}

/// Sag of a catenary of this length between two points at one height.
double catenary_sag(double span, double length) {
  double low = 1e-3, high = 100;  // of a, where 2 a sinh(span / 2a) = length
  for (int k = 0; k < 200; ++k) {
    const double a = 0.5 * (low + high);
    (2 * a * std::sinh(span / (2 * a)) > length ? low : high) = a;
  }
  return low * (std::cosh(span / (2 * low)) - 1);
}

}  // namespace

std::vector<ValidationCase> validate_rope() {
  const double span = 1, length = 1.2, mass = 0.6;
  RopeMeasures measures;
  measures.to = Vec3(length, 0, 0);
  measures.pieces = 120;
  CordSystem rope;
  rope.name = "rope";
  rope.graph = ft::rope(measures);
  const double drop = std::sqrt(length * length - span * span) / 2;
  for (Vec3& p : rope.graph.points) {  // hung as a V
    const double s = 2 * p.x() / length - 1;
    p = Vec3(0.5 * span * (1 + s), -(1 - std::abs(s)) * drop, 0);
  }
  rope.graph.held = {0, measures.pieces};
  rope.mass = mass;
  rope.stretch = 1e5;
  rope.damping = 1e-2;
  rope.hold_stiffness = 1e6;
  LockstepSetup setup;
  setup.cords = {rope};
  setup.preroll_frames = 0;
  setup.gravity = Vec3(0, -k_g, 0);
  setup.air_density = 50;  // thick, so that it comes to rest
  setup.longest_step = 1.0 / 240;
  setup.bdf2 = false;
  const State at_rest = walked(setup, 24 * 6), later = walked(setup, 24 * 7);
  const double sag = -as_points(*at_rest.find("x"))[at(measures.pieces / 2)].y(), formula = catenary_sag(span, length);
  const double pull = (as_points(*later.find("hold_impulse"))[0] - as_points(*at_rest.find("hold_impulse"))[0]).y();
  return {validation_case("rope", "sag of a rope of 1.2 m between points 1 m apart", sag, formula, 0.005 * formula, "m",
                          "catenary"),
          validation_case("rope", "what its ends hold", pull, mass * k_g, 1e-3 * mass * k_g, "N", "its weight")};
}

std::vector<ValidationCase> validate_prop_flight() {
  const double seconds = 0.5, spin = 7;
  const TriangleSurface box = box_surface(Vec3(0.2, 0.3, 0.5));
  const BodyMass filled = filled_mass(box.positions, box.triangles, 2);
  RigidProp prop;
  prop.name = "box";
  prop.surface = box.positions;
  prop.triangles = box.triangles;
  prop.mass = filled.mass;
  prop.two_way = true;
  prop.release = 0;
  prop.track = [=](double time) {
    RigidMotion m;
    m.velocity = Vec3(1, 3, 0);
    m.spin = Vec3(0, 0, spin);  // about the axis of its smallest moment: it does not tumble
    m.pose.position = time * m.velocity;
    m.pose.rotation = Quat(Eigen::AngleAxisd(spin * time, Vec3::UnitZ()));
    return m;
  };
  RopeMeasures far;
  far.from = Vec3(50, 0, 0), far.to = Vec3(51, 0, 0), far.pieces = 1;
  CordSystem rope;  // there are no props without cords
  rope.name = "rope";
  rope.graph = ft::rope(far);
  rope.mass = 0.1;
  LockstepSetup setup;
  setup.cords = {rope};
  setup.prop = prop;
  setup.preroll_frames = 0;
  setup.gravity = Vec3(0, -k_g, 0);
  const State end = walked(setup, static_cast<int>(std::lround(24 * seconds)));
  const auto x = as_points(*end.find("x"));
  Vec3 centre = Vec3::Zero();
  for (std::size_t k = 0; k < 4; ++k) centre += x[x.size() - 4 + k] / 4;
  const double height = 3 * seconds - 0.5 * k_g * seconds * seconds;
  const auto v = as_points(*end.find("v"));
  Vec3 momentum = Vec3::Zero();  // angular, of the four equal masses
  for (std::size_t k = 0; k < 4; ++k)
    momentum += filled.mass.mass / 4 * (x[x.size() - 4 + k] - centre).cross(v[v.size() - 4 + k]);
  const double whole = filled.mass.inertia(2, 2) * spin;
  return {validation_case("prop_flight", "height of a thrown box after 0.5 s", centre.y(), height, 2e-3, "m",
                          "x = v t - g t^2 / 2"),
          validation_case("prop_flight", "distance that it flew", centre.x(), seconds, 1e-6, "m", "no force along x"),
          validation_case("prop_flight", "angular momentum that it keeps", momentum.z() / whole, 1, 1e-3, "1",
                          "no torque")};
}

std::vector<ValidationCase> validate_mat() {
  const double mass = 60, stiffness = 20e3, height = 1;
  StandInSpec spec;
  spec.name = spec.kind = "mat";
  spec.support = Support::k_replace;
  spec.size = Vec3(4, 0, 4);
  spec.stiffness = stiffness, spec.damping_ratio = 1;
  std::vector<ShapeSample> soles(4);
  for (std::size_t i = 0; i < soles.size(); ++i) {
    soles[i].place = Vec3(i % 2 ? 0.1 : -0.1, -height, i < 2 ? 0.1 : -0.1);
    soles[i].normal = Vec3(0, -1, 0), soles[i].area = 0.01;
  }
  YieldingBody body{{mass, 10 * Mat3::Identity()},
                    [&](double) {
                      RigidMotion m;
                      m.pose.position.y() = height;
                      return m;
                    },
                    [&](double) { return std::span<const ShapeSample>(soles); }};
  DeviationSettings settings;
  settings.gravity = Vec3(0, -k_g, 0);
  double sunk = std::nan("");
  std::vector<std::unique_ptr<StandIn>> acting;
  if (auto mat = make_stand_in(spec)) acting.push_back(std::move(*mat));
  if (auto deviation = Deviation::make(std::move(body), std::move(acting), settings)) {
    DeviationState state = deviation->start(0);
    if (deviation->advance(state, 5)) sunk = -state.offset.position.y();
  }
  const double formula = mass * k_g / stiffness;
  return {validation_case("mat", "depth to which 60 kg that stand on a mat sink", sunk, formula, 1e-3 * formula, "m",
                          "m g / k")};
}

std::vector<ValidationCase> validate_follow() {
  const double omega = 2 * std::numbers::pi * 2, zeta = 0.3;
  const DampedOscillator spring{omega, zeta};
  // Two crossings of zero in one direction are a period apart; two crests fall by the logarithmic decrement.
  DampedOscillator::Lag lag{Vec3::Zero(), Vec3(1, 0, 0)};
  const double damped = omega * std::sqrt(1 - zeta * zeta), period = 2 * std::numbers::pi / damped;
  spring.advance(lag, period);
  const double at_zero = lag.position.x(), left = lag.velocity.x();
  const double decrement = std::exp(-2 * std::numbers::pi * zeta / std::sqrt(1 - zeta * zeta));
  return {validation_case("follow", "lag a period after it was zero, in one step", at_zero, 0, 1e-14, "m",
                          "damped oscillator"),
          validation_case("follow", "what is left of its speed then", left, decrement, 1e-14, "1",
                          "logarithmic decrement")};
}

}  // namespace ft::inline solvers
