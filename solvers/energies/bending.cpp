#include "solvers/energies/bending.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "baker/core/check.h"
#include "solvers/energies/hinge_math.h"

namespace ft {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// A triangle pressed below this share of its rest area counts as degenerate.
constexpr double k_collapsed = 1e-3;

double degenerate_below(double rest_area) {
  const double least = 2 * k_collapsed * rest_area;
  return least > 0 ? least * least : 1;
}

struct HingeEdges {
  alignas(32) HingeLane e[3], a[3], b[3];
};

void edges(const int (*vertex)[k_lanes], int v0, int v1, int v2, int v3, std::span<const Vec3> x, HingeEdges& out) {
  for (int l = 0; l < k_lanes; ++l) {
    const Vec3 &x0 = x[at(vertex[v0][l])], &x1 = x[at(vertex[v1][l])], &x2 = x[at(vertex[v2][l])], &x3 = x[at(vertex[v3][l])];
    for (int k = 0; k < 3; ++k) out.e[k][l] = x1[k] - x0[k], out.a[k][l] = x2[k] - x0[k], out.b[k][l] = x3[k] - x0[k];
  }
}

/// Difference of two angles, brought into [-pi, pi]: a fold that swings through pi is no jump in time.
double angle_difference(double a, double b) {
  const double d = a - b;
  const double full = 2 * std::numbers::pi;
  return d > std::numbers::pi ? d - full : d < -std::numbers::pi ? d + full : d;
}

/// root root^T = m for a positive semidefinite m.
Mat3 square_root(const Mat3& m) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(m);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

void add_coupling(Bending::HingeGroup& g, std::size_t lane, int slot, double value) {
  for (int k = 0; k < Bending::k_couplings; ++k) {
    if (k > 0 && g.neighbour[k][lane] < 0) g.neighbour[k][lane] = slot;
    if (g.neighbour[k][lane] != slot) continue;
    g.coupling[k][lane] += value;
    return;
  }
  CHECK(false);  // two triangles of three edges each: never more than five
}

}  // namespace

Bending::Bending(const ClothTopology& topology) {
  std::vector<int> index(topology.hinges.size(), -1);  // hinges that some triangle uses
  for (const BendElement& bend : topology.bends)
    for (const int h : bend.hinge)
      if (h >= 0 && index[at(h)] < 0) {
        index[at(h)] = static_cast<int>(hinges_.size());
        hinges_.push_back(topology.hinges[at(h)].vertex);
      }
  hinge_schedule_ = make_element_schedule(hinges_, topology.rest);
  std::vector<int> slot_of(hinges_.size());
  for (std::size_t s = 0; s < hinge_schedule_.slot.size(); ++s)
    if (hinge_schedule_.slot[s] >= 0) slot_of[at(hinge_schedule_.slot[s])] = static_cast<int>(s);
  hinge_groups_.assign(hinge_schedule_.group_count(), HingeGroup{});
  phi_.assign(hinge_schedule_.slot.size(), 0.0);
  rho_ = phi_;
  for (std::size_t s = 0; s < phi_.size(); ++s) {
    HingeGroup& g = hinge_groups_[s / k_lanes];
    const std::size_t l = s % k_lanes;
    g.floor2[l] = g.floor3[l] = 1;
    for (auto& row : g.neighbour) row[l] = -1;
    g.neighbour[0][l] = static_cast<int>(s);
  }
  for (std::size_t h = 0; h < index.size(); ++h) {
    if (index[h] < 0) continue;
    const Hinge& hinge = topology.hinges[h];
    const std::size_t s = at(slot_of[at(index[h])]), l = s % k_lanes;
    HingeGroup& g = hinge_groups_[s / k_lanes];
    for (std::size_t k = 0; k < 4; ++k) g.vertex[k][l] = hinge.vertex[k];
    g.rest_angle[l] = hinge.rest_angle;
    g.damping_time[l] = topology.pieces[at(hinge.piece)].fabric.damping;
    g.floor2[l] = degenerate_below(topology.rest_area[at(hinge.triangle[0])]);
    g.floor3[l] = degenerate_below(topology.rest_area[at(hinge.triangle[1])]);
  }
  for (const BendElement& bend : topology.bends) {
    const Triangle& t = topology.triangles[at(bend.triangle)];
    std::array<int, 6> patch{t[0], t[1], t[2], -1, -1, -1};
    for (std::size_t i = 0; i < 3; ++i) {
      if (bend.hinge[i] < 0) continue;
      const Hinge& hinge = topology.hinges[at(bend.hinge[i])];
      patch[3 + i] = hinge.triangle[0] == bend.triangle ? hinge.vertex[3] : hinge.vertex[2];
      const int row = slot_of[at(index[at(bend.hinge[i])])];
      for (std::size_t j = 0; j < 3; ++j)
        if (bend.hinge[j] >= 0)
          add_coupling(hinge_groups_[at(row) / k_lanes], at(row) % k_lanes, slot_of[at(index[at(bend.hinge[j])])],
                       bend.sign[i] * bend.sign[j] * bend.stiffness(static_cast<int>(i), static_cast<int>(j)));
    }
    patches_.push_back(patch);
  }
  for (std::size_t s = 0; s < phi_.size(); ++s)  // unused couplings look at themselves, with no weight
    for (auto& row : hinge_groups_[s / k_lanes].neighbour)
      if (row[s % k_lanes] < 0) row[s % k_lanes] = static_cast<int>(s);

  patch_schedule_ = make_element_schedule(patches_, topology.rest);
  patch_groups_.assign(patch_schedule_.group_count(), PatchGroup{});
  for (std::size_t s = 0; s < patch_schedule_.slot.size(); ++s) {
    PatchGroup& g = patch_groups_[s / k_lanes];
    const std::size_t l = s % k_lanes;
    g.floor_own[l] = g.floor_beyond[0][l] = g.floor_beyond[1][l] = g.floor_beyond[2][l] = 1;
    if (patch_schedule_.slot[s] < 0) continue;
    const std::size_t i = at(patch_schedule_.slot[s]);
    const BendElement& bend = topology.bends[i];
    for (std::size_t k = 0; k < 6; ++k) g.vertex[k][l] = patches_[i][k] >= 0 ? patches_[i][k] : patches_[i][0];
    const Mat3 root = square_root(bend.stiffness);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) g.root[a][b][l] = bend.hinge[at(a)] >= 0 ? root(a, b) : 0;
    g.damping_time[l] = topology.fabric_of_triangle(at(bend.triangle)).damping;
    g.floor_own[l] = degenerate_below(topology.rest_area[at(bend.triangle)]);
    for (std::size_t k = 0; k < 3; ++k)
      if (bend.hinge[k] >= 0) {
        const auto& two = topology.hinges[at(bend.hinge[k])].triangle;
        g.floor_beyond[k][l] = degenerate_below(topology.rest_area[at(two[0] == bend.triangle ? two[1] : two[0])]);
      }
  }
}

std::vector<std::array<int, 4>> Bending::stencils() const {
  std::vector<std::array<int, 4>> out;
  for (const auto& p : patches_) {
    for (std::size_t k = 3; k < 6; ++k)
      if (p[k] >= 0) out.push_back({p[0], p[1], p[2], p[k]});
    out.push_back({p[3], p[4], p[5], -1});
  }
  return out;
}

void Bending::begin_step(const StepContext& context) {
  CHECK(context.h > 0 && context.beta_h > 0);
  inverse_rate_time_ = context.x_t0.empty() ? 0 : 1 / context.rate_time();
  if (inverse_rate_time_ == 0) return;
  const bool history = context.has_history() && context.b != 0;
  parallel_for(hinge_groups_.size(), k_chunk_groups, [&](std::size_t begin, std::size_t end) {
    HingeEdges h;
    alignas(32) HingeLane now, before;
    for (std::size_t i = begin; i < end; ++i) {
      HingeGroup& g = hinge_groups_[i];
      edges(g.vertex, 0, 1, 2, 3, context.x_t0, h);
      hinge_angle_lanes(h.e, h.a, h.b, now);
      if (history) {
        edges(g.vertex, 0, 1, 2, 3, context.x_tm1, h);
        hinge_angle_lanes(h.e, h.a, h.b, before);
      }
      for (int l = 0; l < k_lanes; ++l)
        g.reference[l] = now[l] + (history ? context.b * angle_difference(now[l], before[l]) : 0.0);
    }
  });
}

/// Fills phi_ and rho_.
void Bending::measure(std::span<const Vec3> x) const {
  parallel_for(hinge_groups_.size(), k_chunk_groups, [&](std::size_t begin, std::size_t end) {
    HingeEdges h;
    alignas(32) HingeLane angle;
    for (std::size_t i = begin; i < end; ++i) {
      const HingeGroup& g = hinge_groups_[i];
      edges(g.vertex, 0, 1, 2, 3, x, h);
      hinge_angle_lanes(h.e, h.a, h.b, angle);
      double* phi = phi_.data() + i * k_lanes;
      double* rho = rho_.data() + i * k_lanes;
      for (int l = 0; l < k_lanes; ++l) {
        phi[l] = angle[l] - g.rest_angle[l];
        rho[l] = std::sqrt(g.damping_time[l] * inverse_rate_time_) * angle_difference(angle[l], g.reference[l]);
      }
    }
  });
}

double Bending::value(std::span<const Vec3> x) const {
  measure(x);
  return sum_over_chunks(hinge_schedule_, [&](std::size_t begin, std::size_t end) {
    double total = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const HingeGroup& g = hinge_groups_[i];
      for (std::size_t l = 0; l < k_lanes; ++l) {
        double elastic = 0, viscous = 0;
        for (int k = 0; k < k_couplings; ++k) {
          const std::size_t n = at(g.neighbour[k][l]);
          elastic += g.coupling[k][l] * phi_[n], viscous += g.coupling[k][l] * rho_[n];
        }
        total += 0.5 * (elastic * phi_[i * k_lanes + l] + viscous * rho_[i * k_lanes + l]);
      }
    }
    return total;
  });
}

void Bending::add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const {
  measure(x);
  for_each_chunk(hinge_schedule_, [&](std::size_t begin, std::size_t end) {
    HingeEdges h;
    HingeGradients d;
    alignas(32) HingeLane moment, g0[3], g1[3];
    for (std::size_t i = begin; i < end; ++i) {
      const HingeGroup& g = hinge_groups_[i];
      edges(g.vertex, 0, 1, 2, 3, x, h);
      hinge_gradient_lanes(h.e, h.a, h.b, g.floor2, g.floor3, d);
      for (std::size_t l = 0; l < k_lanes; ++l) {
        double elastic = 0, viscous = 0;
        for (int k = 0; k < k_couplings; ++k) {
          const std::size_t n = at(g.neighbour[k][l]);
          elastic += g.coupling[k][l] * phi_[n], viscous += g.coupling[k][l] * rho_[n];
        }
        moment[l] = elastic + std::sqrt(g.damping_time[l] * inverse_rate_time_) * viscous;
      }
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < k_lanes; ++l) {
          d.g2[k][l] *= moment[l], d.g3[k][l] *= moment[l];
          g1[k][l] = d.s2[l] * d.g2[k][l] + d.s3[l] * d.g3[k][l];
          g0[k][l] = d.g2[k][l] + d.g3[k][l] - g1[k][l];
        }
      for (int l = 0; l < k_lanes; ++l) {
        gradient[at(g.vertex[0][l])] -= Vec3(g0[0][l], g0[1][l], g0[2][l]);
        gradient[at(g.vertex[1][l])] -= Vec3(g1[0][l], g1[1][l], g1[2][l]);
        gradient[at(g.vertex[2][l])] += Vec3(d.g2[0][l], d.g2[1][l], d.g2[2][l]);
        gradient[at(g.vertex[3][l])] += Vec3(d.g3[0][l], d.g3[1][l], d.g3[2][l]);
      }
    }
  });
}

void Bending::add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const {
  positions_.bind(*hessian.pattern, patches_, patch_schedule_.slot);
  for_each_chunk(patch_schedule_, [&](std::size_t begin, std::size_t end) {
    HingeEdges h;
    HingeGradients d;
    // Rows of the factor: for each column k of root the vector sum_i root_ik grad theta_i, vertex by vertex.
    alignas(32) float rows[3][18][k_lanes];
    alignas(32) double sums[18][k_lanes], edge_gradient[3][12][k_lanes];
    alignas(32) float block[9][k_lanes];
    for (std::size_t i = begin; i < end; ++i) {
      const PatchGroup& g = patch_groups_[i];
      for (int edge = 0; edge < 3; ++edge) {
        edges(g.vertex, (edge + 1) % 3, (edge + 2) % 3, edge, 3 + edge, x, h);
        hinge_gradient_lanes(h.e, h.a, h.b, g.floor_own, g.floor_beyond[edge], d);
        auto& out = edge_gradient[edge];  // at the edge's start, its end, the corner, the vertex beyond
        for (int k = 0; k < 3; ++k)
          for (int l = 0; l < k_lanes; ++l) {
            const double end_part = -(d.s2[l] * d.g2[k][l] + d.s3[l] * d.g3[k][l]);
            out[k][l] = -(d.g2[k][l] + d.g3[k][l]) - end_part;
            out[3 + k][l] = end_part;
            out[6 + k][l] = d.g2[k][l];
            out[9 + k][l] = d.g3[k][l];
          }
      }
      for (int column = 0; column < 3; ++column) {
        for (auto& s : sums)
          for (int l = 0; l < k_lanes; ++l) s[l] = 0;
        for (int edge = 0; edge < 3; ++edge) {
          const int target[4] = {(edge + 1) % 3, (edge + 2) % 3, edge, 3 + edge};
          for (int v = 0; v < 4; ++v)
            for (int k = 0; k < 3; ++k)
              for (int l = 0; l < k_lanes; ++l)
                sums[3 * target[v] + k][l] += g.root[edge][column][l] * edge_gradient[edge][3 * v + k][l];
        }
        for (int k = 0; k < 18; ++k)
          for (int l = 0; l < k_lanes; ++l)
            rows[column][k][l] = static_cast<float>(std::sqrt(1 + g.damping_time[l] * inverse_rate_time_) * sums[k][l]);
      }
      const std::size_t first = i * k_lanes;
      std::size_t used = 0;
      while (used < k_lanes && patch_schedule_.slot[first + used] >= 0) ++used;
      for (int a = 0; a < 6; ++a)
        for (int b = a; b < 6; ++b) {
          for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r)
              for (int l = 0; l < k_lanes; ++l)
                block[3 * c + r][l] = rows[0][3 * a + r][l] * rows[0][3 * b + c][l] + rows[1][3 * a + r][l] * rows[1][3 * b + c][l] +
                                      rows[2][3 * a + r][l] * rows[2][3 * b + c][l];
          for (std::size_t l = 0; l < used; ++l) {
            const auto& p = positions_[first + l];
            if (p[at(6 * a + b)] < 0) continue;
            Mat3f m;
            for (int k = 0; k < 9; ++k) m.data()[k] = block[k][l];
            hessian.blocks[at(p[at(6 * a + b)])] += m;
            if (a != b) hessian.blocks[at(p[at(6 * b + a)])] += m.transpose();
          }
        }
    }
  });
}

}  // namespace ft
