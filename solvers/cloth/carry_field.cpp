#include "solvers/cloth/carry_field.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "baker/core/parallel.h"
#include "collision/pair_geometry.h"

namespace ft {
namespace {

constexpr std::size_t k_block = 4096;

struct Pull {
  std::array<int, 4> vertex;
  std::array<double, 4> weight;
  Vec3 normal;
  double strength;
  double target;       ///< n . u_body at the contact
  double body_motion;  ///< |u_body| there [m]
  int part;
};

/// Of each vertex with each part the nearest face only: the faces of one surface say the same thing many times over.
std::vector<Pull> find_pulls(const CarryInput& in) {
  const int n = in.cloth_vertex_count;
  const double g = 1.0 / (in.range * in.range);
  const auto& pairs = in.pairs->vertex_face;
  std::vector<std::vector<Pull>> blocks(block_count(pairs.size(), k_block));
  parallel_for(pairs.size(), k_block, [&](std::size_t begin, std::size_t end) {
    std::vector<Pull>& mine = blocks[begin / k_block];
    std::size_t run = 0;  // pulls of the vertex at hand begin here
    for (std::size_t k = begin; k < end; ++k) {
      const auto& v = pairs[k].v;
      if (k > begin && v[0] != pairs[k - 1].v[0]) run = mine.size();
      const PairGeometry geo = vertex_face_geometry(in.x[at(v[0])], in.x[at(v[1])], in.x[at(v[2])], in.x[at(v[3])]);
      if (geo.distance >= in.range || geo.distance <= 0) continue;
      // A body vertex beside a cloth face, not behind it, says nothing: its slanted normal would lift cloth that glides
      // past.
      if (v[0] >= n && std::max({geo.weight[1], geo.weight[2], geo.weight[3]}) > -1e-3) continue;
      const double d = std::max(geo.distance, 1e-5);
      Pull pull{v, geo.weight, geo.normal, 1.0 / (d * d) - g, 0, 0, 0};
      Vec3 body = Vec3::Zero();
      for (std::size_t c = 0; c < 4; ++c)
        if (v[c] >= n) {
          body += geo.weight[c] * in.body_motion[at(v[c] - n)];
          pull.part = in.part_of_body_vertex[at(v[c] - n)];
        }
      // sum weight * displacement over all four vertices is the relative motion: the cloth's part shall cancel the
      // body's.
      pull.target = -geo.normal.dot(body);
      pull.body_motion = body.norm();
      const auto same = std::find_if(mine.begin() + static_cast<std::ptrdiff_t>(run), mine.end(),
                                     [&](const Pull& p) { return p.part == pull.part; });
      if (same == mine.end())
        mine.push_back(pull);
      else if (pull.strength > same->strength)
        *same = pull;
    }
  });
  std::vector<Pull> pulls;
  for (const auto& block : blocks) pulls.insert(pulls.end(), block.begin(), block.end());
  return pulls;
}

}  // namespace

void carry_field(const CarryInput& in, std::span<Vec3> carry) {
  const int n = in.cloth_vertex_count;
  const double g = 1.0 / (in.range * in.range);
  const std::vector<Pull> pulls = find_pulls(in);
  double fastest = 0;
  for (const Pull& p : pulls) fastest = std::max(fastest, p.body_motion);
  double fastest_own = 0;
  for (int i = 0; i < n; ++i) fastest_own = std::max(fastest_own, in.inertia[at(i)].norm());

  std::vector<Mat3> block(at(n), Mat3::Identity() * g);
  for (const Edge& e : in.edges) {
    block[at(e[0])] += Mat3::Identity() * (8 * g);
    block[at(e[1])] += Mat3::Identity() * (8 * g);
  }
  // l1-Jacobi: the diagonal carries the absolute row sum, so that shared contacts cannot make the sweeps diverge.
  for (const Pull& p : pulls) {
    double row = 0;
    for (std::size_t k = 0; k < 4; ++k)
      if (p.vertex[k] < n) row += std::abs(p.weight[k]);
    for (std::size_t k = 0; k < 4; ++k)
      if (p.vertex[k] < n)
        block[at(p.vertex[k])] += (p.strength * std::abs(p.weight[k]) * row) * p.normal * p.normal.transpose();
  }
  for (Mat3& b : block) b = b.inverse().eval();

  for (int i = 0; i < n; ++i) carry[at(i)] = in.inertia[at(i)];
  std::vector<Vec3> residual(at(n));
  for (int sweep = 0; sweep < in.sweeps; ++sweep) {
    for (int i = 0; i < n; ++i) residual[at(i)] = g * (in.inertia[at(i)] - carry[at(i)]);
    for (const Edge& e : in.edges) {
      const Vec3 d = (4 * g) * (carry[at(e[0])] - carry[at(e[1])]);
      residual[at(e[0])] -= d;
      residual[at(e[1])] += d;
    }
    for (const Pull& p : pulls) {
      double here = 0;
      for (std::size_t k = 0; k < 4; ++k)
        if (p.vertex[k] < n) here += p.weight[k] * p.normal.dot(carry[at(p.vertex[k])]);
      const double missing = p.strength * (p.target - here);
      for (std::size_t k = 0; k < 4; ++k)
        if (p.vertex[k] < n) residual[at(p.vertex[k])] += (missing * p.weight[k]) * p.normal;
    }
    for (int i = 0; i < n; ++i) carry[at(i)] += block[at(i)] * residual[at(i)];
  }
  const double cap = 1.2 * std::max(fastest, fastest_own);
  for (int i = 0; i < n; ++i) {
    const double length = carry[at(i)].norm();
    if (length > cap) carry[at(i)] *= cap / length;
  }
}

}  // namespace ft
