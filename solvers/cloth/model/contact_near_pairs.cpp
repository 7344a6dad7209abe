// Which pairs of contact are so near each other that a step may have to be truncated by them.
#include <algorithm>
#include <limits>

#include "baker/core/check.h"
#include "baker/core/give_back.h"
#include "baker/core/parallel.h"
#include "solvers/cloth/model/contact_potential.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_block = 512;
/// Truncation cannot cut a pair that is farther apart than this many times its longest displacement.
constexpr double k_truncation_reach = 2.3;

}  // namespace

void ContactPotential::near_pairs(std::span<const double> lengths, double floor, PairPlaces& out) {
  const int n = model_.cloth_vertex_count;
  reach_.resize(at(n));
  parallel_for(reach_.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      reach_[i] = static_cast<float>(k_truncation_reach * lengths[i] + floor) + 1e-6f;
  });
  out.list = pairs_;
  std::vector<char> near;  // per pair
  const auto take = [&](PairKind kind, const std::vector<std::uint16_t>& known, std::vector<std::uint32_t>& to) {
    CHECK(known.size() <= std::numeric_limits<std::uint32_t>::max());
    near.assign(known.size(), 0);
    std::vector<std::size_t> place(block_count(known.size(), k_block) + 1, 0);
    parallel_for(known.size(), k_block, [&](std::size_t begin, std::size_t end) {
      std::size_t count = 0;
      for (std::size_t p = begin; p < end; ++p) {
        float reach = 0;
        const auto v = pairs_->stencil(kind, p).v;
        for (const int i : v)
          if (i < n) reach = std::max(reach, reach_[at(i)]);
        near[p] = may_be_within(v, kind == PairKind::k_vertex_face, known[p], reach) ? 1 : 0;
        count += near[p] != 0 ? 1 : 0;
      }
      place[begin / k_block + 1] = count;
    });
    for (std::size_t b = 1; b < place.size(); ++b) place[b] += place[b - 1];
    if (place.back() > to.capacity()) give_back(to);  // so that there are never two of them
    to.resize(place.back());
    parallel_for(known.size(), k_block, [&](std::size_t begin, std::size_t end) {
      std::size_t next = place[begin / k_block];
      for (std::size_t p = begin; p < end; ++p)
        if (near[p] != 0) to[next++] = static_cast<std::uint32_t>(p);
    });
  };
  take(PairKind::k_vertex_face, known_vf_, out.vertex_face);
  take(PairKind::k_edge_edge, known_ee_, out.edge_edge);
}

}  // namespace ft::inline solvers
