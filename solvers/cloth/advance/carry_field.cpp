#include "solvers/cloth/advance/carry_field.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "baker/core/give_back.h"
#include "baker/core/parallel.h"
#include "collision/geometry/pair_geometry.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_block = 2048;    ///< pairs
constexpr std::size_t k_vertices = 256;  ///< or pulls, per block of a loop

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
  const std::vector<PairKey>& pairs = in.pairs->vertex_face;
  std::vector<std::vector<Pull>> blocks(block_count(pairs.size(), k_block));
  parallel_for(pairs.size(), k_block, [&](std::size_t begin, std::size_t end) {
    std::vector<Pull>& mine = blocks[begin / k_block];
    std::size_t run = 0;  // pulls of the vertex at hand begin here
    for (std::size_t k = begin; k < end; ++k) {
      const auto v = in.pairs->stencil(PairKind::k_vertex_face, k).v;
      if (k > begin && v[0] != key_first(pairs[k - 1])) run = mine.size();
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
  std::size_t count = 0;
  for (const auto& block : blocks) count += block.size();
  std::vector<Pull> pulls;
  pulls.reserve(count);
  for (auto& block : blocks) {
    pulls.insert(pulls.end(), block.begin(), block.end());
    give_back(block);  // so that there are hardly ever two of them
  }
  return pulls;
}

/// Which pulls have hold of each cloth vertex, in their order.
struct Holds {
  struct Hold {
    int pull, corner;
  };
  std::vector<int> start;
  std::vector<Hold> items;
  std::vector<int> held;  ///< vertices with any, ascending

  Holds(std::span<const Pull> pulls, int vertex_count) : start(at(vertex_count) + 1, 0) {
    const auto each = [&](auto&& visit) {
      for (int p = 0; p < static_cast<int>(pulls.size()); ++p)
        for (int k = 0; k < 4; ++k)
          if (const int v = pulls[at(p)].vertex[at(k)]; v < vertex_count) visit(v, Hold{p, k});
    };
    each([&](int v, const Hold&) { ++start[at(v) + 1]; });
    for (std::size_t i = 1; i < start.size(); ++i) {
      if (start[i] > 0) held.push_back(static_cast<int>(i - 1));
      start[i] += start[i - 1];
    }
    items.resize(at(start.back()));
    std::vector<int> next(start.begin(), start.end() - 1);
    each([&](int v, const Hold& hold) { items[at(next[at(v)]++)] = hold; });
  }
  std::span<const Hold> of(std::size_t v) const { return {items.data() + start[v], items.data() + start[v + 1]}; }
};

/// Diagonal of the block of a vertex that nothing has hold of.
double free_diagonal(const CarryInput& in, std::size_t vertex, double g) {
  return g * (1 + 8 * static_cast<double>(in.neighbours->row(static_cast<int>(vertex)).size()));
}

/// Inverses of the diagonal blocks of vertices that something has hold of. l1-Jacobi: they carry the absolute row sum,
/// so that shared contacts cannot make the sweeps diverge.
std::vector<Mat3> inverse_blocks(const CarryInput& in, std::span<const Pull> pulls, const Holds& holds, double g) {
  const auto row_sum = [&](const Pull& p) {
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k)
      if (p.vertex[k] < in.cloth_vertex_count) sum += std::abs(p.weight[k]);
    return sum;
  };
  std::vector<Mat3> out(holds.held.size());
  parallel_for(out.size(), k_vertices, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t i = at(holds.held[k]);
      Mat3 block = Mat3::Identity() * free_diagonal(in, i, g);
      for (const Holds::Hold& hold : holds.of(i)) {
        const Pull& p = pulls[at(hold.pull)];
        block += (p.strength * std::abs(p.weight[at(hold.corner)]) * row_sum(p)) * p.normal * p.normal.transpose();
      }
      out[k] = block.inverse();
    }
  });
  return out;
}

}  // namespace

void carry_field(const CarryInput& in, std::span<Vec3> carry) {
  const int n = in.cloth_vertex_count;
  const double g = 1.0 / (in.range * in.range);
  const std::vector<Pull> pulls = find_pulls(in);
  const Holds holds(pulls, n);
  const std::vector<Mat3> inverse = inverse_blocks(in, pulls, holds, g);
  std::vector<double> missing(pulls.size());
  std::vector<Vec3> other(at(n));
  std::span<Vec3> now = carry.first(at(n)), next = other;
  std::copy_n(in.inertia.begin(), at(n), now.begin());
  for (int sweep = 0; sweep < in.sweeps; ++sweep) {
    parallel_for(pulls.size(), k_vertices, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Pull& p = pulls[i];
        double here = 0;
        for (std::size_t k = 0; k < 4; ++k)
          if (p.vertex[k] < n) here += p.weight[k] * p.normal.dot(now[at(p.vertex[k])]);
        missing[i] = p.strength * (p.target - here);
      }
    });
    parallel_for(next.size(), k_vertices, [&](std::size_t begin, std::size_t end) {
      const auto first = std::lower_bound(holds.held.begin(), holds.held.end(), static_cast<int>(begin));
      auto block = inverse.begin() + (first - holds.held.begin());
      for (std::size_t i = begin; i < end; ++i) {
        Vec3 residual = g * (in.inertia[i] - now[i]);
        for (const int j : in.neighbours->row(static_cast<int>(i))) residual -= (4 * g) * (now[i] - now[at(j)]);
        for (const Holds::Hold& hold : holds.of(i)) {
          const Pull& p = pulls[at(hold.pull)];
          residual += (missing[at(hold.pull)] * p.weight[at(hold.corner)]) * p.normal;
        }
        if (holds.of(i).empty())
          next[i] = now[i] + (1 / free_diagonal(in, i, g)) * residual;
        else
          next[i] = now[i] + *block++ * residual;
      }
    });
    std::swap(now, next);
  }
  if (in.smooth != nullptr) in.smooth->smooth(now);
  if (in.clusters != nullptr) in.clusters->take_mean(now);
  double fastest = 0;
  for (const Pull& p : pulls) fastest = std::max(fastest, p.body_motion);
  for (int i = 0; i < n; ++i) fastest = std::max(fastest, in.inertia[at(i)].norm());
  const double cap = 1.2 * fastest;
  for (int i = 0; i < n; ++i) {
    const double length = now[at(i)].norm();
    carry[at(i)] = length > cap ? Vec3(now[at(i)] * (cap / length)) : now[at(i)];
  }
}

}  // namespace ft::inline solvers
