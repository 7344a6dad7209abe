#include "solvers/energies/bending.h"

#include <cmath>
#include <numbers>

#include "baker/core/check.h"
#include "solvers/energies/hinge_math.h"

namespace ft {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// A triangle pressed below this share of its rest area counts as degenerate.
constexpr double k_collapsed = 1e-3;

void angles(const Bending::Group& g, std::span<const Vec3> x, HingeAngles& out) {
  alignas(32) HingeLane e[3], a[3], b[3];
  for (int l = 0; l < k_lanes; ++l) {
    const Vec3 &x0 = x[at(g.vertex[0][l])], &x1 = x[at(g.vertex[1][l])];
    const Vec3 &x2 = x[at(g.vertex[2][l])], &x3 = x[at(g.vertex[3][l])];
    for (int k = 0; k < 3; ++k) e[k][l] = x1[k] - x0[k], a[k][l] = x2[k] - x0[k], b[k][l] = x3[k] - x0[k];
  }
  hinge_angles(e, a, b, g.floor2, out);
}

/// Difference of two angles, brought into [-pi, pi]: a fold that swings through pi is no jump in time.
double angle_difference(double a, double b) {
  const double d = a - b;
  if (d > std::numbers::pi) return d - 2 * std::numbers::pi;
  if (d < -std::numbers::pi) return d + 2 * std::numbers::pi;
  return d;
}

}  // namespace

Bending::Bending(const ClothTopology& topology) {
  std::vector<std::size_t> element;
  for (std::size_t i = 0; i < topology.hinges.size(); ++i) {
    if (!(topology.hinges[i].stiffness > 0)) continue;
    stencils_.push_back(topology.hinges[i].vertex);
    element.push_back(i);
  }
  schedule_ = make_element_schedule(stencils_, topology.rest);
  groups_.assign(schedule_.group_count(), Group{});
  for (std::size_t slot = 0; slot < schedule_.slot.size(); ++slot) {
    Group& g = groups_[slot / k_lanes];
    const std::size_t l = slot % k_lanes;
    g.floor2[l] = 1;
    if (schedule_.slot[slot] < 0) continue;
    const Hinge& hinge = topology.hinges[element[at(schedule_.slot[slot])]];
    for (std::size_t k = 0; k < 4; ++k) g.vertex[k][l] = hinge.vertex[k];
    g.stiffness[l] = hinge.stiffness;
    g.rest_angle[l] = hinge.rest_angle;
    g.damping_time[l] = topology.pieces[at(hinge.piece)].fabric.damping;
    g.floor2[l] = hinge.rest_area * hinge.rest_area * k_collapsed * k_collapsed;
  }
}

void Bending::begin_step(const StepContext& context) {
  CHECK(context.h > 0 && context.beta_h > 0);
  inverse_rate_time_ = context.x_t0.empty() ? 0 : 1 / context.rate_time();
  if (inverse_rate_time_ == 0) return;
  const bool history = context.has_history() && context.b != 0;
  parallel_for(groups_.size(), k_chunk_groups, [&](std::size_t begin, std::size_t end) {
    HingeAngles now, before;
    for (std::size_t i = begin; i < end; ++i) {
      Group& g = groups_[i];
      angles(g, context.x_t0, now);
      if (history) angles(g, context.x_tm1, before);
      for (int l = 0; l < k_lanes; ++l)
        g.reference[l] = now.theta[l] + (history ? context.b * angle_difference(now.theta[l], before.theta[l]) : 0.0);
    }
  });
}

double Bending::value(std::span<const Vec3> x) const {
  return sum_over_chunks(schedule_, [&](std::size_t begin, std::size_t end) {
    HingeAngles h;
    double sum[k_lanes] = {};
    for (std::size_t i = begin; i < end; ++i) {
      const Group& g = groups_[i];
      angles(g, x, h);
      for (int l = 0; l < k_lanes; ++l) {
        const double bend = h.theta[l] - g.rest_angle[l], rate = angle_difference(h.theta[l], g.reference[l]);
        sum[l] += 0.5 * g.stiffness[l] * (bend * bend + g.damping_time[l] * inverse_rate_time_ * rate * rate);
      }
    }
    double total = 0;
    for (int l = 0; l < k_lanes; ++l) total += sum[l];
    return total;
  });
}

void Bending::add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const {
  for_each_chunk(schedule_, [&](std::size_t begin, std::size_t end) {
    HingeAngles h;
    for (std::size_t i = begin; i < end; ++i) {
      const Group& g = groups_[i];
      angles(g, x, h);
      alignas(32) HingeLane g0[3], g1[3], moment;
      for (int l = 0; l < k_lanes; ++l)
        moment[l] = g.stiffness[l] * (h.theta[l] - g.rest_angle[l] +
                                      g.damping_time[l] * inverse_rate_time_ * angle_difference(h.theta[l], g.reference[l]));
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < k_lanes; ++l) {
          h.g2[k][l] *= moment[l], h.g3[k][l] *= moment[l];
          g1[k][l] = h.s2[l] * h.g2[k][l] + h.s3[l] * h.g3[k][l];
          g0[k][l] = h.g2[k][l] + h.g3[k][l] - g1[k][l];
        }
      for (int l = 0; l < k_lanes; ++l) {
        gradient[at(g.vertex[0][l])] -= Vec3(g0[0][l], g0[1][l], g0[2][l]);
        gradient[at(g.vertex[1][l])] -= Vec3(g1[0][l], g1[1][l], g1[2][l]);
        gradient[at(g.vertex[2][l])] += Vec3(h.g2[0][l], h.g2[1][l], h.g2[2][l]);
        gradient[at(g.vertex[3][l])] += Vec3(h.g3[0][l], h.g3[1][l], h.g3[2][l]);
      }
    }
  });
}

void Bending::add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const {
  positions_.bind(*hessian.pattern, stencils_, schedule_.slot);
  for_each_chunk(schedule_, [&](std::size_t begin, std::size_t end) {
    HingeAngles h;
    alignas(32) float w[12][k_lanes];  // square root of the stiffness times the gradient, vertex by vertex
    for (std::size_t i = begin; i < end; ++i) {
      const Group& g = groups_[i];
      angles(g, x, h);
      alignas(32) HingeLane root;
      for (int l = 0; l < k_lanes; ++l)
        root[l] = std::sqrt(g.stiffness[l] * (1 + g.damping_time[l] * inverse_rate_time_));
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < k_lanes; ++l) {
          const double a = root[l] * h.g2[k][l], b = root[l] * h.g3[k][l];
          const double one = -(h.s2[l] * a + h.s3[l] * b);
          w[k][l] = static_cast<float>(-(a + b) - one);
          w[3 + k][l] = static_cast<float>(one);
          w[6 + k][l] = static_cast<float>(a);
          w[9 + k][l] = static_cast<float>(b);
        }
      for (std::size_t l = 0; l < k_lanes && schedule_.slot[i * k_lanes + l] >= 0; ++l) {
        const auto& p = positions_[i * k_lanes + l];
        Vec3f v[4];
        for (int c = 0; c < 4; ++c) v[c] = Vec3f(w[3 * c][l], w[3 * c + 1][l], w[3 * c + 2][l]);
        Mat3f* blocks = hessian.blocks.data();
        for (int a = 0; a < 4; ++a)
          for (int b = 0; b < 4; ++b) blocks[p[at(4 * a + b)]].noalias() += v[a] * v[b].transpose();
      }
    }
  });
}

}  // namespace ft
