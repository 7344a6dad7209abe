#include "solvers/energies/membrane.h"

#include <algorithm>
#include <cmath>

#include "baker/core/check.h"

namespace ft {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

using Lane = double[k_lanes];
using LaneF = float[k_lanes];

/// Two edges and the deformation gradient F = (f1 f2) of a group.
struct Deformation {
  alignas(32) Lane f1[3], f2[3];
};

void deformation(const Membrane::Group& g, std::span<const Vec3> x, Deformation& out) {
  alignas(32) Lane e1[3], e2[3];
  for (int l = 0; l < k_lanes; ++l) {
    const Vec3 &x0 = x[at(g.vertex[0][l])], &x1 = x[at(g.vertex[1][l])], &x2 = x[at(g.vertex[2][l])];
    for (int k = 0; k < 3; ++k) e1[k][l] = x1[k] - x0[k], e2[k][l] = x2[k] - x0[k];
  }
  const auto& r = g.rest_inverse;
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < k_lanes; ++l) {
      out.f1[k][l] = e1[k][l] * r[0][l] + e2[k][l] * r[2][l];
      out.f2[k][l] = e1[k][l] * r[1][l] + e2[k][l] * r[3][l];
    }
}

/// Green strain E11, E22, 2 E12.
void strain(const Deformation& d, Lane* e) {
  for (int l = 0; l < k_lanes; ++l) {
    const double a0 = d.f1[0][l], a1 = d.f1[1][l], a2 = d.f1[2][l];
    const double b0 = d.f2[0][l], b1 = d.f2[1][l], b2 = d.f2[2][l];
    e[0][l] = 0.5 * (a0 * a0 + a1 * a1 + a2 * a2 - 1);
    e[1][l] = 0.5 * (b0 * b0 + b1 * b1 + b2 * b2 - 1);
    e[2][l] = a0 * b0 + a1 * b1 + a2 * b2;
  }
}

/// Area times second Piola-Kirchhoff stress with damping: S11, S22, S12.
void stress(const Membrane::Group& g, const Membrane::Reference& ref, double inverse_rate_time, const Lane* e, Lane* s) {
  for (int l = 0; l < k_lanes; ++l) {
    const double d = g.damping_time[l] * inverse_rate_time;
    const double e0 = e[0][l] + d * (e[0][l] - ref.strain[0][l]);
    const double e1 = e[1][l] + d * (e[1][l] - ref.strain[1][l]);
    const double e2 = e[2][l] + d * (e[2][l] - ref.strain[2][l]);
    s[0][l] = g.stiffness[0][l] * e0 + g.stiffness[2][l] * e1;
    s[1][l] = g.stiffness[2][l] * e0 + g.stiffness[1][l] * e1;
    s[2][l] = g.stiffness[3][l] * e2;
  }
}

/// Blocks (1,1), (1,2), (2,2) of the element matrix; the others follow from its rows summing to zero.
struct ElementBlocks {
  alignas(32) LaneF b11[9], b12[9], b22[9];  ///< column by column
};

/// Block (a, b) = F M_ab F^T + s_ab I, where M_ab holds the shape gradients g and the stiffness, s_ab = g_a . S+ g_b.
void element_blocks(const Membrane::Group& g, const Deformation& d, const Lane* s, double inverse_rate_time,
                    ElementBlocks& out) {
  alignas(32) LaneF f1[3], f2[3], r[4], c[4], t[3];
  for (int l = 0; l < k_lanes; ++l) {
    const double more = 1 + g.damping_time[l] * inverse_rate_time;
    for (int k = 0; k < 3; ++k) {
      f1[k][l] = static_cast<float>(d.f1[k][l]);
      f2[k][l] = static_cast<float>(d.f2[k][l]);
      t[k][l] = static_cast<float>(s[k][l]);
    }
    for (int k = 0; k < 4; ++k) {
      r[k][l] = static_cast<float>(g.rest_inverse[k][l]);
      c[k][l] = static_cast<float>(more * g.stiffness[k][l]);
    }
  }
  // Positive part of the 2x2 stress: alpha S + beta I, from the eigenvalues mean +- radius.
  alignas(32) LaneF p11, p22, p12;
  for (int l = 0; l < k_lanes; ++l) {
    const float mean = 0.5f * (t[0][l] + t[1][l]), half = 0.5f * (t[0][l] - t[1][l]);
    const float radius = std::sqrt(half * half + t[2][l] * t[2][l]);
    const float l1 = mean + radius, l2 = mean - radius;
    const float q1 = l1 > 0 ? l1 : 0, q2 = l2 > 0 ? l2 : 0;
    const float twice = 2 * radius > 1e-30f ? 2 * radius : 1e-30f;
    const float alpha = (q1 - q2) / twice, beta = q1 - alpha * l1;
    p11[l] = alpha * t[0][l] + beta, p22[l] = alpha * t[1][l] + beta, p12[l] = alpha * t[2][l];
  }
  const auto block = [&](const LaneF& ax, const LaneF& ay, const LaneF& bx, const LaneF& by, LaneF* o) {
    for (int l = 0; l < k_lanes; ++l) {
      const float xx = ax[l] * bx[l], yy = ay[l] * by[l], xy = ax[l] * by[l], yx = ay[l] * bx[l];
      const float m11 = c[0][l] * xx + c[3][l] * yy, m22 = c[1][l] * yy + c[3][l] * xx;
      const float m12 = c[2][l] * xy + c[3][l] * yx, m21 = c[2][l] * yx + c[3][l] * xy;
      const float sab = p11[l] * xx + p22[l] * yy + p12[l] * (xy + yx);
      const float u0 = f1[0][l], u1 = f1[1][l], u2 = f1[2][l], w0 = f2[0][l], w1 = f2[1][l], w2 = f2[2][l];
      // F M_ab F^T = u (m11 u + m12 w)^T + w (m21 u + m22 w)^T
      const float h0 = m11 * u0 + m12 * w0, h1 = m11 * u1 + m12 * w1, h2 = m11 * u2 + m12 * w2;
      const float k0 = m21 * u0 + m22 * w0, k1 = m21 * u1 + m22 * w1, k2 = m21 * u2 + m22 * w2;
      o[0][l] = u0 * h0 + w0 * k0 + sab, o[1][l] = u1 * h0 + w1 * k0, o[2][l] = u2 * h0 + w2 * k0;
      o[3][l] = u0 * h1 + w0 * k1, o[4][l] = u1 * h1 + w1 * k1 + sab, o[5][l] = u2 * h1 + w2 * k1;
      o[6][l] = u0 * h2 + w0 * k2, o[7][l] = u1 * h2 + w1 * k2, o[8][l] = u2 * h2 + w2 * k2 + sab;
    }
  };
  block(r[0], r[1], r[0], r[1], out.b11);
  block(r[0], r[1], r[2], r[3], out.b12);
  block(r[2], r[3], r[2], r[3], out.b22);
}

}  // namespace

std::array<double, 4> membrane_stiffness(const Fabric& f) {
  // E_weft nu_warp = E_warp nu_weft holds with nu_weft = nu sqrt(E_weft / E_warp), and nu_weft nu_warp = nu^2.
  const double scale = 1 / (1 - f.poisson * f.poisson);
  return {f.stretch_weft * scale, f.stretch_warp * scale, f.poisson * std::sqrt(f.stretch_weft * f.stretch_warp) * scale,
          f.shear};
}

Membrane::Membrane(const ClothTopology& topology) {
  std::vector<std::size_t> element;
  for (std::size_t t = 0; t < topology.triangles.size(); ++t) {
    if (topology.rest_area[t] == 0) continue;
    const Triangle& v = topology.triangles[t];
    stencils_.push_back({v[0], v[1], v[2], -1});
    element.push_back(t);
  }
  schedule_ = make_element_schedule(stencils_, topology.rest);
  groups_.assign(schedule_.group_count(), Group{});
  reference_.assign(groups_.size(), Reference{});
  for (std::size_t slot = 0; slot < schedule_.slot.size(); ++slot) {
    if (schedule_.slot[slot] < 0) continue;
    const std::size_t t = element[at(schedule_.slot[slot])];
    const Fabric& fabric = topology.fabric_of_triangle(t);
    const auto c = membrane_stiffness(fabric);
    Group& g = groups_[slot / k_lanes];
    const std::size_t l = slot % k_lanes;
    for (std::size_t k = 0; k < 3; ++k) g.vertex[k][l] = topology.triangles[t][k];
    for (std::size_t k = 0; k < 4; ++k) {
      g.rest_inverse[k][l] = topology.rest_inverse[t][k];
      g.stiffness[k][l] = topology.rest_area[t] * c[k];
    }
    g.damping_time[l] = fabric.damping;
  }
}

void Membrane::begin_step(const StepContext& context) {
  CHECK(context.h > 0 && context.beta_h > 0);
  inverse_rate_time_ = context.x_t0.empty() ? 0 : 1 / context.rate_time();
  if (inverse_rate_time_ == 0) return;
  const bool history = context.has_history() && context.b != 0;
  parallel_for(groups_.size(), k_chunk_groups, [&](std::size_t begin, std::size_t end) {
    Deformation d;
    alignas(32) Lane e[3];
    for (std::size_t i = begin; i < end; ++i) {
      deformation(groups_[i], context.x_t0, d);
      strain(d, reference_[i].strain);
      if (!history) continue;
      deformation(groups_[i], context.x_tm1, d);
      strain(d, e);
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < k_lanes; ++l) reference_[i].strain[k][l] = context.a * reference_[i].strain[k][l] - context.b * e[k][l];
    }
  });
}

double Membrane::value(std::span<const Vec3> x) const {
  return sum_over_chunks(schedule_, [&](std::size_t begin, std::size_t end) {
    Deformation d;
    alignas(32) Lane e[3], sum = {};
    for (std::size_t i = begin; i < end; ++i) {
      const Group& g = groups_[i];
      const Reference& ref = reference_[i];
      deformation(g, x, d);
      strain(d, e);
      for (int l = 0; l < k_lanes; ++l) {
        const double damping = g.damping_time[l] * inverse_rate_time_;
        const double r0 = e[0][l] - ref.strain[0][l], r1 = e[1][l] - ref.strain[1][l], r2 = e[2][l] - ref.strain[2][l];
        const double elastic = g.stiffness[0][l] * e[0][l] * e[0][l] + g.stiffness[1][l] * e[1][l] * e[1][l] +
                               2 * g.stiffness[2][l] * e[0][l] * e[1][l] + g.stiffness[3][l] * e[2][l] * e[2][l];
        const double viscous = g.stiffness[0][l] * r0 * r0 + g.stiffness[1][l] * r1 * r1 + 2 * g.stiffness[2][l] * r0 * r1 +
                               g.stiffness[3][l] * r2 * r2;
        sum[l] += 0.5 * (elastic + damping * viscous);
      }
    }
    double total = 0;
    for (int l = 0; l < k_lanes; ++l) total += sum[l];
    return total;
  });
}

void Membrane::add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const {
  for_each_chunk(schedule_, [&](std::size_t begin, std::size_t end) {
    Deformation d;
    alignas(32) Lane e[3], s[3], g1[3], g2[3];
    for (std::size_t i = begin; i < end; ++i) {
      const Group& g = groups_[i];
      deformation(g, x, d);
      strain(d, e);
      stress(g, reference_[i], inverse_rate_time_, e, s);
      const auto& r = g.rest_inverse;
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < k_lanes; ++l) {
          const double p1 = d.f1[k][l] * s[0][l] + d.f2[k][l] * s[2][l];  // column 1 of area F S
          const double p2 = d.f1[k][l] * s[2][l] + d.f2[k][l] * s[1][l];
          g1[k][l] = p1 * r[0][l] + p2 * r[1][l];
          g2[k][l] = p1 * r[2][l] + p2 * r[3][l];
        }
      for (int l = 0; l < k_lanes; ++l) {
        const Vec3 a(g1[0][l], g1[1][l], g1[2][l]), b(g2[0][l], g2[1][l], g2[2][l]);
        gradient[at(g.vertex[0][l])] -= a + b;
        gradient[at(g.vertex[1][l])] += a;
        gradient[at(g.vertex[2][l])] += b;
      }
    }
  });
}

void Membrane::add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const {
  positions_.bind(*hessian.pattern, stencils_, schedule_.slot);
  for_each_chunk(schedule_, [&](std::size_t begin, std::size_t end) {
    Deformation d;
    ElementBlocks blocks;
    alignas(32) Lane e[3], s[3];
    for (std::size_t i = begin; i < end; ++i) {
      const Group& g = groups_[i];
      deformation(g, x, d);
      strain(d, e);
      stress(g, reference_[i], inverse_rate_time_, e, s);
      element_blocks(g, d, s, inverse_rate_time_, blocks);
      for (std::size_t l = 0; l < k_lanes && schedule_.slot[i * k_lanes + l] >= 0; ++l) {
        const auto& p = positions_[i * k_lanes + l];
        Mat3f b11, b12, b22;
        for (int k = 0; k < 9; ++k)
          b11.data()[k] = blocks.b11[k][l], b12.data()[k] = blocks.b12[k][l], b22.data()[k] = blocks.b22[k][l];
        const Mat3f b21 = b12.transpose();
        const Mat3f b10 = -(b11 + b12), b20 = -(b21 + b22);
        const Mat3f b00 = -(b10 + b20);
        Mat3f* h = hessian.blocks.data();
        h[p[0]] += b00, h[p[1]] += b10.transpose(), h[p[2]] += b20.transpose();
        h[p[3]] += b10, h[p[4]] += b11, h[p[5]] += b12;
        h[p[6]] += b20, h[p[7]] += b21, h[p[8]] += b22;
      }
    }
  });
}

}  // namespace ft
