#include "solvers/cloth/solve/newton_direction.h"

#include "baker/core/give_back.h"
#include "baker/core/parallel.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_block = 512;  ///< of a loop over vertices
/// Truncation spoils the direction where few vertices are held back and the others go on as if they were not: Newton's
/// method would stop there, uphill. While less than this share of the descent is left, what is in its way is made stiff
/// and all is solved for anew, so that the cloth goes along it or takes it along.
constexpr double k_least_descent = 0.1;
constexpr int k_most_stiffened = 3;  ///< rounds
/// Of the stiffness that would leave an obstacle half of what it may approach by if nothing around gave way with it,
/// which it does: from 1e-4 to 0.01 the twisted sheet strains alike, with 0.1 and 1 more.
constexpr double k_obstacle_stiffness = 0.01;
/// Then what lost more than this share of its displacement is held where it is, and the others are solved for (an
/// active set); half as much is enough in every round. Seldom needed: where a hand pulls at a dress.
constexpr double k_held = 0.5;
constexpr int k_most_held = 4;  ///< rounds

LinearSettings settings_of(const ClothModel& model) {
  LinearSettings settings;
  settings.tolerance = model.setup.linear_tolerance;
  return settings;
}

}  // namespace

double descent(std::span<const Vec3> downhill, std::span<const Vec3> displacement) {
  return parallel_sum(downhill.size(), k_block, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += downhill[i].dot(displacement[i]);
    return sum;
  });
}

NewtonDirection::NewtonDirection(const ClothModel& model)
    : model_(model), system_(model.pattern, model.contact.rest, settings_of(model)), truncation_(model) {}

void NewtonDirection::solve(const Iteration& in, std::span<const char> held) {
  const LinearReport solved = system_.solve(in.downhill, held, direction_, enough_);
  if (in.result.linear_iterations == 0) enough_ = model_.setup.linear_tolerance * solved.start_norm;
  in.result.linear_iterations += solved.iterations;
  if (system_.block_count() >= model_.setup.large_system) system_.give_back();
  for (Vec3& d : direction_)
    if (!d.allFinite()) d.setZero(), in.result.finite = false;
  truncation_.damp_relative_motion(in.all, direction_);
  in.result.seconds_linear += in.watch.lap();
}

std::span<const Vec3> NewtonDirection::solve(const Iteration& in) {
  solve(in, model_.unused);
  return direction_;
}

void NewtonDirection::cut_direction(const Iteration& in, std::span<Vec3> trial) {
  truncation_.truncate(in.contact, in.all, in.balls, in.pairs_suffice, direction_, cut_, trial);
}

bool NewtonDirection::is_spoiled(const Iteration& in) const {
  return descent(in.downhill, cut_) < k_least_descent * descent(in.downhill, direction_);
}

/// Before a further solve: the system with all springs so far, where it is gone.
void NewtonDirection::refill(const Iteration& in, std::span<const PairTerm> springs) {
  if (system_.is_filled()) return;
  in.result.seconds_contact += in.watch.lap();
  in.fill_system();
  if (!springs.empty()) system_.add_pair_terms(springs);
  in.result.seconds_assembly += in.watch.lap();
}

/// In series with what holds the vertices of a pair by themselves.
void NewtonDirection::add_springs_against(std::span<const PairObstacle> obstacles,
                                          std::vector<PairTerm>& springs) const {
  for (const PairObstacle& o : obstacles) {
    PairTerm spring;
    double give = 0;  // m/N
    for (std::size_t k = 0; k < 4; ++k) {
      if (o.vertex[k] >= model_.vertex_count() || o.weight[k] == 0) continue;
      const double own = system_.stiffness_along(o.vertex[k], o.normal);
      if (!(own > 0)) continue;
      spring.vertex[k] = o.vertex[k];
      spring.weight[k] = static_cast<float>(o.weight[k]);
      give += o.weight[k] * o.weight[k] / own;
    }
    if (!(give > 0)) continue;
    const double stiffness = k_obstacle_stiffness * (2 * o.approach / o.allowed - 1) / give;
    spring.stiffness = (stiffness * o.normal * o.normal.transpose()).cast<float>();
    springs.push_back(spring);
  }
}

std::span<const Vec3> NewtonDirection::truncate(const Iteration& in, std::span<Vec3> trial) {
  cut_.resize(direction_.size());
  cut_direction(in, trial);
  std::vector<PairTerm> springs;
  for (int round = 0; round < k_most_stiffened && is_spoiled(in); ++round) {
    const std::vector<PairObstacle> obstacles = truncation_.obstacles(in.contact, in.all, direction_);
    if (obstacles.empty()) break;
    refill(in, springs);
    const std::size_t before = springs.size();
    add_springs_against(obstacles, springs);
    system_.add_pair_terms(std::span(springs).subspan(before));
    in.result.seconds_contact += in.watch.lap();
    solve(in, model_.unused);
    cut_direction(in, trial);
  }
  std::vector<char> held(model_.unused.begin(), model_.unused.end());
  double lost = k_held;
  for (int round = 0; round < k_most_held && is_spoiled(in); ++round) {
    for (std::size_t i = 0; i < held.size(); ++i)
      held[i] = held[i] != 0 || (cut_[i] - direction_[i]).norm() > lost * direction_[i].norm();
    model_.clusters.take_most(held);
    lost *= 0.5;
    refill(in, springs);
    in.result.seconds_contact += in.watch.lap();
    solve(in, held);
    cut_direction(in, trial);
  }
  direction_.swap(cut_);
  give_back(cut_);
  return direction_;
}

void NewtonDirection::forget() {
  give_back(direction_);
}

void NewtonDirection::forget_all() {
  system_.give_back();
  give_back(direction_, cut_);
}

}  // namespace ft::inline solvers
