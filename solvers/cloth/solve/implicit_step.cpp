#include "solvers/cloth/solve/implicit_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "baker/core/give_back.h"
#include "baker/core/parallel.h"
#include "baker/core/stopwatch.h"
#include "solvers/cloth/solve/implicit_step_scratch.h"
#include "solvers/cloth/solve/step_measures.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_block = 512;  ///< of a loop over vertices
/// Newton stops when nothing moves further than this share of the contact radius.
constexpr double k_still = 1e-4;
/// Newton goes on beyond the wanted iterations, up to so many times as many, while an iteration strains the edges by
/// more than StepInput::settled_strain, or would without truncation and is not stuck, or had to be halved, or moves a
/// garment that the body does not hold by more than k_settled_drift, or leaves cloth creeping: cloth that is pulled
/// tight or has edges of all lengths needs it, and cloth that falls along cloth would hang in the air.
constexpr int k_most_times = 5;
/// Stuck is what wins less than this share of the energy that its direction promised before truncation, to the first
/// order, of which a step that is done whole wins half: cloth jammed against cloth, which no iteration frees [1].
constexpr double k_stuck = 0.05;
/// Of what gravity moves in the step, h2 g: the force on the garment as a whole is then right to a tenth of its weight.
/// Where the body holds it, by contact or pins, what is wrong in one step is put right in the next; else the garment
/// keeps the momentum.
constexpr double k_settled_drift = 0.05;
/// Friction that holds cloth is found from one iteration to the next, and what is left of its slip would let cloth
/// creep for ever. Cloth that moves less in a step than a share of what gravity moves in it, root mean square, may rest
/// soon: there an iteration may move it by no more than k_settled_creep of what the step does. On bodies that stand
/// still the share is the larger one: what is left of each step keeps cloth awake there, and nothing else does [1].
constexpr double k_may_rest = 0.25, k_may_rest_on_still = 0.7, k_settled_creep = 0.03;
/// A step is halved until the potential goes down, but no oftener: contacts that come into reach on the way are not in
/// the direction, and cloth that glides over edges would stop there for good.
constexpr int k_most_halvings = 4;
/// Truncation and lagged friction leave the exact descent direction: a rise by this share is no reason to halve.
constexpr double k_tolerated_rise = 1e-3;
constexpr double k_energy_noise = 1e-9;  ///< rounding of the potential [J]

}  // namespace

ImplicitStep::ImplicitStep(const ClothModel& model) : scratch_(std::make_unique<Scratch>(model)), model_(model) {}
ImplicitStep::~ImplicitStep() = default;

StepResult ImplicitStep::solve(const StepInput& in, std::span<Vec3> all, std::span<Vec3> v_out) {
  Scratch& s = *scratch_;
  const std::size_t n = at(model_.vertex_count());
  const bool multistep = model_.setup.bdf2;
  const IntegratorWeights w = multistep ? blended_weights(in.h, in.h_previous, in.h_older) : IntegratorWeights{};
  // What damps needs the rate of strains, of which two points back are known.
  const IntegratorWeights rate = multistep ? bdf2_weights(in.h, in.h_previous) : IntegratorWeights{};
  const double bh = w.beta * in.h;
  const double inertia = 1.0 / (bh * bh);
  StepResult result;
  Stopwatch watch;

  StepContext context;
  context.h = in.h;
  context.beta_h = rate.beta * in.h;
  context.x_t0 = in.x_t0;
  context.v_t0 = in.v_t0;
  context.x_tm1 = in.x_tm1;
  context.a = rate.a;
  context.b = rate.b;
  context.time = in.time;
  for (const auto& energy : model_.energies) energy->begin_step(context);

  const auto past = [&](std::size_t i) -> Vec3 { return w.a * in.x_t0[i] - w.b * in.x_tm1[i] + w.c * in.x_tm2[i]; };
  s.y = v_out;
  parallel_for(n, k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      s.y[i] =
          past(i) + bh * (w.a * in.v_t0[i] - w.b * in.v_tm1[i] + w.c * in.v_tm2[i]) + bh * bh * model_.setup.gravity;
      if (!in.push.empty()) s.y[i] += bh * bh * in.push[i];
    }
  });

  s.pins.clear();
  for (std::size_t p = 0; p < model_.pins.size(); ++p) {
    const std::size_t v = at(model_.pins[p].vertex);
    s.pins.emplace_back(model_.pins[p], in.x_t0[v], in.v_t0[v], in.pin_target[p], in.pin_motion[p], in.h, in.time);
  }
  s.touches.assign(model_.setup.garments.size(), 0);
  for (std::size_t p = 0; p < model_.pins.size(); ++p)
    if (s.pins[p].holds() && !model_.pins[p].to_world) s.touches[at(model_.garment_of(model_.pins[p].vertex))] = 1;

  const auto cloth = [&](std::span<Vec3> of_all) { return of_all.first(n); };
  /// All of the potential but contact, which changes from iteration to iteration where the cloth does not.
  const auto potential_of_cloth = [&](std::span<const Vec3> x) {
    double e = parallel_sum(n, k_block, 0.0, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i) sum += model_.mass[i] * (x[i] - s.y[i]).squaredNorm();
      return sum;
    });
    e *= 0.5 * inertia;
    for (const auto& energy : model_.energies) e += energy->value(x);
    for (std::size_t p = 0; p < model_.pins.size(); ++p)
      if (s.pins[p].holds()) e += s.pins[p].energy(x[at(model_.pins[p].vertex)]);
    for (const Pull& pull : in.pulls) e += pull.energy(x);
    return e;
  };

  double smallest_radius = 1e-3;
  for (const double r : model_.contact.radius) smallest_radius = std::min(smallest_radius, r);
  ContactPotential& contact = s.contact.emplace(model_.contact);
  contact.begin(*in.pairs, in.all_start, in.h, in.friction_share);
  contact.update(all);
  result.seconds_contact += watch.lap();

  const double gravity = model_.setup.gravity.norm();
  const double fall = in.h * in.h * gravity;
  const double settled_drift = gravity > 0 ? k_settled_drift * fall : std::numeric_limits<double>::infinity();
  const bool on_still = mean_distance(in.all_start.subspan(n), all.subspan(n)) < k_still * fall;
  const double may_rest = (on_still ? k_may_rest_on_still : k_may_rest) * fall;
  const auto add_mass = [&](BlockMatrix& hessian) {
    parallel_for(n, k_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        hessian.blocks[at(model_.pattern.diagonal[i])].diagonal().array() +=
            static_cast<float>(model_.mass[i] * inertia);
    });
  };
  const auto add_pins_and_contact = [&] {
    std::vector<PairTerm> terms;
    for (std::size_t p = 0; p < model_.pins.size(); ++p) {
      if (!s.pins[p].holds()) continue;
      PairTerm term;
      term.vertex[0] = model_.pins[p].vertex;
      term.weight[0] = 1;
      term.stiffness = Mat3f::Identity() * static_cast<float>(s.pins[p].stiffness(all[at(model_.pins[p].vertex)]));
      terms.push_back(term);
    }
    for (const Pull& pull : in.pulls)
      if (pull.missing(all) > 0) terms.push_back(pull.term());
    contact.add_terms(all, terms);
    s.newton.system().add_pair_terms(terms);
  };
  const std::function<void()> fill_system = [&] {
    BlockMatrix& hessian = s.newton.system().begin();
    add_mass(hessian);
    for (const auto& energy : model_.energies) energy->add_hessian(all.first(n), hessian);
    contact.update(all);
    add_pins_and_contact();
    contact.forget_contacts();
  };
  double of_cloth = potential_of_cloth(cloth(all));
  const int most_iterations = in.no_more ? in.newton_iterations : k_most_times * in.newton_iterations;
  bool settled = false;
  s.newton.begin();
  for (int iteration = 0; iteration < most_iterations && !settled; ++iteration) {
    contact.lag_friction();
    contact.mark_touching(s.touches);
    const std::span<const Vec3> x = all.first(n);
    BlockMatrix& hessian = s.newton.system().begin();
    s.gradient.resize(n);
    add_mass(hessian);
    parallel_for(n, k_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) s.gradient[i] = model_.mass[i] * inertia * (x[i] - s.y[i]);
    });
    for (const auto& energy : model_.energies) energy->add_derivatives(x, s.gradient, hessian);
    add_pin_gradient(all, [](const PinPoint&) { return true; });
    for (const Pull& pull : in.pulls) pull.add_gradient(x, s.gradient);
    contact.add_gradient(all, s.gradient);
    add_pins_and_contact();
    for (Vec3& g : s.gradient) g = -g;
    const double before = of_cloth + contact.value(all);
    contact.forget_contacts();
    result.seconds_assembly += watch.lap();
    ++result.newton_iterations;
    StepTruncation::PairsSuffice pairs_suffice;
    if (in.pairs_suffice)
      pairs_suffice = [&](std::span<const Vec3> to) {
        result.seconds_contact += watch.lap();
        const bool complete = in.pairs_suffice(to);
        watch.lap();
        if (!complete) contact.extend(all);
        return complete;
      };
    const NewtonDirection::Iteration newton{contact,       all,         s.gradient, in.balls,
                                            pairs_suffice, fill_system, watch,      result};
    std::span<const Vec3> direction = s.newton.solve(newton);
    // What truncation leaves of a direction is small because it was truncated, and settles nothing while it gets on.
    const bool wants_little = strain_change(model_.rest_edges, all, direction) < in.settled_strain;
    const double wanted = descent(s.gradient, direction);
    // Stay in the balls inside which the list of pairs is complete: larger ones, if they can be had.
    const auto missing_of = [&](std::size_t i) {
      return std::max(0.0, (all[i] + direction[i] - in.balls.centre_of(i)).norm() - in.balls.radius[i]);
    };
    const double most_missing = parallel_max(n, k_block, 0.0, [&](std::size_t begin, std::size_t end) {
      double most = 0;
      for (std::size_t i = begin; i < end; ++i) most = std::max(most, missing_of(i));
      return most;
    });
    if (in.more_room && most_missing > in.enough_room) {
      std::vector<double> missing(n);
      for (std::size_t i = 0; i < n; ++i) missing[i] = missing_of(i);
      result.seconds_contact += watch.lap();
      in.more_room(missing, x, direction);
      watch.lap();
      contact.extend(all);
    }
    s.trial.assign(all.begin(), all.end());
    direction = s.newton.truncate(newton, s.trial);
    give_back(s.gradient);

    double factor = 1, of_trial = 0, after = 0;
    bool accepted = false, finite = true, whole = true;
    for (int halving = 0; halving <= k_most_halvings && !accepted; ++halving, factor *= 0.5) {
      result.last_move = parallel_max(n, k_block, 0.0, [&](std::size_t begin, std::size_t end) {
        double most = 0;
        for (std::size_t i = begin; i < end; ++i) {
          const Vec3 d = factor * direction[i];
          s.trial[i] = all[i] + d;
          most = std::max(most, d.norm());
        }
        return most;
      });
      contact.update(s.trial, direction, factor);  // from where it was, or back by half
      of_trial = potential_of_cloth(cloth(s.trial));
      after = of_trial + contact.value(s.trial);
      finite = std::isfinite(after);
      accepted = finite && after <= before + k_energy_noise + k_tolerated_rise * std::abs(before);
      if (accepted && factor < 1 && in.may_stop && !in.may_stop(cloth(s.trial))) accepted = false;
      if (!accepted) whole = false;
    }
    if (!accepted && finite && in.may_stop && !in.may_stop(cloth(s.trial))) {
      std::copy_n(all.begin(), n, s.trial.begin());
      contact.update(s.trial, direction, 2 * factor);
      of_trial = of_cloth;
      after = before;
      result.last_move = 0;
    }
    const double of_step = mean_distance(in.x_t0, cloth(s.trial));
    const bool creeps = contact.has_friction() && of_step < may_rest &&
                        mean_distance(cloth(all), cloth(s.trial)) > k_settled_creep * of_step;
    const bool stuck = before - after < k_stuck * wanted;
    // A halved step is small because it was halved, and settles nothing.
    settled = !finite || result.last_move < k_still * smallest_radius ||
              (iteration + 1 >= in.newton_iterations && (stuck || wants_little) && whole && !creeps &&
               strain_change(model_.rest_edges, all, direction) < in.settled_strain &&
               largest_drift(model_, s.touches, cloth(all), cloth(s.trial)) <= settled_drift);
    if (finite) {
      std::copy_n(s.trial.begin(), n, all.begin());
      of_cloth = of_trial;
    } else {
      contact.update(all, direction, 2 * factor);
      result.last_move = 0;
    }
    s.newton.forget();  // not while the next one is looked for
    give_back(s.trial);
    result.seconds_contact += watch.lap();
  }
  result.smallest_gap = contact.smallest_gap();
  measure_on_body(all, inertia, result);
  measure_lost(all, inertia, result);
  for (std::size_t i = 0; i < n; ++i) v_out[i] = (all[i] - past(i)) / bh;
  s.forget_solve();
  result.finite = result.finite && all_finite(all.first(n));
  return result;
}

}  // namespace ft::inline solvers
