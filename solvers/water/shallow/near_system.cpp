// See near_system.h.
#include "solvers/water/shallow/near_system.h"

#include <algorithm>
#include <cmath>

namespace ft::inline solvers {
namespace {

/// How much of what incomplete factors leave out is put on the diagonal, and the smallest pivot that is believed.
constexpr double k_modified = 0.97, k_safe = 0.25;
constexpr int k_most_iterations = 500;

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  // Four sums, one after another in a fixed order.
  double s[4] = {};
  std::size_t i = 0;
  for (; i + 4 <= a.size(); i += 4)
    for (std::size_t n = 0; n < 4; ++n) s[n] += a[i + n] * b[i + n];
  for (; i < a.size(); ++i) s[0] += a[i] * b[i];
  return (s[0] + s[1]) + (s[2] + s[3]);
}

}  // namespace

void NearSystem::factor() {
  const std::size_t n = diagonal.size();
  pivot_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    double d = diagonal[i];
    for (const std::size_t side : {std::size_t{0}, std::size_t{2}}) {
      const int j = neighbour[i][side];
      if (j < 0) continue;
      const double c = coupling[i][side], p = pivot_[at(j)];
      // The factor would also join what lies beyond j.
      const double other = side == 0 ? coupling[at(j)][3] : coupling[at(j)][1];
      const bool there = side == 0 ? neighbour[at(j)][3] >= 0 : neighbour[at(j)][1] >= 0;
      d -= c * c * p * p + (there ? k_modified * c * other * p * p : 0.0);
    }
    if (d < k_safe * diagonal[i]) d = diagonal[i];
    pivot_[i] = 1 / std::sqrt(d);
  }
}

void NearSystem::precondition(const std::vector<double>& r, std::vector<double>& z) const {
  const std::size_t n = r.size();
  for (std::size_t i = 0; i < n; ++i) {
    double t = r[i];
    for (const std::size_t side : {std::size_t{0}, std::size_t{2}}) {
      const int j = neighbour[i][side];
      if (j >= 0) t += coupling[i][side] * pivot_[at(j)] * z[at(j)];
    }
    z[i] = t * pivot_[i];
  }
  for (std::size_t i = n; i-- > 0;) {
    double t = z[i];
    for (const std::size_t side : {std::size_t{1}, std::size_t{3}}) {
      const int j = neighbour[i][side];
      if (j >= 0) t += coupling[i][side] * pivot_[i] * z[at(j)];
    }
    z[i] = t * pivot_[i];
  }
}

void NearSystem::multiply(const std::vector<double>& p, std::vector<double>& out) const {
  for (std::size_t i = 0; i < p.size(); ++i) {
    double sum = diagonal[i] * p[i];
    for (std::size_t side = 0; side < 4; ++side)
      if (neighbour[i][side] >= 0) sum -= coupling[i][side] * p[at(neighbour[i][side])];
    out[i] = sum;
  }
  for (const Body& b : bodies) {
    Vec6 along = Vec6::Zero();
    for (std::size_t n = 0; n < b.rows.size(); ++n) along += p[at(b.rows[n])] * b.directions[n];
    const Vec6 moved = b.block * along;
    for (std::size_t n = 0; n < b.rows.size(); ++n) out[at(b.rows[n])] += b.directions[n].dot(moved);
  }
}

void NearSystem::solve(const std::vector<double>& right, double tolerance, std::vector<double>& x) {
  const std::size_t n = right.size();
  x.assign(n, 0.0);
  r_ = right;
  z_.assign(n, 0.0);
  q_.assign(n, 0.0);
  iterations = 0;
  const auto largest = [&] {
    double most = 0;
    for (const double v : r_) most = std::max(most, std::abs(v));
    return most;
  };
  if (!(largest() > tolerance)) return;
  factor();
  precondition(r_, z_);
  p_ = z_;
  double rz = dot(r_, z_);
  while (iterations < k_most_iterations && rz > 0) {
    ++iterations;
    multiply(p_, q_);
    const double alpha = rz / dot(p_, q_);
    for (std::size_t i = 0; i < n; ++i) x[i] += alpha * p_[i], r_[i] -= alpha * q_[i];
    if (!(largest() > tolerance)) break;
    precondition(r_, z_);
    const double next = dot(r_, z_), beta = next / rz;
    rz = next;
    for (std::size_t i = 0; i < n; ++i) p_[i] = z_[i] + beta * p_[i];
  }
}

}  // namespace ft::inline solvers
