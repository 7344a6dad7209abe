#include "solvers/lockstep/scenery.h"

namespace ft::inline solvers {

Scenery::Scenery(std::span<const MetBody> bodies) : bodies_(bodies) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Surface& surface = bodies_[b].trajectory->surface();
    const int first = vertex_count();
    first_vertex_.push_back(first);
    body_of_vertex_.resize(body_of_vertex_.size() + at(surface.vertex_count()), static_cast<int>(b));
    for (const Triangle& t : surface.triangles) triangles_.push_back({first + t[0], first + t[1], first + t[2]});
    any_moves_ = any_moves_ || !bodies_[b].fixed;
  }
  first_vertex_.push_back(vertex_count());
}

void Scenery::sample(std::size_t body, double time, std::vector<Vec3>& out) const {
  out.resize(at(first_vertex_[body + 1] - first_vertex_[body]));
  bodies_[body].trajectory->sample(time, out);
}

void Scenery::sample_all(double time, std::vector<Vec3>& out) const {
  const bool first = out.empty();
  out.resize(at(vertex_count()));
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (bodies_[b].fixed && !first) continue;
    const auto begin = at(first_vertex_[b]);
    bodies_[b].trajectory->sample(time, std::span(out).subspan(begin, at(first_vertex_[b + 1]) - begin));
  }
}

void Scenery::begin_step(double t0, double t1) {
  if (empty()) return;
  if (end_.empty() || end_time_ != t0) {
    if (start_.empty() || start_time_ != t0) sample_all(t0, start_);
  } else {
    start_.swap(end_);
  }
  sample_all(t1, end_);
  start_time_ = t0, end_time_ = t1;
}

}  // namespace ft::inline solvers
