// See leaves_solver.h: setting up, states, and the walk of a frame. What one leaf does in it is in leaf_flight.cpp.
#include "solvers/leaves/leaves_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "baker/core/output_frame.h"
#include "baker/core/parallel.h"
#include "baker/core/random.h"
#include "baker/core/state_points.h"
#include "baker/core/volume.h"
#include "solvers/leaves/leaf_frame.h"
#include "solvers/leaves/leaf_sleep.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_block = 16;
/// A leaf is kept at least so far away [m]; each has up to as much again for itself.
constexpr double k_margin = 0.6e-3;
/// Of a sleeping leaf: a moving body that comes so near wakes it [m].
constexpr double k_approach = 0.01;
/// A leaf that bends may reach so much farther from its centre of mass, which is then not in its middle [1].
constexpr double k_bent_radius = 1.3;

}  // namespace

Result<std::unique_ptr<LeavesSolver>> LeavesSolver::make(LeavesSetup setup) {
  const auto refuse = [&](const std::string& what) {
    return usage_error(fmt::format("leaves \"{}\": {}", setup.name, what));
  };
  if (!(setup.fps > 0) || !(setup.air_density > 0)) return refuse("fps and air density must be positive");
  if (!(setup.bending >= 0 && setup.bending < 1e6))
    return refuse("bending stiffness must be 0 or more, and below 1e6 N m");
  if (!(setup.mass_variation >= 0 && setup.mass_variation <= 0.9)) return refuse("mass variation is 0 to 0.9");
  for (const LeafPrototype& p : setup.prototypes) {
    double area = 0;
    if (p.positions.size() < 3 || p.positions.size() > 64 || !all_finite(p.positions))
      return refuse("a prototype has 3 to 64 vertices");
    for (const Triangle& t : p.triangles) {
      for (const int v : t)
        if (v < 0 || at(v) >= p.positions.size())
          return refuse("a prototype's triangle names a vertex that is not there");
      area += triangle_area(p.positions[at(t[0])], p.positions[at(t[1])], p.positions[at(t[2])]);
    }
    if (!(area > 0)) return refuse("a prototype has no area");
    if (!(p.mass_per_area > 0) || !(p.lying_lift > 0)) return refuse("a prototype's mass and lift must be positive");
  }
  for (const Leaf& l : setup.leaves) {
    if (l.prototype < 0 || at(l.prototype) >= setup.prototypes.size()) return refuse("a leaf has no prototype");
    if (!(l.scale > 0) || !l.position.allFinite() || !(l.orientation.norm() > 0.5))
      return refuse("a leaf has no size, place or orientation");
  }
  for (const LeafWater& water : setup.waters)
    if (const std::string fault = LeafWaters::fault_of(water); !fault.empty()) return refuse(fault);
  return std::unique_ptr<LeavesSolver>(new LeavesSolver(std::move(setup)));
}

LeavesSolver::LeavesSolver(LeavesSetup setup)
    : setup_(std::move(setup)), bodies_(setup_.bodies), waters_(setup_.waters) {
  for (const LeafPrototype& p : setup_.prototypes) shapes_.push_back(shape_of(p));
  const double gravity = setup_.gravity.norm();
  slowest_lift_off_ = std::numeric_limits<double>::infinity();
  for (const Leaf& leaf : setup_.leaves) {
    const LeafPrototype& prototype = setup_.prototypes[at(leaf.prototype)];
    const RandomKey key{setup_.seed, 0x1eaf, 0, static_cast<std::uint64_t>(leaf.id)};
    Model m;
    m.mass_factor = 1 + setup_.mass_variation * (2 * random_uniform(key) - 1);
    m.plate = plate_of(prototype, shapes_[at(leaf.prototype)], leaf.scale, m.mass_factor, setup_.air_density);
    m.shape = shapes_[at(leaf.prototype)];
    for (Vec3& p : m.shape.positions) p *= leaf.scale;
    m.shape.radius *= leaf.scale;
    m.floating = floating_plate(m.plate, m.shape.positions, gravity);
    if (setup_.bending > 0) {
      m.bending = bending_of(m.shape, m.plate, setup_.bending);
      m.shape.radius *= k_bent_radius;
    }
    m.margin = k_margin * (1 + random_uniform(key, 1));
    slowest_lift_off_ = std::min(slowest_lift_off_, lift_off_speed(prototype, m.mass_factor, lowest_friction(setup_),
                                                                   gravity, setup_.air_density));
    leaves_.push_back(std::move(m));
  }
  instances_ = instances_of(setup_);
  if (setup_.bending > 0) mesh_ = mesh_of(setup_);
}

State LeavesSolver::initial_state() const {
  State state;
  state.frame = setup_.first_frame - setup_.preroll_frames;
  state.time = -setup_.preroll_frames / setup_.fps;
  std::vector<double> x, q, asleep;
  for (const Leaf& leaf : setup_.leaves) {
    const Quat turn = leaf.orientation.normalized();
    x.insert(x.end(), {leaf.position.x(), leaf.position.y(), leaf.position.z()});
    q.insert(q.end(), {turn.x(), turn.y(), turn.z(), turn.w()});
    asleep.push_back(leaf.asleep && setup_.may_sleep ? 1 : 0);
  }
  const std::size_t n = setup_.leaves.size();
  state.set("x", std::move(x));
  state.set("q", std::move(q));
  state.set("v", std::vector<double>(3 * n));
  state.set("spin", std::vector<double>(3 * n));
  state.set("asleep", std::move(asleep));
  state.set("rest", std::vector<double>(n));
  if (setup_.bending > 0) {
    state.set("bent", std::vector<double>(2 * n));
    state.set("bending", std::vector<double>(2 * n));
  }
  if (waters_.any()) state.set("afloat", std::vector<double>(n));
  return state;
}

void LeavesSolver::leaf_states(const State& state, std::span<LeafState> out) const {
  CHECK(out.size() == leaves_.size());
  const auto &x = *state.find("x"), &q = *state.find("q"), &v = *state.find("v"), &spin = *state.find("spin"),
             &asleep = *state.find("asleep");
  const auto* afloat = state.find("afloat");
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Leaf& leaf = setup_.leaves[i];
    out[i] = {leaf.id,
              leaf.prototype,
              leaf.scale,
              as_points(x)[i],
              Quat(q[4 * i + 3], q[4 * i], q[4 * i + 1], q[4 * i + 2]),
              as_points(v)[i],
              as_points(spin)[i],
              asleep[i] != 0,
              afloat && (*afloat)[i] != 0};
  }
}

LeavesSolver::Moving LeavesSolver::moving(const State& state, std::size_t i) const {
  const auto& q = *state.find("q");
  Moving m{as_points(*state.find("x"))[i], as_points(*state.find("v"))[i], as_points(*state.find("spin"))[i],
           Quat(q[4 * i + 3], q[4 * i], q[4 * i + 1], q[4 * i + 2])};
  if (setup_.bending > 0) {
    const auto &bent = *state.find("bent"), &bending = *state.find("bending");
    m.bent = Modes(bent[2 * i], bent[2 * i + 1]);
    m.bending = Modes(bending[2 * i], bending[2 * i + 1]);
  }
  if (waters_.any()) m.afloat = static_cast<Afloat>((*state.find("afloat"))[i]);
  return m;
}

void LeavesSolver::system_positions(const State& state, int, std::span<Vec3> positions) const {
  std::vector<Vec3> places;
  std::size_t next = 0;
  for (std::size_t i = 0; i < leaves_.size(); ++i) {
    place_leaf(leaves_[i], moving(state, i), places);
    CHECK(next + places.size() <= positions.size());
    for (const Vec3& p : places) positions[next++] = p;
  }
}

void LeavesSolver::system_frame(const State& state, int, FrameData& frame) const {
  std::vector<LeafState> leaves(leaves_.size());
  leaf_states(state, leaves);
  frame = {};
  for (const LeafState& leaf : leaves) {
    frame.positions.push_back(leaf.position.cast<float>());
    frame.velocities.push_back(leaf.velocity.cast<float>());
    frame.orientations.push_back(leaf.orientation.cast<float>().normalized());
    frame.angular_velocities.push_back(leaf.angular_velocity.cast<float>());
    frame.scales.push_back(Vec3f::Constant(static_cast<float>(leaf.scale)));
  }
}

/// Whether anything that moves comes near a sleeping leaf in this frame.
bool LeavesSolver::is_approached(const Vec3& place, double radius) const {
  for (int body = 0; body < bodies_.count(); ++body) {
    if (!bodies_.moves(body)) continue;
    const Vec3 reach = Vec3::Constant(radius + k_approach);
    if (!Box{place - reach, place + reach}.overlaps(bodies_.box(body))) continue;
    for (int slice = 0; slice < LeafBodies::k_slices; ++slice) {
      const Vec3 grown = reach + Vec3::Constant(bodies_.way(body, slice));
      const auto now = bodies_.places(body, slice), before = bodies_.places(body, slice - 1);
      bool near = false;
      bodies_.tree(body, slice).for_each_near(TreeBox::around(place - grown, place + grown), [&](int t) {
        if (near) return;
        Box box;
        for (const int v : bodies_.triangles(body)[at(t)]) box.include(now[at(v)]), box.include(before[at(v)]);
        near = box.overlaps(Box{place - reach, place + reach});
      });
      if (near) return true;
    }
  }
  return false;
}

/// Whether water has come up to a sleeping leaf by the frame's end.
bool LeavesSolver::is_reached(const Model& model, const Moving& m) const {
  const auto water = waters_.under(m.x, model.floating.reach, LeafBodies::k_slices - 1, 1, false);
  if (!water) return false;
  const double depth = float_depth(model.floating, *water, floating(m), model.margin);
  return next_afloat(Afloat::k_no, depth, -depth, true) != Afloat::k_no;
}

/// Sleeping leaves that the wind, a body or water gets hold of.
void LeavesSolver::wake(const Frame& frame, State& state, FrameReport& report) const {
  const auto& asleep = *state.find("asleep");
  const auto x = as_points(*state.find("x"));
  bool any_moves = false;
  for (int b = 0; b < bodies_.count(); ++b) any_moves = any_moves || bodies_.moves(b);
  const bool ask_wind = frame.has_wind && setup_.wind->fastest() > slowest_lift_off_;
  std::vector<char> hold(leaves_.size(), 0);  // of the wind 1, of a body or water 2
  if (any_moves || ask_wind || waters_.any())
    parallel_for(leaves_.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (asleep[i] == 0) continue;
        if (any_moves && is_approached(x[i], leaves_[i].shape.radius)) hold[i] = 2;
        if (hold[i] == 0 && waters_.any() && is_reached(leaves_[i], moving(state, i))) hold[i] = 2;
        if (hold[i] != 0 || !ask_wind) continue;
        const Vec3 u = frame.air[LeafBodies::k_slices]->velocity(x[i]);
        const double speed2 = u.squaredNorm();
        if (speed2 <= slowest_lift_off_ * slowest_lift_off_) continue;
        const double own = lift_off_speed(setup_.prototypes[at(setup_.leaves[i].prototype)], leaves_[i].mass_factor,
                                          lowest_friction(setup_), setup_.gravity.norm(), setup_.air_density);
        if (speed2 > own * own) hold[i] = 1;
      }
    });
  int lifted = 0, woken = 0;
  for (std::size_t i = 0; i < leaves_.size(); ++i) {
    if (hold[i] != 0) {
      (hold[i] == 1 ? lifted : woken)++;
      state.block("asleep")[i] = 0;
      state.block("rest")[i] = 0;
    }
  }
  report.own["leaves_lifted"] = lifted;
  report.own["leaves_woken"] = woken;
}

void LeavesSolver::add_forces(const Frame& frame, std::span<const Wrench> impulses, FrameReport& report) const {
  const std::size_t bodies = setup_.bodies.size(), met = bodies + setup_.grounds.size();
  const double frame_time = frame.t1 - frame.t0, slice_time = frame_time / LeafBodies::k_slices;
  for (std::size_t b = 0; b < met; ++b) {
    InteractionForce& row = report.forces.emplace_back();
    row.system = setup_.name;
    row.primary = b < bodies ? setup_.bodies[b].name : setup_.grounds[b - bodies].name;
    for (std::size_t k = b; k < impulses.size(); k += met) {
      if (impulses[k].force.isZero(0)) continue;
      row.mean += (1 / frame_time) * impulses[k];
      row.peak = std::max(row.peak, impulses[k].force.norm() / slice_time);
      row.contact_share += 1.0 / LeafBodies::k_slices;
    }
    if (b < bodies && row.contact_share > 0) {
      const int body = static_cast<int>(b);
      row.mean = row.mean.moved(volume_centre(bodies_.places(body, LeafBodies::k_slices - 1), bodies_.triangles(body)));
    }
  }
}

FrameReport LeavesSolver::advance_frame(State& state) {
  const auto clock = std::chrono::steady_clock::now();
  FrameReport report;
  report.frame = state.frame + 1;
  report.smallest_gap = std::numeric_limits<double>::infinity();  // not measured
  Frame frame;
  frame.t0 = (state.frame - setup_.first_frame) / setup_.fps;
  frame.t1 = (report.frame - setup_.first_frame) / setup_.fps;
  bodies_.begin_frame(frame.t0, frame.t1);
  waters_.begin_frame(frame.t0, frame.t1);
  frame.has_wind = setup_.wind && !setup_.wind->is_still();
  if (frame.has_wind) {
    for (int k = 0; k <= LeafBodies::k_slices; ++k)
      frame.air.push_back(setup_.wind->at_time(frame.t0 + (frame.t1 - frame.t0) * k / LeafBodies::k_slices));
  }
  wake(frame, state, report);
  std::vector<std::size_t> awake;
  const auto& asleep_before = *state.find("asleep");
  for (std::size_t i = 0; i < leaves_.size(); ++i)
    if (asleep_before[i] == 0) awake.push_back(i);
  Tally sum;
  if (!awake.empty()) {
    auto &x = state.block("x"), &q = state.block("q"), &v = state.block("v"), &spin = state.block("spin"),
         &asleep = state.block("asleep"), &rest = state.block("rest");
    const bool bends = setup_.bending > 0;
    double* afloat = waters_.any() ? state.block("afloat").data() : nullptr;
    double *bent = bends ? state.block("bent").data() : nullptr,
           *bending = bends ? state.block("bending").data() : nullptr;
    sum = parallel_sum(awake.size(), k_block, Tally{}, [&](std::size_t begin, std::size_t end) {
      Tally part;
      for (std::size_t k = begin; k < end; ++k) {
        const std::size_t i = awake[k];
        Moving m = moving(state, i);
        part = part + advance_leaf(frame, i, m, rest[i], asleep[i]);
        as_points(x)[i] = m.x;
        as_points(v)[i] = m.v;
        as_points(spin)[i] = m.spin;
        for (int c = 0; c < 4; ++c) q[4 * i + at(c)] = m.q.coeffs()[c];
        if (afloat) afloat[i] = static_cast<double>(m.afloat);
        for (std::size_t c = 0; bends && c < 2; ++c) {
          bent[2 * i + c] = m.bent[static_cast<int>(c)];
          bending[2 * i + c] = m.bending[static_cast<int>(c)];
        }
      }
      return part;
    });
  }
  report.substeps = sum.longest;
  report.crossings_body = report.crossings_drawn = sum.crossings;
  report.inside_body = sum.inside;
  report.deepest_drawn = sum.deepest;
  report.kinetic_energy = sum.energy;
  report.finite = sum.finite;
  add_forces(frame, sum.impulses, report);
  report.own["leaves_awake"] = sum.awake;
  report.own["leaves_brought_out"] = sum.brought_out;
  report.own["leaves_fastest"] = sum.fastest;
  report.own["leaf_steps"] = sum.steps;
  if (waters_.any()) report.own["leaves_afloat"] = sum.afloat;
  if (sum.crossings > 0 || sum.inside > 0) {
    Incident& incident = report.incidents.emplace_back();
    incident.kind = Incident::Kind::k_crossing;
    incident.frame = report.frame;
    incident.system = setup_.name;
    incident.text =
        fmt::format("{} edges of leaves cross a body, and {} leaves are inside one", sum.crossings, sum.inside);
  }
  state.frame = report.frame;
  state.time = frame.t1;
  report.profile.total = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return report;
}

}  // namespace ft::inline solvers
