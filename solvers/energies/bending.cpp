#include "solvers/energies/bending.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "baker/core/check.h"
#include "baker/core/give_back.h"
#include "solvers/energies/block_scatter.h"
#include "solvers/energies/hinge_math.h"

namespace ft::inline solvers {
namespace {

/// A triangle pressed below this share of its rest area counts as degenerate.
constexpr double k_collapsed = 1e-3;

constexpr int k_mantissa_bits = 23;

/// The exponent of a float: the limit is a rough one, too.
std::uint8_t degenerate_below(double rest_area) {
  const double least = 2 * k_collapsed * rest_area;
  const float floor = least > 0 ? std::max(static_cast<float>(least * least), std::numeric_limits<float>::min()) : 1.0f;
  return static_cast<std::uint8_t>(std::bit_cast<std::uint32_t>(floor) >> k_mantissa_bits);
}

void powers_of_two(const std::uint8_t (&exponent)[k_lanes], float (&out)[k_lanes]) {
  for (int l = 0; l < k_lanes; ++l) out[l] = std::bit_cast<float>(std::uint32_t{exponent[l]} << k_mantissa_bits);
}

struct HingeEdges {
  alignas(32) HingeLane e[3], a[3], b[3];
};

void edges(const Bending::Vertices& v, std::span<const Vec3> x, HingeEdges& out) {
  for (int l = 0; l < k_lanes; ++l) {
    const Vec3 &x0 = x[at(v.column[0][l])], &x1 = x[at(v.column[1][l])];
    const Vec3 &x2 = x[at(v.column[2][l])], &x3 = x[at(v.column[3][l])];
    for (int k = 0; k < 3; ++k) out.e[k][l] = x1[k] - x0[k], out.a[k][l] = x2[k] - x0[k], out.b[k][l] = x3[k] - x0[k];
  }
}

/// Difference of two angles, brought into [-pi, pi]: a fold that swings through pi is no jump in time.
double angle_difference(double a, double b) {
  const double d = a - b;
  const double full = 2 * std::numbers::pi;
  return d > std::numbers::pi ? d - full : d < -std::numbers::pi ? d + full : d;
}

/// Neighbours of a hinge: slots; -1: none so far.
using Neighbours = std::array<int, Bending::k_couplings - 1>;

void add_coupling(Bending::HingeGroup& g, std::size_t lane, Neighbours& neighbours, int slot, int other, double value) {
  const float v = static_cast<float>(value);
  if (other == slot) {
    g.coupling[0][lane] += v;
    return;
  }
  for (std::size_t k = 0; k < neighbours.size(); ++k) {
    if (neighbours[k] < 0) neighbours[k] = other;
    if (neighbours[k] != other) continue;
    g.coupling[k + 1][lane] += v;
    return;
  }
  CHECK(false);  // two triangles of three edges each: never more than five
}

}  // namespace

Bending::Bending(const ClothTopology& topology) {
  for (const ClothPiece& piece : topology.pieces) damping_time_.push_back(piece.fabric.damping);
  CHECK(damping_time_.size() <= std::numeric_limits<std::uint16_t>::max());
  std::vector<std::array<int, 4>> hinges;
  std::vector<int> index(topology.hinges.size(), -1);  // hinges that some triangle uses
  for (const BendElement& bend : topology.bends)
    for (const int h : bend.hinge)
      if (h >= 0 && index[at(h)] < 0) {
        index[at(h)] = static_cast<int>(hinges.size());
        hinges.push_back(topology.hinges[at(h)].vertex);
      }
  std::vector<int> hinge_of_slot, slot_of(hinges.size());
  schedule_ = make_element_schedule(hinges, topology.rest, hinge_of_slot);
  for (std::size_t s = 0; s < schedule_.count; ++s) slot_of[at(hinge_of_slot[s])] = static_cast<int>(s);
  vertices_ = group_indices<4>(schedule_, [&](std::size_t slot) { return hinges[at(hinge_of_slot[slot])]; });
  groups_.assign(schedule_.group_count(), HingeGroup{});
  for (HingeGroup& g : groups_)
    for (std::size_t l = 0; l < k_lanes; ++l) g.floor2[l] = g.floor3[l] = degenerate_below(0);
  for (std::size_t h = 0; h < index.size(); ++h) {
    if (index[h] < 0) continue;
    const Hinge& hinge = topology.hinges[h];
    const std::size_t s = at(slot_of[at(index[h])]), l = s % k_lanes;
    HingeGroup& g = groups_[s / k_lanes];
    g.rest_angle[l] = static_cast<float>(hinge.rest_angle);
    g.piece[l] = static_cast<std::uint16_t>(hinge.piece);
    g.floor2[l] = degenerate_below(topology.rest_area[at(hinge.triangle[0])]);
    g.floor3[l] = degenerate_below(topology.rest_area[at(hinge.triangle[1])]);
  }
  std::vector<Neighbours> neighbours(schedule_.count);
  for (Neighbours& row : neighbours) row.fill(-1);
  for (const BendElement& bend : topology.bends) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (bend.hinge[i] < 0) continue;
      const int row = slot_of[at(index[at(bend.hinge[i])])];
      for (std::size_t j = 0; j < 3; ++j) {
        if (bend.hinge[j] < 0) continue;
        CHECK(topology.hinges[at(bend.hinge[i])].piece == topology.hinges[at(bend.hinge[j])].piece);  // measure()
        add_coupling(groups_[at(row) / k_lanes], at(row) % k_lanes, neighbours[at(row)], row,
                     slot_of[at(index[at(bend.hinge[j])])],
                     bend.sign[i] * bend.sign[j] * bend.stiffness(static_cast<int>(i), static_cast<int>(j)));
      }
    }
  }
  for (std::size_t s = 0; s < neighbours.size(); ++s)  // unused couplings look at themselves, with no weight
    std::replace(neighbours[s].begin(), neighbours[s].end(), -1, static_cast<int>(s));
  neighbours_ = group_indices<k_couplings - 1>(schedule_, [&](std::size_t slot) { return neighbours[slot]; });
  root_.assign(damping_time_.size(), 0.0);
}

std::vector<std::array<int, 4>> Bending::stencils() const {
  std::vector<std::array<int, 4>> out;
  out.reserve(schedule_.count);
  for (std::size_t slot = 0; slot < schedule_.count; ++slot)
    out.push_back(
        {vertices_.number(slot, 0), vertices_.number(slot, 1), vertices_.number(slot, 2), vertices_.number(slot, 3)});
  return out;
}

void Bending::find_places(const BlockPattern& pattern) const {
  positions_.bind(pattern, schedule_.count,
                  [&](std::size_t slot, std::size_t corner) { return vertices_.number(slot, corner); });
}

void Bending::work_out(std::span<const Vec3> x, Bends& bends) const {
  const Hash128 of = hash_bytes(std::as_bytes(x));
  if (bends.of == of && !bends.phi.empty()) return;
  bends.of = of;
  bends.phi.resize(groups_.size() * k_lanes);
  parallel_for(groups_.size(), k_chunk_groups, [&](std::size_t begin, std::size_t end) {
    Vertices v;
    HingeEdges h;
    alignas(32) HingeLane angle;
    for (std::size_t i = begin; i < end; ++i) {
      vertices_.get(i, v);
      edges(v, x, h);
      hinge_angle_lanes(h.e, h.a, h.b, angle);
      double* phi = bends.phi.data() + i * k_lanes;
      for (int l = 0; l < k_lanes; ++l) phi[l] = angle[l] - groups_[i].rest_angle[l];
    }
  });
}

void Bending::begin_step(const StepContext& context) {
  CHECK(context.h > 0 && context.beta_h > 0);
  measured_ = false;
  damps_ = !context.x_t0.empty();
  if (!damps_) return;
  for (std::size_t p = 0; p < root_.size(); ++p) root_[p] = std::sqrt(damping_time_[p] / context.rate_time());
  work_out(context.x_t0, last_);
  reference_.assign(last_.phi.begin(), last_.phi.end());
  if (!context.has_history() || context.b == 0) return;
  Bends before;
  work_out(context.x_tm1, before);
  parallel_for(reference_.size(), k_chunk_groups * k_lanes, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      reference_[s] = static_cast<float>(last_.phi[s] + context.b * angle_difference(last_.phi[s], before.phi[s]));
  });
}

/// rho / sqrt(d), of last_.
inline double Bending::since_reference(std::size_t slot) const {
  return angle_difference(last_.phi[slot], static_cast<double>(reference_[slot]));
}

/// Fills last_, moment_ and energy_.
void Bending::measure(std::span<const Vec3> x) const {
  if (measured_ && last_.of == hash_bytes(std::as_bytes(x))) return;
  measured_ = true;
  work_out(x, last_);
  moment_.resize(last_.phi.size());
  energy_ = sum_over_chunks(schedule_, [&](std::size_t begin, std::size_t end) {
    double total = 0;
    GroupIndices<k_couplings - 1>::Group neighbours;
    for (std::size_t i = begin; i < end; ++i) {
      const HingeGroup& g = groups_[i];
      neighbours_.get(i, neighbours);
      for (std::size_t l = 0; l < k_lanes; ++l) {
        const std::size_t slot = i * k_lanes + l;
        double elastic = g.coupling[0][l] * last_.phi[slot];
        for (int k = 0; k + 1 < k_couplings; ++k)
          elastic += g.coupling[k + 1][l] * last_.phi[at(neighbours.column[k][l])];
        moment_[slot] = elastic;
        total += 0.5 * elastic * last_.phi[slot];
        if (!damps_) continue;
        // What is coupled is of one piece.
        const double own = since_reference(slot), damping = root_[g.piece[l]] * root_[g.piece[l]];
        double viscous = g.coupling[0][l] * own;
        for (int k = 0; k + 1 < k_couplings; ++k)
          viscous += g.coupling[k + 1][l] * since_reference(at(neighbours.column[k][l]));
        moment_[slot] += damping * viscous;
        total += 0.5 * damping * viscous * own;
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
  Vertices vertices;
  HingeEdges edges;
  HingeGradients d;

  void of(const HingeGroup& g, std::span<const Vec3> x) {
    ft::edges(vertices, x, edges);
    alignas(32) float floor2[k_lanes], floor3[k_lanes];
    powers_of_two(g.floor2, floor2);
    powers_of_two(g.floor3, floor3);
    hinge_gradient_lanes(edges.e, edges.a, edges.b, floor2, floor3, d);
  }
};

void Bending::add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const {
  measure(x);
  for_each_chunk(schedule_, [&](std::size_t begin, std::size_t end) {
    HingeShape shape;
    for (std::size_t i = begin; i < end; ++i) {
      vertices_.get(i, shape.vertices);
      shape.of(groups_[i], x);
      add_group_gradient(i, shape, gradient);
    }
  });
}

void Bending::add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const {
  find_places(*hessian.pattern);
  for_each_chunk(schedule_, [&](std::size_t begin, std::size_t end) {
    HingeShape shape;
    for (std::size_t i = begin; i < end; ++i) {
      vertices_.get(i, shape.vertices);
      shape.of(groups_[i], x);
      add_group_hessian(i, shape, hessian);
    }
  });
}

void Bending::add_derivatives(std::span<const Vec3> x, std::span<Vec3> gradient, BlockMatrix& hessian) const {
  measure(x);
  find_places(*hessian.pattern);
  for_each_chunk(schedule_, [&](std::size_t begin, std::size_t end) {
    HingeShape shape;
    for (std::size_t i = begin; i < end; ++i) {
      vertices_.get(i, shape.vertices);
      shape.of(groups_[i], x);
      add_group_gradient(i, shape, gradient);
      add_group_hessian(i, shape, hessian);
    }
  });
  measured_ = false;  // the next question is about another place
  give_back(last_.phi, moment_);
}

void Bending::add_group_gradient(std::size_t group, const HingeShape& shape, std::span<Vec3> gradient) const {
  const HingeGradients& d = shape.d;
  const double* moment = moment_.data() + group * k_lanes;
  alignas(32) HingeLane g0[3], g1[3], g2[3], g3[3];
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < k_lanes; ++l) {
      g2[k][l] = d.g2[k][l] * moment[l], g3[k][l] = d.g3[k][l] * moment[l];
      g1[k][l] = d.s2[l] * g2[k][l] + d.s3[l] * g3[k][l];
      g0[k][l] = g2[k][l] + g3[k][l] - g1[k][l];
    }
  // Padding has the vertices of another element: it must not even add zero.
  const std::size_t used = schedule_.used(group);
  for (std::size_t l = 0; l < used; ++l) {
    gradient[at(shape.vertices.column[0][l])] -= Vec3(g0[0][l], g0[1][l], g0[2][l]);
    gradient[at(shape.vertices.column[1][l])] -= Vec3(g1[0][l], g1[1][l], g1[2][l]);
    gradient[at(shape.vertices.column[2][l])] += Vec3(g2[0][l], g2[1][l], g2[2][l]);
    gradient[at(shape.vertices.column[3][l])] += Vec3(g3[0][l], g3[1][l], g3[2][l]);
  }
}

void Bending::add_group_hessian(std::size_t group, const HingeShape& shape, BlockMatrix& hessian) const {
  const HingeGroup& g = groups_[group];
  const HingeGradients& d = shape.d;
  Lanes v[4][3], block[9];  // square root of the stiffness times grad theta, vertex by vertex
  alignas(32) HingeLane root;
  for (int l = 0; l < k_lanes; ++l) {
    const double damping = damps_ ? root_[g.piece[l]] : 0;
    root[l] = std::sqrt(g.coupling[0][l] * (1 + damping * damping));
  }
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
  const std::size_t used = schedule_.used(group);
  LaneInts vertex[4], diagonal[4];
  for (std::size_t a = 0; a < 4; ++a) {
    std::memcpy(&vertex[a], &shape.vertices.column[a], sizeof vertex[a]);
    diagonal[a] = diagonal_places(hessian.pattern->diagonal, vertex[a]);
  }
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = a; b < 4; ++b) {
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) block[3 * c + r] = v[a][r] * v[b][c];
      if (a != b) transpose_where(vertex[a] > vertex[b], block);
      add_blocks(block, used, hessian.blocks.data(),
                 a == b ? diagonal[a] : positions_.places(group, a, b, vertex, diagonal));
    }
}

}  // namespace ft::inline solvers
