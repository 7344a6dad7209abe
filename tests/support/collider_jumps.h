// Where the feasible collider jumps: a vertex that moves against its drawn place, from one pose to the next, by more
// than so much. The solver moves the collider straight from pose to pose: a jump sweeps through the cloth. Header only:
// who includes it links ft_collision.
#pragma once

#include <algorithm>
#include <vector>

#include "baker/core/parallel.h"
#include "baker/core/trajectory.h"
#include "collision/body/feasible_collider.h"

namespace ft::test {

struct ColliderJump {
  double time = 0;               ///< s, of the later pose
  int vertex = 0;                ///< of the collider
  int part = 0;                  ///< that it is of
  double length = 0;             ///< m
  double before = 0, after = 0;  ///< how far from its drawn place [m]
};

/// Poses at from, from + 1 / rate, .. below until [s]; jumps of more than `least` [m], in order of time.
inline std::vector<ColliderJump> collider_jumps(const Trajectory& body, const FeasibleSettings& settings, double from,
                                                double until, double rate, double least) {
  constexpr int k_batch = 64;
  std::vector<Vec3> bind(at(body.surface().vertex_count()));
  body.bind_pose(bind);
  const FeasibleCollider collider(body.surface(), bind, settings);
  const std::size_t vertices = at(collider.vertex_count());
  const int count = static_cast<int>((until - from) * rate);
  std::vector<ColliderJump> out;
  std::vector<Vec3> last;  // from the drawn places
  for (int first = 0; first < count; first += k_batch) {
    std::vector<std::vector<Vec3>> moves(at(std::min(k_batch, count - first)));
    const auto time = [&](std::size_t k) { return from + (first + static_cast<int>(k)) / rate; };
    parallel_tasks(moves.size(), [&](std::size_t k) {
      std::vector<Vec3> drawn(bind.size()), refined(vertices);
      body.sample(time(k), drawn);
      collider.refine(drawn, refined);
      moves[k].resize(vertices);
      collider.evaluate(drawn, moves[k]);
      for (std::size_t v = 0; v < vertices; ++v) moves[k][v] -= refined[v];
    });
    for (std::size_t k = 0; k < moves.size(); ++k) {
      for (std::size_t v = 0; v < last.size(); ++v)
        if (const double length = (moves[k][v] - last[v]).norm(); length > least)
          out.push_back(
              {time(k), static_cast<int>(v), collider.part_of_vertex()[v], length, last[v].norm(), moves[k][v].norm()});
      last = std::move(moves[k]);
    }
  }
  return out;
}

}  // namespace ft::test
