#include "solvers/energies/membrane.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "baker/core/check.h"
#include "solvers/energies/caps.h"
#include "solvers/energies/membrane_element.h"

namespace ft::inline solvers {

using namespace membrane;

namespace {

constexpr double k_no_limit = 1e30;

/// Green strain of a line that is longer by this share; a limit of 0 is none.
double green_limit(double strain) {
  return strain > 0 ? strain + 0.5 * strain * strain : k_no_limit;
}

/// 2 E12 of yarns that have their length and turn by an angle against each other; a limit of 0 is none.
double shear_limit(double angle) {
  return angle > 0 ? std::sin(angle) : k_no_limit;
}

}  // namespace

std::array<double, 4> membrane_stiffness(const Fabric& f) {
  // E_weft nu_warp = E_warp nu_weft holds with nu_weft = nu sqrt(E_weft / E_warp), and nu_weft nu_warp = nu^2.
  const double scale = 1 / (1 - f.poisson * f.poisson);
  return {f.stretch_weft * scale, f.stretch_warp * scale,
          f.poisson * std::sqrt(f.stretch_weft * f.stretch_warp) * scale, f.shear};
}

Membrane::Membrane(const ClothTopology& topology) {
  for (const ClothPiece& piece : topology.pieces) {
    const Fabric& fabric = piece.fabric;
    const auto c = membrane_stiffness(fabric);
    materials_.push_back(
        {{c[0], c[1], c[2], c[3]},
         fabric.damping,
         {green_limit(fabric.limit_weft), green_limit(fabric.limit_warp), shear_limit(fabric.limit_shear)},
         fabric.limit_stretch,
         fabric.limit_jam});
  }
  const TriangleOrder& order = triangle_order(topology);
  slots_ = order.slots;
  groups_.assign(slots_->schedule.group_count(), Group{});
  reference_.assign(groups_.size(), Reference{});
  for (std::size_t slot = 0; slot < order.triangle.size(); ++slot) {
    const std::size_t t = order.triangle[slot];
    Group& g = groups_[slot / k_lanes];
    const std::size_t l = slot % k_lanes;
    for (std::size_t k = 0; k < 4; ++k) g.rest_inverse[k][l] = topology.rest_inverse[t][k];
    g.area[l] = topology.rest_area[t] * topology.factor(t, &VertexMaps::stretch) *
                cap_stiffness(topology.rest_area[t], topology.rest_inverse[t]);
  }
}

std::vector<std::array<int, 4>> Membrane::stencils() const {
  std::vector<std::array<int, 4>> out;
  out.reserve(slots_->schedule.count);
  for (std::size_t slot = 0; slot < slots_->schedule.count; ++slot)
    out.push_back(
        {slots_->vertices.number(slot, 0), slots_->vertices.number(slot, 1), slots_->vertices.number(slot, 2), -1});
  return out;
}

void Membrane::find_places(const BlockPattern& pattern) const {
  positions_.bind(pattern, slots_->schedule.count,
                  [&](std::size_t slot, std::size_t corner) { return slots_->vertices.number(slot, corner); });
}

void Membrane::begin_step(const StepContext& context) {
  CHECK(context.h > 0 && context.beta_h > 0);
  inverse_rate_time_ = context.x_t0.empty() ? 0 : 1 / context.rate_time();
  if (inverse_rate_time_ == 0) return;
  const bool history = context.has_history() && context.b != 0;
  parallel_for(groups_.size(), k_chunk_groups, [&](std::size_t begin, std::size_t end) {
    Vertices v;
    Deformation d;
    alignas(32) Lane e[3], before[3] = {};
    const double a = history ? context.a : 1, b = history ? context.b : 0;
    for (std::size_t i = begin; i < end; ++i) {
      slots_->vertices.get(i, v);
      deformation(v, groups_[i], context.x_t0, d);
      strain(d, e);
      if (history) {
        deformation(v, groups_[i], context.x_tm1, d);
        strain(d, before);
      }
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < k_lanes; ++l)
          reference_[i].strain[k][l] = static_cast<float>(a * e[k][l] - b * before[k][l]);
    }
  });
}

double Membrane::value(std::span<const Vec3> x) const {
  return sum_over_chunks(slots_->schedule, [&](std::size_t begin, std::size_t end) {
    Vertices v;
    Deformation d;
    Constants c;
    alignas(32) Lane e[3], sum = {};
    for (std::size_t i = begin; i < end; ++i) {
      const Group& g = groups_[i];
      const Reference& ref = reference_[i];
      slots_->vertices.get(i, v);
      constants(g, slots_->pieces(i), materials_, c);
      deformation(v, g, x, d);
      strain(d, e);
      for (int l = 0; l < k_lanes; ++l) {
        const double damping = c.damping_time[l] * inverse_rate_time_;
        const double r0 = e[0][l] - ref.strain[0][l], r1 = e[1][l] - ref.strain[1][l], r2 = e[2][l] - ref.strain[2][l];
        const double elastic = c.stiffness[0][l] * e[0][l] * e[0][l] + c.stiffness[1][l] * e[1][l] * e[1][l] +
                               2 * c.stiffness[2][l] * e[0][l] * e[1][l] + c.stiffness[3][l] * e[2][l] * e[2][l];
        const double viscous = c.stiffness[0][l] * r0 * r0 + c.stiffness[1][l] * r1 * r1 +
                               2 * c.stiffness[2][l] * r0 * r1 + c.stiffness[3][l] * r2 * r2;
        sum[l] += 0.5 * (elastic + damping * viscous) +
                  c.limit_stiffness[l] * (taut(e[0][l] - c.limit[0][l]).value + taut(e[1][l] - c.limit[1][l]).value) +
                  c.jam_stiffness[l] * jammed(e[2][l], c.limit[2][l]).value;
      }
    }
    double total = 0;
    for (int l = 0; l < k_lanes; ++l) total += sum[l];
    return total;
  });
}

struct Membrane::Stressed {
  Vertices vertices;
  Constants constants;
  Deformation d;
  alignas(32) Lane e[3], s[3];  ///< see strain() and stress()
};

void Membrane::measure(std::size_t group, std::span<const Vec3> x, Stressed& out) const {
  slots_->vertices.get(group, out.vertices);
  constants(groups_[group], slots_->pieces(group), materials_, out.constants);
  deformation(out.vertices, groups_[group], x, out.d);
  strain(out.d, out.e);
  stress(out.constants, reference_[group], inverse_rate_time_, out.e, out.s);
}

void Membrane::add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const {
  for_each_chunk(slots_->schedule, [&](std::size_t begin, std::size_t end) {
    Stressed stressed;
    for (std::size_t i = begin; i < end; ++i) {
      measure(i, x, stressed);
      add_group_gradient(i, stressed, gradient);
    }
  });
}

void Membrane::add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const {
  find_places(*hessian.pattern);
  for_each_chunk(slots_->schedule, [&](std::size_t begin, std::size_t end) {
    Stressed stressed;
    for (std::size_t i = begin; i < end; ++i) {
      measure(i, x, stressed);
      add_group_hessian(i, stressed, hessian);
    }
  });
}

void Membrane::add_derivatives(std::span<const Vec3> x, std::span<Vec3> gradient, BlockMatrix& hessian) const {
  find_places(*hessian.pattern);
  for_each_chunk(slots_->schedule, [&](std::size_t begin, std::size_t end) {
    Stressed stressed;
    for (std::size_t i = begin; i < end; ++i) {
      measure(i, x, stressed);
      add_group_gradient(i, stressed, gradient);
      add_group_hessian(i, stressed, hessian);
    }
  });
}

void Membrane::add_group_gradient(std::size_t group, const Stressed& stressed, std::span<Vec3> gradient) const {
  const Deformation& d = stressed.d;
  const Lane* s = stressed.s;
  const auto& r = groups_[group].rest_inverse;
  alignas(32) Lane g1[3], g2[3];
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < k_lanes; ++l) {
      const double p1 = d.f1[k][l] * s[0][l] + d.f2[k][l] * s[2][l];  // column 1 of area F S
      const double p2 = d.f1[k][l] * s[2][l] + d.f2[k][l] * s[1][l];
      g1[k][l] = p1 * r[0][l] + p2 * r[1][l];
      g2[k][l] = p1 * r[2][l] + p2 * r[3][l];
    }
  // Padding has the vertices of another element: it must not even add zero.
  const std::size_t used = slots_->schedule.used(group);
  for (std::size_t l = 0; l < used; ++l) {
    const Vec3 a(g1[0][l], g1[1][l], g1[2][l]), b(g2[0][l], g2[1][l], g2[2][l]);
    gradient[at(stressed.vertices.column[0][l])] -= a + b;
    gradient[at(stressed.vertices.column[1][l])] += a;
    gradient[at(stressed.vertices.column[2][l])] += b;
  }
}

void Membrane::add_group_hessian(std::size_t group, const Stressed& stressed, BlockMatrix& hessian) const {
  ElementBlocks blocks;
  element_blocks(groups_[group], stressed.constants, stressed.d, stressed.e, stressed.s, inverse_rate_time_, blocks);
  scatter(blocks, stressed.vertices, positions_, group, slots_->schedule.used(group), hessian);
}

}  // namespace ft::inline solvers
