#include "solvers/hair/ridden_mesh.h"

#include <algorithm>
#include <cmath>

#include "baker/core/parallel.h"

namespace ft::inline solvers {

RiddenMesh::RiddenMesh(const Mesh& mesh, std::span<const MeshRider> riders, int vertices, const GuidesNow& groom,
                       std::span<const RootFrame> roots)
    : n_(at(vertices)), places_(mesh.positions.size()) {
  const std::vector<Mat3> frames = frames_of(groom, n_);
  parallel_for(places_.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      Place& place = places_[v];
      const Vec3& p = mesh.positions[v];
      if (riders[v].strand < 0) {
        const auto nearest = std::ranges::min_element(
            roots, [&](const auto& a, const auto& b) { return (a.place - p).norm() < (b.place - p).norm(); });
        place.strand = static_cast<std::size_t>(nearest - roots.begin());
        place.off[0] = nearest->turn.transpose() * (p - nearest->place);
        continue;
      }
      place.strand = at(riders[v].strand);
      const double where = std::clamp(riders[v].along, 0.0, 1.0) * static_cast<double>(n_ - 1);
      place.vertex = std::min(static_cast<std::size_t>(where), n_ - 2);
      place.along = where - static_cast<double>(place.vertex);
      for (std::size_t k = 0; k < 2; ++k) {
        const std::size_t own = place.strand * n_ + place.vertex + k;
        place.off[k] = frames[own].transpose() * (p - groom.x[own]);
      }
    }
  });
}

void RiddenMesh::place(const GuidesNow& guides, std::span<const RootFrame> roots, std::span<Vec3> positions) const {
  const std::vector<Mat3> frames = frames_of(guides, n_);
  parallel_for(places_.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Place& place = places_[v];
      if (place.along < 0) {
        positions[v] = roots[place.strand].place + roots[place.strand].turn * place.off[0];
        continue;
      }
      const std::size_t own = place.strand * n_ + place.vertex;
      positions[v] = (1 - place.along) * (guides.x[own] + frames[own] * place.off[0]) +
                     place.along * (guides.x[own + 1] + frames[own + 1] * place.off[1]);
    }
  });
}

}  // namespace ft::inline solvers
