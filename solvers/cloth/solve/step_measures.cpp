#include "solvers/cloth/solve/step_measures.h"

#include <algorithm>
#include <cmath>

#include "baker/core/parallel.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_block = 512;  ///< of a loop over vertices

}  // namespace

double strain_change(const RestEdges& rest, std::span<const Vec3> from, std::span<const Vec3> move) {
  const double squares = parallel_sum(rest.edges.size(), 1024, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t k = begin; k < end; ++k) {
      const auto [a, b] = rest.edges[k];
      const Vec3 edge = from[at(a)] - from[at(b)];
      const double change = ((edge + move[at(a)] - move[at(b)]).norm() - edge.norm()) / rest.lengths[k];
      sum += change * change;
    }
    return sum;
  });
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(rest.edges.size(), 1)));
}

double mean_distance(std::span<const Vec3> from, std::span<const Vec3> to) {
  const double squares = parallel_sum(from.size(), k_block, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += (to[i] - from[i]).squaredNorm();
    return sum;
  });
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(from.size(), 1)));
}

double largest_drift(const ClothModel& model, std::span<const char> held, std::span<const Vec3> from,
                     std::span<const Vec3> to) {
  using Moment = Eigen::Vector4d;  // mass times displacement, mass
  double largest = 0;
  for (std::size_t g = 0; g < held.size(); ++g) {
    if (held[g] != 0) continue;
    const auto first = at(model.first_vertex[g]), count = at(model.first_vertex[g + 1]) - first;
    const Moment sum = parallel_sum(count, k_block, Moment(0, 0, 0, 0), [&](std::size_t begin, std::size_t end) {
      Moment own(0, 0, 0, 0);
      for (std::size_t i = first + begin; i < first + end; ++i) {
        own.head<3>() += model.mass[i] * (to[i] - from[i]);
        own[3] += model.mass[i];
      }
      return own;
    });
    if (sum[3] > 0) largest = std::max(largest, sum.head<3>().norm() / sum[3]);
  }
  return largest;
}

}  // namespace ft::inline solvers
