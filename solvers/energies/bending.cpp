#include "solvers/energies/bending.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "baker/core/check.h"
#include "solvers/energies/block_scatter.h"
#include "solvers/energies/hinge_math.h"

namespace ft {
namespace {

/// A triangle pressed below this share of its rest area counts as degenerate.
constexpr double k_collapsed = 1e-3;

float degenerate_below(double rest_area) {
  const double least = 2 * k_collapsed * rest_area;
  return least > 0 ? std::max(static_cast<float>(least * least), std::numeric_limits<float>::min()) : 1;
}

struct HingeEdges {
  alignas(32) HingeLane e[3], a[3], b[3];
};

void edges(const Bending::HingeGroup& g, std::span<const Vec3> x, HingeEdges& out) {
  for (int l = 0; l < k_lanes; ++l) {
    const Vec3 &x0 = x[at(g.vertex[0][l])], &x1 = x[at(g.vertex[1][l])];
    const Vec3 &x2 = x[at(g.vertex[2][l])], &x3 = x[at(g.vertex[3][l])];
    for (int k = 0; k < 3; ++k) out.e[k][l] = x1[k] - x0[k], out.a[k][l] = x2[k] - x0[k], out.b[k][l] = x3[k] - x0[k];
  }
}

/// Difference of two angles, brought into [-pi, pi]: a fold that swings through pi is no jump in time.
double angle_difference(double a, double b) {
  const double d = a - b;
  const double full = 2 * std::numbers::pi;
  return d > std::numbers::pi ? d - full : d < -std::numbers::pi ? d + full : d;
}

void add_coupling(Bending::HingeGroup& g, std::size_t lane, int slot, int other, double value) {
  const float v = static_cast<float>(value);
  if (other == slot) {
    g.coupling[0][lane] += v;
    return;
  }
  for (int k = 0; k + 1 < Bending::k_couplings; ++k) {
    if (g.neighbour[k][lane] < 0) g.neighbour[k][lane] = other;
    if (g.neighbour[k][lane] != other) continue;
    g.coupling[k + 1][lane] += v;
    return;
  }
  CHECK(false);  // two triangles of three edges each: never more than five
}

}  // namespace

Bending::Bending(const ClothTopology& topology) {
  std::vector<std::array<int, 4>> hinges;
  std::vector<int> index(topology.hinges.size(), -1);  // hinges that some triangle uses
  for (const BendElement& bend : topology.bends)
    for (const int h : bend.hinge)
      if (h >= 0 && index[at(h)] < 0) {
        index[at(h)] = static_cast<int>(hinges.size());
        hinges.push_back(topology.hinges[at(h)].vertex);
      }
  hinge_schedule_ = make_element_schedule(hinges, topology.rest);
  std::vector<int> slot_of(hinges.size());
  for (std::size_t s = 0; s < hinge_schedule_.slot.size(); ++s)
    if (hinge_schedule_.slot[s] >= 0) slot_of[at(hinge_schedule_.slot[s])] = static_cast<int>(s);
  hinge_groups_.assign(hinge_schedule_.group_count(), HingeGroup{});
  phi_.assign(hinge_schedule_.slot.size(), 0.0);
  rho_ = moment_ = phi_;
  for (std::size_t s = 0; s < phi_.size(); ++s) {
    HingeGroup& g = hinge_groups_[s / k_lanes];
    const std::size_t l = s % k_lanes;
    g.floor2[l] = g.floor3[l] = 1;
    for (auto& row : g.neighbour) row[l] = -1;
  }
  for (std::size_t h = 0; h < index.size(); ++h) {
    if (index[h] < 0) continue;
    const Hinge& hinge = topology.hinges[h];
    const std::size_t s = at(slot_of[at(index[h])]), l = s % k_lanes;
    HingeGroup& g = hinge_groups_[s / k_lanes];
    for (std::size_t k = 0; k < 4; ++k) g.vertex[k][l] = hinge.vertex[k];
    g.rest_angle[l] = hinge.rest_angle;
    g.damping_time[l] = static_cast<float>(topology.pieces[at(hinge.piece)].fabric.damping);
    g.floor2[l] = degenerate_below(topology.rest_area[at(hinge.triangle[0])]);
    g.floor3[l] = degenerate_below(topology.rest_area[at(hinge.triangle[1])]);
  }
  for (const BendElement& bend : topology.bends) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (bend.hinge[i] < 0) continue;
      const int row = slot_of[at(index[at(bend.hinge[i])])];
      for (std::size_t j = 0; j < 3; ++j)
        if (bend.hinge[j] >= 0)
          add_coupling(hinge_groups_[at(row) / k_lanes], at(row) % k_lanes, row, slot_of[at(index[at(bend.hinge[j])])],
                       bend.sign[i] * bend.sign[j] * bend.stiffness(static_cast<int>(i), static_cast<int>(j)));
    }
  }
  for (std::size_t s = 0; s < phi_.size(); ++s)  // unused couplings look at themselves, with no weight
    for (auto& row : hinge_groups_[s / k_lanes].neighbour)
      if (row[s % k_lanes] < 0) row[s % k_lanes] = static_cast<int>(s);
}

std::vector<std::array<int, 4>> Bending::stencils() const {
  std::vector<std::array<int, 4>> out;
  for (std::size_t slot = 0; slot < hinge_schedule_.slot.size(); ++slot) {
    const auto& v = hinge_groups_[slot / k_lanes].vertex;
    const std::size_t l = slot % k_lanes;
    if (hinge_schedule_.slot[slot] >= 0) out.push_back({v[0][l], v[1][l], v[2][l], v[3][l]});
  }
  return out;
}

void Bending::find_places(const BlockPattern& pattern) const {
  positions_.bind(pattern, hinge_schedule_.slot, [&](std::size_t slot, std::size_t corner) {
    return hinge_groups_[slot / k_lanes].vertex[corner][slot % k_lanes];
  });
}

void Bending::work_out(std::span<const Vec3> x, Angles& angles) const {
  const Hash128 of = hash_bytes(std::as_bytes(x));
  if (angles.of == of && !angles.angle.empty()) return;
  angles.of = of;
  angles.angle.resize(phi_.size());
  parallel_for(hinge_groups_.size(), k_chunk_groups, [&](std::size_t begin, std::size_t end) {
    HingeEdges h;
    alignas(32) HingeLane angle;
    for (std::size_t i = begin; i < end; ++i) {
      edges(hinge_groups_[i], x, h);
      hinge_angle_lanes(h.e, h.a, h.b, angle);
      std::copy_n(angle, k_lanes, angles.angle.data() + i * k_lanes);
    }
  });
}

void Bending::begin_step(const StepContext& context) {
  CHECK(context.h > 0 && context.beta_h > 0);
  measured_ = false;
  inverse_rate_time_ = context.x_t0.empty() ? 0 : 1 / context.rate_time();
  if (inverse_rate_time_ == 0) return;
  const bool history = context.has_history() && context.b != 0;
  history_ = history ? context.b : 0;
  std::swap(start_, before_);  // the start of the last step is mostly where this one came from
  if (history) work_out(context.x_tm1, before_);
  if (last_.of == hash_bytes(std::as_bytes(context.x_t0)) && !last_.angle.empty())
    start_ = last_;
  else
    work_out(context.x_t0, start_);
}

/// Fills phi_, rho_, moment_ and energy_.
void Bending::measure(std::span<const Vec3> x) const {
  if (measured_ && last_.of == hash_bytes(std::as_bytes(x))) return;
  measured_ = true;
  work_out(x, last_);
  parallel_for(hinge_groups_.size(), k_chunk_groups, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const HingeGroup& g = hinge_groups_[i];
      const double* angle = last_.angle.data() + i * k_lanes;
      double* phi = phi_.data() + i * k_lanes;
      double* rho = rho_.data() + i * k_lanes;
      for (int l = 0; l < k_lanes; ++l) {
        phi[l] = angle[l] - g.rest_angle[l];
        rho[l] = 0;
      }
      if (inverse_rate_time_ == 0) continue;
      const double* start = start_.angle.data() + i * k_lanes;
      for (int l = 0; l < k_lanes; ++l) {
        const double before = history_ != 0 ? before_.angle[i * k_lanes + at(l)] : start[l];
        const double reference = start[l] + history_ * angle_difference(start[l], before);
        rho[l] = std::sqrt(g.damping_time[l] * inverse_rate_time_) * angle_difference(angle[l], reference);
      }
    }
  });
  energy_ = sum_over_chunks(hinge_schedule_, [&](std::size_t begin, std::size_t end) {
    double total = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const HingeGroup& g = hinge_groups_[i];
      for (std::size_t l = 0; l < k_lanes; ++l) {
        const std::size_t slot = i * k_lanes + l;
        double elastic = g.coupling[0][l] * phi_[slot], viscous = g.coupling[0][l] * rho_[slot];
        for (int k = 0; k + 1 < k_couplings; ++k) {
          const std::size_t n = at(g.neighbour[k][l]);
          elastic += g.coupling[k + 1][l] * phi_[n], viscous += g.coupling[k + 1][l] * rho_[n];
        }
        moment_[slot] = elastic + std::sqrt(g.damping_time[l] * inverse_rate_time_) * viscous;
        total += 0.5 * (elastic * phi_[slot] + viscous * rho_[slot]);
      }
    }
    return total;
  });
}

double Bending::value(std::span<const Vec3> x) const {
  measure(x);
  return energy_;
}

struct Bending::HingeShape {
  HingeEdges edges;
  HingeGradients d;

  void of(const HingeGroup& g, std::span<const Vec3> x) {
    ft::edges(g, x, edges);
    hinge_gradient_lanes(edges.e, edges.a, edges.b, g.floor2, g.floor3, d);
  }
};

void Bending::add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const {
  measure(x);
  for_each_chunk(hinge_schedule_, [&](std::size_t begin, std::size_t end) {
    HingeShape shape;
    for (std::size_t i = begin; i < end; ++i) {
      shape.of(hinge_groups_[i], x);
      add_group_gradient(i, shape, gradient);
    }
  });
}

void Bending::add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const {
  find_places(*hessian.pattern);
  for_each_chunk(hinge_schedule_, [&](std::size_t begin, std::size_t end) {
    HingeShape shape;
    for (std::size_t i = begin; i < end; ++i) {
      shape.of(hinge_groups_[i], x);
      add_group_hessian(i, shape, hessian);
    }
  });
}

void Bending::add_derivatives(std::span<const Vec3> x, std::span<Vec3> gradient, BlockMatrix& hessian) const {
  measure(x);
  find_places(*hessian.pattern);
  for_each_chunk(hinge_schedule_, [&](std::size_t begin, std::size_t end) {
    HingeShape shape;
    for (std::size_t i = begin; i < end; ++i) {
      shape.of(hinge_groups_[i], x);
      add_group_gradient(i, shape, gradient);
      add_group_hessian(i, shape, hessian);
    }
  });
}

void Bending::add_group_gradient(std::size_t group, const HingeShape& shape, std::span<Vec3> gradient) const {
  const HingeGroup& g = hinge_groups_[group];
  const HingeGradients& d = shape.d;
  const double* moment = moment_.data() + group * k_lanes;
  alignas(32) HingeLane g0[3], g1[3], g2[3], g3[3];
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < k_lanes; ++l) {
      g2[k][l] = d.g2[k][l] * moment[l], g3[k][l] = d.g3[k][l] * moment[l];
      g1[k][l] = d.s2[l] * g2[k][l] + d.s3[l] * g3[k][l];
      g0[k][l] = g2[k][l] + g3[k][l] - g1[k][l];
    }
  // Padding has vertex numbers that belong to other chunks: it must not even add zero.
  const std::size_t used = hinge_schedule_.used(group);
  for (std::size_t l = 0; l < used; ++l) {
    gradient[at(g.vertex[0][l])] -= Vec3(g0[0][l], g0[1][l], g0[2][l]);
    gradient[at(g.vertex[1][l])] -= Vec3(g1[0][l], g1[1][l], g1[2][l]);
    gradient[at(g.vertex[2][l])] += Vec3(g2[0][l], g2[1][l], g2[2][l]);
    gradient[at(g.vertex[3][l])] += Vec3(g3[0][l], g3[1][l], g3[2][l]);
  }
}

void Bending::add_group_hessian(std::size_t group, const HingeShape& shape, BlockMatrix& hessian) const {
  const HingeGroup& g = hinge_groups_[group];
  const HingeGradients& d = shape.d;
  Lanes v[4][3], block[9];  // square root of the stiffness times grad theta, vertex by vertex
  alignas(32) HingeLane root;
  for (int l = 0; l < k_lanes; ++l)
    root[l] = std::sqrt(g.coupling[0][l] * (1 + g.damping_time[l] * inverse_rate_time_));
  for (int k = 0; k < 3; ++k) {
    alignas(32) float one[k_lanes], two[k_lanes], three[k_lanes];
    for (int l = 0; l < k_lanes; ++l) {
      const double a = root[l] * d.g2[k][l], b = root[l] * d.g3[k][l];
      one[l] = static_cast<float>(-(d.s2[l] * a + d.s3[l] * b));
      two[l] = static_cast<float>(a);
      three[l] = static_cast<float>(b);
    }
    std::memcpy(&v[1][k], one, sizeof one), std::memcpy(&v[2][k], two, sizeof two),
        std::memcpy(&v[3][k], three, sizeof three);
    v[0][k] = -(v[1][k] + v[2][k] + v[3][k]);
  }
  const std::size_t first = group * k_lanes, used = hinge_schedule_.used(group);
  LaneInts vertex[4];
  for (std::size_t a = 0; a < 4; ++a) std::memcpy(&vertex[a], &g.vertex[a], sizeof vertex[a]);
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = a; b < 4; ++b) {
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) block[3 * c + r] = v[a][r] * v[b][c];
      if (a != b) transpose_where(vertex[a] > vertex[b], block);
      const std::size_t index = positions_.index_of(a, b);
      add_blocks(block, used, hessian.blocks.data(), [&](std::size_t l) { return positions_[first + l][index]; });
    }
}

}  // namespace ft
