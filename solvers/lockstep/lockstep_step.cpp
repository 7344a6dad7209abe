#include "solvers/lockstep/lockstep_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "baker/core/stopwatch.h"
#include "solvers/base/integrator.h"

namespace ft::inline solvers {
namespace {

constexpr int k_most_iterations = 30;        ///< of one look at friction; what takes more wants a shorter step
constexpr int k_friction_looks = 3;          ///< at most
constexpr double k_friction_settled = 1e-6;  ///< a new look at friction that moves nothing further was the last [m]
/// What gets on by so small a share of what it wants, so many times in a row, is in the way of something that is
/// driven.
constexpr double k_stuck_share = 1e-3;
constexpr int k_stuck_iterations = 6;
/// What is stopped by more than this in a step has no use for its history: BDF2 would throw it back with half of its
/// speed [m/s].
constexpr double k_hit = 0.1;
constexpr int k_most_halvings = 24;
constexpr double k_series_from = 0.2, k_series_to = 0.95;  ///< ratios of successive iterations [1]
constexpr double k_energy_noise = 1e-12;                   ///< rounding of the potential, over its size [1]
/// Inertia of a driven node, over the stiffest that pulls at it: it yields by so much less.
constexpr double k_driven = 1e4;

double longest(std::span<const Vec3> all) {
  double squared = 0;
  for (const Vec3& d : all) squared = std::max(squared, d.squaredNorm());
  return std::sqrt(squared);
}

}  // namespace

LockstepStep::LockstepStep(const LockstepModel& model) : model_(model), contact_(model), elements_(model.elements) {}

/// Scenery is driven as a prop is: what is left of its way costs so much that it is gone first.
double LockstepStep::value(std::span<const Vec3> x, double share) const {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += 0.5 * weight_[i] * (x[i] - y_[i]).squaredNorm();
  sum = sum + elements_.value(x) + contact_.value(x, share);
  return share < 1 ? sum + 0.5 * scenery_cost_ * (1 - share) * (1 - share) : sum;
}

/// From x_; false where it did not settle.
bool LockstepStep::newton(LockstepStepReport& report) {
  const std::size_t n = x_.size();
  Stopwatch watch;
  int stuck = 0;
  bool whole = false;  // the last iteration went all its way
  for (int iteration = 0; iteration < k_most_iterations; ++iteration) {
    watch.lap();
    system_.begin(weight_);
    for (std::size_t i = 0; i < n; ++i) gradient_[i] = weight_[i] * (y_[i] - x_[i]);
    terms_.clear();
    elements_.add_terms(x_, terms_);
    contact_.add_terms(x_, terms_, iteration > 0 ? report.residual : std::numeric_limits<double>::infinity(), share_);
    for (const NodeTerm& t : terms_) {
      system_.add(t);
      for (int k = 0; k < t.count; ++k) gradient_[at(t.node[at(k)])] -= t.weight[at(k)] * t.force;
      for (int k = 0; k < t.count && share_ < 1; ++k) gradient_[at(t.node[at(k)])] -= t.weight[at(k)] * t.ahead;
    }
    report.seconds_assembly += watch.lap();
    ++report.newton_iterations;
    const bool solved = system_.solve(gradient_, direction_) && all_finite(direction_);
    report.seconds_linear += watch.lap();
    if (!solved) {
      report.finite = false;
      return false;
    }
    report.residual = longest(direction_);
    // What the Hessian leaves out makes the last iterations a geometric series: its sum is taken at once.
    if (whole) {
      double along = 0, of_last = 0;
      for (std::size_t i = 0; i < n; ++i) along += direction_[i].dot(last_[i]), of_last += last_[i].squaredNorm();
      const double ratio = of_last > 0 ? along / of_last : 0;
      last_ = direction_;
      if (ratio > k_series_from && ratio < k_series_to)
        for (Vec3& d : direction_) d /= 1 - ratio;
    } else {
      last_ = direction_;
    }
    const double before = value(x_, share_), left = 1 - share_;
    contact_.find(x_, direction_, share_);
    double factor = 2 * contact_.free_share();
    bool accepted = false;
    for (int halving = 0; halving < k_most_halvings && !accepted; ++halving) {
      factor *= 0.5;
      for (std::size_t i = 0; i < n; ++i) trial_[i] = x_[i] + factor * direction_[i];
      const double after = value(trial_, factor < 1 ? share_ + factor * left : 1);
      accepted = std::isfinite(after) && after <= before + k_energy_noise * std::abs(before);
    }
    report.seconds_contact += watch.lap();
    if (!accepted) return report.residual < 1e3 * model_.setup.settled && share_ == 1;  // rounding decides here
    whole = factor == 1;
    stuck = factor < k_stuck_share ? stuck + 1 : 0;
    if (stuck >= k_stuck_iterations) return false;
    x_.swap(trial_);
    share_ = whole ? 1 : share_ + factor * left;
    if (report.residual < model_.setup.settled && share_ == 1) return true;
  }
  return false;
}

LockstepStepReport LockstepStep::step(double end, double h, std::span<const Vec3> driven, LockstepMotion& m) {
  const std::size_t n = at(model_.node_count()), points = at(model_.point_count());
  const IntegratorWeights w = model_.setup.bdf2 ? bdf2_weights(h, m.h_previous) : IntegratorWeights{};
  const double bh = w.beta * h;
  LockstepStepReport report;
  report.effective_step = bh / (1 - w.b);

  elements_.begin_step(end, h, m.x, m.v);
  y_.resize(n), trial_.resize(n), gradient_.resize(n), direction_.resize(n), weight_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    y_[i] = w.a * m.x[i] - w.b * m.x_previous[i] + bh * (w.a * m.v[i] - w.b * m.v_previous[i]) +
            bh * bh * model_.setup.gravity;
    weight_[i] = model_.mass[i] / (bh * bh);
  }
  double stiffest = model_.contact_stiffness;
  for (const CordSpring& s : model_.elements.springs) stiffest = std::max(stiffest, s.stiffness);
  if (!driven.empty()) {
    for (std::size_t k = 0; k < 4; ++k) y_[points + k] = driven[k], weight_[points + k] = k_driven * stiffest;
  }

  // As far as all goes on as it did, or the prop's track wants, without meeting anything: a good place to begin.
  x_ = m.x;
  for (std::size_t i = 0; i < n; ++i)
    direction_[i] = i >= points && !driven.empty() ? (driven[i - points] - m.x[i]).eval() : (h * m.v[i]).eval();
  contact_.find(x_, direction_, 0);
  const double share = contact_.free_share(), way = contact_.scenery_way();
  for (std::size_t i = 0; i < n; ++i) x_[i] += share * direction_[i];
  share_ = way > 0 ? share : 1;
  const double least_way = std::max(way, contact_.widest_reach());
  scenery_cost_ = k_driven * stiffest * least_way * least_way;

  std::vector<Vec3> before;
  for (int look = 0; look < k_friction_looks; ++look) {
    contact_.lag_friction(x_, m.x, h, share_);
    before = x_;
    report.settled = newton(report);
    if (!report.settled) break;
    if (!contact_.has_friction()) break;
    double moved = 0;
    for (std::size_t i = 0; i < n; ++i) moved = std::max(moved, (x_[i] - before[i]).norm());
    if (look > 0 && moved < k_friction_settled) break;
  }
  report.finite = report.finite && all_finite(x_);
  if (!report.finite) return report;

  const bool hit = contact_.fastest_stop(x_, m.v, share_) > k_hit;
  if (hit && m.h_previous > 0) {
    m.h_previous = 0;
    LockstepStepReport again = step(end, h, driven, m);
    again.newton_iterations += report.newton_iterations;
    again.seconds_contact += report.seconds_contact;
    again.seconds_assembly += report.seconds_assembly;
    again.seconds_linear += report.seconds_linear;
    return again;
  }
  report.on_met = contact_.on_met(x_, share_);
  report.hold_force = elements_.hold_force(x_);
  for (std::size_t k = 0; k < driven.size(); ++k)
    report.missed = std::max(report.missed, (x_[points + k] - driven[k]).norm());
  report.scenery_late = share_ < 1;
  LockstepMotion next;
  next.x = x_;
  next.v.resize(n);
  for (std::size_t i = 0; i < n; ++i) next.v[i] = (x_[i] - w.a * m.x[i] + w.b * m.x_previous[i]) / bh;
  next.x_previous = std::move(m.x);
  next.v_previous = std::move(m.v);
  next.h_previous = hit ? 0 : h;
  m = std::move(next);
  return report;
}

}  // namespace ft::inline solvers
