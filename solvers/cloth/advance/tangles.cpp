#include "solvers/cloth/advance/tangles.h"

#include <algorithm>

#include "solvers/cloth/solve/untangle.h"

namespace ft::inline solvers {
namespace {

/// Edges around a crossing that a contour moves by, about, while one substep lasts.
constexpr int k_rings = 2;

}  // namespace

std::vector<Crossing> own_crossings(const ClothModel& model, std::vector<Crossing> within) {
  std::erase_if(within, [&](const Crossing& c) {
    return !model.self_collides[at(c.edge[0])] || !model.self_collides[at(c.triangle[0])] || model.sewn.together(c);
  });
  return within;
}

void mark_tangled(const ClothModel& model, std::span<const Crossing> crossings, std::vector<char>& tangled) {
  tangled.assign(at(model.vertex_count()), 0);
  for (const Crossing& c : crossings) {
    for (const int v : c.edge) tangled[at(v)] = 1;
    for (const int v : c.triangle) tangled[at(v)] = 1;
  }
  for (int ring = 0; ring < k_rings && !crossings.empty(); ++ring) {
    const std::vector<char> before = tangled;
    for (const Edge& e : model.rest_edges.edges)
      if (before[at(e[0])] != 0 || before[at(e[1])] != 0) tangled[at(e[0])] = tangled[at(e[1])] = 1;
  }
}

std::vector<Crossing> Tangles::crossings_of(std::span<const Vec3> x) {
  if (!cloth_) cloth_.emplace(model_.triangles);
  cloth_->move(x);
  std::vector<Crossing> out = own_crossings(model_, crossings_within(*cloth_));
  cloth_->forget_boxes();
  return out;
}

bool Tangles::no_worse(std::span<const Vec3> x) {
  return !finder_.grows(crossings_of(x));
}

ContactPairs Tangles::close_growing(std::span<const Vec3> x) {
  if (way_out_.empty()) return {};
  return finder_.close_growing(crossings_of(x), way_out_);
}

void Tangles::look(double h, ClothMotion& cloth) {
  if (!any_tangled(cloth.tangled)) {
    way_out_ = {};
    return;
  }
  const std::vector<Crossing> crossings = crossings_of(cloth.x);
  mark_tangled(model_, crossings, cloth.tangled);
  finder_.find(cloth.x, crossings, h, way_out_);
  push_.clear();
  if (way_out_.unexplained.empty()) return;
  push_.resize(cloth.x.size());
  untangling(cloth.x, model_.triangles, way_out_.unexplained, push_);
}

std::span<const Vec3> Tangles::push(std::span<const Vec3> given) {
  if (way_out_.unexplained.empty()) return given;
  for (std::size_t i = 0; i < given.size(); ++i) push_[i] += given[i];
  return push_;
}

bool any_tangled(std::span<const char> tangled) {
  return std::any_of(tangled.begin(), tangled.end(), [](char t) { return t != 0; });
}

bool among_tangled(const Crossing& crossing, std::span<const char> tangled) {
  const auto is = [&](int v) { return tangled[at(v)] != 0; };
  return std::all_of(crossing.edge.begin(), crossing.edge.end(), is) &&
         std::all_of(crossing.triangle.begin(), crossing.triangle.end(), is);
}

}  // namespace ft::inline solvers
