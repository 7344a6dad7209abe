#include "solvers/hair/rod_step.h"

#include <algorithm>

namespace ft::inline solvers {
namespace {

/// From this iteration on steps are searched along, and friction stands still after the first few.
constexpr int k_search_from = 4, k_gauss_newton_from = 14, k_friction_until = 2;
constexpr int k_halvings = 8;
/// By how much a contact becomes stiffer that did not keep a vertex out, and the strain along that its push at the
/// surface may give a strand [1].
constexpr double k_stiffer = 4, k_push_strain = 1e-3;

template <class T>
bool any(const T& mask) {
  return largest_lane(mask) > 0.5;
}

}  // namespace

template <class T>
void contact_force(const T& gap, const T& reach, const T& stiffness, T& force, T& slope, T& energy) {
  // k/2 (r - d)^2 down to r/2; then k r^2 / (4 d); below r/8 straight on, so that what is inside is pushed out.
  const T half = 0.5 * reach, eighth = 0.125 * reach, d = larger(gap, eighth);
  const T near = 0.25 * stiffness * reach * reach / d;
  const T far = stiffness * (reach - d);
  const T in = smaller(T(gap - eighth), T{});  // below 0
  const T hard = 0.25 * stiffness * reach * reach / (d * d);
  const auto close = d < half;
  force = choose(close, near, far);
  slope = choose(close, hard, stiffness);
  const T log =
      largest_lane(choose(close, all_lanes<T>(1), T{})) > 0 ? log_of(choose(close, T(half / d), all_lanes<T>(1))) : T{};
  energy = choose(close, T(stiffness * reach * reach * (0.125 + 0.25 * log)),
                  T(0.5 * stiffness * (reach - d) * (reach - d)));
  energy += 0.5 * slope * in * in - force * in;
  force -= slope * in;
  const auto away = gap >= reach;
  force = choose(away, T{}, force);
  slope = choose(away, T{}, slope);
  energy = choose(away, T{}, energy);
}

template <class T>
T RodStep<T>::contacts_of_segments(const RodSurroundings<T>& around, const RodPose<T>& pose, bool derivatives) {
  T sum{};
  for (std::size_t c = 2 * k_segment_contacts; c < around.segments.size(); ++c) {
    const SegmentContact<T>& k = around.segments[c];
    const std::size_t i = c / k_segment_contacts;
    if (!(largest_lane(k.reach) > 0)) continue;
    T force, slope, energy;
    const T gap = dot(k.normal, pose.x[i - 1] + k.share * (pose.x[i] - pose.x[i - 1])) - k.offset;
    contact_force(gap, k.reach, k.stiffness, force, slope, energy);
    sum += energy;
    if (!derivatives) continue;
    const T share[2] = {T(1.0 - k.share), k.share}, n3[3] = {k.normal.x, k.normal.y, k.normal.z};
    const std::size_t row = 4 * i - 4;
    for (std::size_t p = 0; p < 2; ++p)
      for (std::size_t a = 0; a < 3; ++a) {
        gradient_[row + 4 * p + a] -= share[p] * force * n3[a];
        for (std::size_t q = 0; q <= p; ++q)
          for (std::size_t b = 0; b < (p == q ? a + 1 : 3); ++b)
            hessian_(static_cast<int>(row + 4 * p + a), static_cast<int>(row + 4 * q + b)) +=
                slope * share[p] * share[q] * n3[a] * n3[b];
      }
  }
  return sum;
}

/// Adds pulls and contacts to the gradient and the Hessian; returns their energy.
template <class T>
T RodStep<T>::surroundings(const RodSurroundings<T>& around, const RodPose<T>& pose, bool derivatives) {
  T sum = around.touches ? contacts_of_segments(around, pose, derivatives) : T{};
  const std::size_t n = pose.x.size();
  for (std::size_t i = 2; i < n; ++i) {
    const V3<T> off = pose.x[i] - around.goal[i];
    sum += 0.5 * around.pull[i] * dot(off, off);
    const std::size_t d = 4 * i;
    const int row = static_cast<int>(d);
    if (derivatives) {
      gradient_[d] += around.pull[i] * off.x, gradient_[d + 1] += around.pull[i] * off.y,
          gradient_[d + 2] += around.pull[i] * off.z;
      for (int a = 0; a < 3; ++a) hessian_(row + a, row + a) += around.pull[i];
    }
    if (!around.touches) continue;
    for (std::size_t c = k_contacts * i; c < k_contacts * (i + 1); ++c) {
      const HairContact<T>& k = around.contacts[c];
      if (!(largest_lane(k.reach) > 0)) break;
      T force, slope, energy;
      contact_force(T(dot(k.normal, pose.x[i]) - k.offset), k.reach, k.stiffness, force, slope, energy);
      const V3<T> moved = pose.x[i] - k.carried;
      const V3<T> across = moved - dot(moved, k.normal) * k.normal;
      sum += energy + 0.5 * k.drag * dot(across, across);
      if (!derivatives) continue;
      const V3<T> g = k.drag * across - force * k.normal;
      gradient_[d] += g.x, gradient_[d + 1] += g.y, gradient_[d + 2] += g.z;
      const T n3[3] = {k.normal.x, k.normal.y, k.normal.z}, rank = slope - k.drag;
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b <= a; ++b) hessian_(row + a, row + b) += rank * n3[a] * n3[b] + (a == b ? k.drag : T{});
    }
  }
  return sum;
}

template <class T>
void RodStep<T>::freeze_friction(RodSurroundings<T>& around, const RodPose<T>& pose) const {
  for (std::size_t i = 2; i < pose.x.size(); ++i)
    for (std::size_t c = k_contacts * i; c < k_contacts * (i + 1); ++c) {
      HairContact<T>& k = around.contacts[c];
      if (!(largest_lane(k.reach) > 0)) break;
      T force, slope, energy;
      contact_force(T(dot(k.normal, pose.x[i]) - k.offset), k.reach, k.stiffness, force, slope, energy);
      const V3<T> moved = pose.x[i] - k.carried;
      const T way = norm(moved - dot(moved, k.normal) * k.normal);
      k.drag = k.friction * force / larger(way, all_lanes<T>(around.friction_speed_way));
    }
}

/// Of the lanes `who`: those in which a contact has become stiffer.
template <class T>
T RodStep<T>::stiffen_pierced(const Rod<T>& rod, RodSurroundings<T>& around, const RodPose<T>& pose,
                              const T& who) const {
  const T zero{}, one = all_lanes<T>(1);
  T any_stiffer{};
  const auto stiffen = [&](const T& gap, const T& reach, T& stiffness) {
    const T most = k_push_strain * rod.stretch / (4.0 * larger(reach, all_lanes<T>(1e-12)));
    const T pierced = choose(gap < zero, one, zero) * choose(reach > zero, one, zero) *
                      choose(k_stiffer * stiffness < most, one, zero) * who;
    stiffness = stiffness * (one + (k_stiffer - 1) * pierced);
    any_stiffer = larger(any_stiffer, pierced);
  };
  for (std::size_t i = 2; i < pose.x.size(); ++i) {
    for (std::size_t c = k_contacts * i; c < k_contacts * (i + 1); ++c) {
      HairContact<T>& k = around.contacts[c];
      if (!(largest_lane(k.reach) > 0)) break;
      stiffen(T(dot(k.normal, pose.x[i]) - k.offset), k.reach, k.stiffness);
    }
    for (std::size_t c = k_segment_contacts * i; c < k_segment_contacts * (i + 1); ++c) {
      SegmentContact<T>& k = around.segments[c];
      if (!(largest_lane(k.reach) > 0)) continue;
      stiffen(T(dot(k.normal, pose.x[i - 1] + k.share * (pose.x[i] - pose.x[i - 1])) - k.offset), k.reach, k.stiffness);
    }
  }
  return any_stiffer;
}

template <class T>
void RodStep<T>::assemble(const Rod<T>& rod, const RodSurroundings<T>& around, const RodStrains<T>& since,
                          double damping, const std::vector<T>& tension, const RodPose<T>& pose, const T& full) {
  gradient_.assign(at(rod.unknowns()), T{});
  hessian_.reset(rod.unknowns());
  RodHessian<T> wanted;
  wanted.full = full;
  wanted.tension = &tension;
  energy_ = add_potential(rod, pose, &since, damping, wanted, gradient_, &hessian_);
  energy_ += surroundings(around, pose, true);
}

template <class T>
RodStepReport RodStep<T>::run(const Rod<T>& rod, RodSurroundings<T>& around, const RodStrains<T>& since, double damping,
                              std::vector<T>& tension, RodPose<T>& pose) {
  RodStepReport report;
  const std::size_t n = at(rod.n);
  const T one = all_lanes<T>(1), zero{};
  T active = one;
  for (int it = 0; it < most_iterations && any(active); ++it) {
    report.iterations = it + 1;
    if (around.touches && it <= k_friction_until) freeze_friction(around, pose);
    T full = it < k_gauss_newton_from ? one : zero;
    assemble(rod, around, since, damping, tension, pose, full);
    const T least = hessian_.factor(k_given);
    const T bad = choose(least > zero, zero, one);
    if (any(T(bad * full))) {
      full = full * (1.0 - bad);
      assemble(rod, around, since, damping, tension, pose, full);
      hessian_.factor(k_given);
    }
    step_.resize(gradient_.size());
    for (std::size_t d = 0; d < step_.size(); ++d) step_[d] = d < k_given ? zero : T(-gradient_[d]);
    hessian_.solve(k_given, step_);
    const auto way = [&](std::size_t i) { return V3<T>{step_[4 * i], step_[4 * i + 1], step_[4 * i + 2]}; };
    T share = one, largest = zero;
    for (std::size_t i = 2; i < n; ++i) {
      largest = larger(largest, dot(way(i), way(i)));
      const T change = norm(way(i) - way(i - 1));
      share = smaller(share, T(0.5 * rod.length[i - 1] / larger(change, T(0.5 * rod.length[i - 1]))));
    }
    // NaN is no progress: such a strand stands still and is not settled.
    const T finite = choose(largest < 1e20, one, zero);
    share = choose(finite > 0.5, share, zero);
    for (T& s : step_) s = choose(finite > 0.5, s, zero);
    share = share * active;
    const T settles = choose(largest < tolerance * tolerance, one, zero) * finite;
    // Foretold: with what the step adds to each length.
    std::vector<T>& next = tension;
    for (std::size_t j = 1; j + 1 < n; ++j) {
      const V3<T> e = pose.x[j + 1] - pose.x[j];
      const T length = norm(e), over = one / larger(length, all_lanes<T>(1e-12));
      const T longer = over * dot(e, way(j + 1) - way(j));
      const T foretold = rod.stretch / rod.length[j] * (length - rod.length[j] + longer);
      next[j] = choose(active > 0.5, foretold, next[j]);
    }
    if (it >= k_search_from) {
      for (int halving = 0; halving < k_halvings; ++halving) {
        move_pose(step_, share, pose, trial_);
        T energy = potential(rod, trial_, &since, damping) + surroundings(around, trial_, false);
        const T worse = choose(energy > energy_ + 1e-9 * absolute(energy_), one, zero);
        if (!any(T(worse * share))) break;
        share = share * (1.0 - 0.5 * worse);
      }
    }
    move_pose(step_, share, pose, trial_);
    std::swap(pose, trial_);
    T stiffer{};
    if (around.touches && any(T(settles * active))) stiffer = stiffen_pierced(rod, around, pose, T(settles * active));
    active = active * (1.0 - settles * (1.0 - stiffer));
  }
  for (int lane = 0; lane < k_lanes; ++lane) {
    if constexpr (std::is_same_v<T, double>)
      report.settled[lane] = active < 0.5;
    else
      report.settled[lane] = active[lane] < 0.5;
  }
  return report;
}

template void contact_force(const double&, const double&, const double&, double&, double&, double&);
template void contact_force(const Lanes&, const Lanes&, const Lanes&, Lanes&, Lanes&, Lanes&);
template class RodStep<double>;
template class RodStep<Lanes>;

}  // namespace ft::inline solvers
