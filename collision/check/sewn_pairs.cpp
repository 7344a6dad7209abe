#include "collision/check/sewn_pairs.h"

#include <algorithm>
#include <iterator>

namespace ft::inline collision {
namespace {

Adjacency rows_of(std::vector<Edge>& directed, int vertex_count) {
  std::sort(directed.begin(), directed.end());
  directed.erase(std::unique(directed.begin(), directed.end()), directed.end());
  Adjacency out;
  out.start.assign(at(vertex_count) + 1, 0);
  for (const Edge& e : directed) {
    ++out.start[at(e[0]) + 1];
    out.items.push_back(e[1]);
  }
  for (std::size_t i = 1; i < out.start.size(); ++i) out.start[i] += out.start[i - 1];
  return out;
}

}  // namespace

SewnPairs::SewnPairs(int vertex_count, std::span<const Stitch> stitches, std::span<const Triangle> triangles) {
  if (stitches.empty()) return;
  std::vector<Edge> direct, along;
  std::vector<char> sewn(at(vertex_count), 0);
  for (const Stitch& s : stitches)
    for (const int e : s.edge) {
      direct.push_back({s.vertex, e});
      direct.push_back({e, s.vertex});
      sewn[at(e)] = sewn[at(s.vertex)] = 1;
    }
  for (const Edge& e : unique_edges(triangles))
    if (sewn[at(e[0])] && sewn[at(e[1])]) along.push_back(e), along.push_back({e[1], e[0]});
  const Adjacency links = rows_of(direct, vertex_count), steps = rows_of(along, vertex_count);
  // What is near in one panel anyway stays as it is: those pairs meet as in any cloth.
  const auto neighbours = [&](int a, int c) {
    if (a == c) return true;
    const auto row = steps.row(a), other = steps.row(c);
    std::vector<int> common;
    std::set_intersection(row.begin(), row.end(), other.begin(), other.end(), std::back_inserter(common));
    return !common.empty() || std::binary_search(row.begin(), row.end(), c);
  };
  std::vector<Edge> near = direct;
  for (int a = 0; a < vertex_count; ++a)
    for (const int b : links.row(a))
      for (const auto& far : {links.row(b), steps.row(b)})
        for (const int c : far)
          if (!neighbours(a, c)) near.push_back({a, c}), near.push_back({c, a});
  near_ = rows_of(near, vertex_count);
}

bool SewnPairs::together(std::span<const int> a, std::span<const int> b) const {
  if (empty()) return false;
  for (const int i : a) {
    if (i >= near_.row_count()) continue;
    const auto row = near_.row(i);
    if (row.empty()) continue;
    for (const int j : b)
      if (std::binary_search(row.begin(), row.end(), j)) return true;
  }
  return false;
}

}  // namespace ft::inline collision
