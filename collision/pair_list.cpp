#include "collision/pair_list.h"

#include "baker/core/parallel.h"

namespace ft {
namespace {

constexpr std::size_t k_block = 4096;

}  // namespace

ContactPairs stencils_of(const PairList& list) {
  ContactPairs out;
  const auto write = [&](PairKind kind, std::vector<Stencil>& pairs) {
    pairs.resize(list.of(kind).size());
    parallel_for(pairs.size(), k_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) pairs[i] = list.stencil(kind, i);
    });
  };
  write(PairKind::k_vertex_face, out.vertex_face);
  write(PairKind::k_edge_edge, out.edge_edge);
  return out;
}

}  // namespace ft
