#include "solvers/cloth/model/cloth_check.h"

#include <cmath>
#include <string>

namespace ft::inline solvers {
namespace {

Status check_maps(const ClothGarment& garment) {
  for (const NamedMap& map : k_vertex_maps) {
    const std::vector<double>& values = garment.maps.*map.values;
    const std::string owner = "cloth \"" + garment.name + "\": map of " + std::string(map.name);
    if (values.empty()) continue;
    if (values.size() != garment.mesh.positions.size())
      return input_error(owner + " has " + std::to_string(values.size()) + " values for " +
                         std::to_string(garment.mesh.positions.size()) + " vertices");
    // Cloth folds without resistance where it likes, but it has mass, thickness and a length.
    const bool may_vanish = map.values == &VertexMaps::bend;
    for (std::size_t v = 0; v < values.size(); ++v)
      if (!std::isfinite(values[v]) || values[v] < 0 || (values[v] == 0 && !may_vanish))
        return input_error(owner + ": " + std::to_string(values[v]) + " at vertex " + std::to_string(v) + " is not " +
                           (may_vanish ? "0 or above" : "above 0"));
  }
  return {};
}

}  // namespace

Status check(const ClothSetup& setup) {
  if (setup.garments.empty()) return input_error("a cloth system needs at least one garment");
  for (const ClothGarment& g : setup.garments) {
    if (g.mesh.positions.empty() || g.mesh.face_sizes.empty())
      return input_error("cloth \"" + g.name + "\" has no faces");
    if (!all_finite(g.mesh.positions)) return input_error("cloth \"" + g.name + "\" has a vertex that is not a number");
    for (const Stitch& s : g.mesh.stitches)
      for (const int v : {s.vertex, s.edge[0], s.edge[1]})
        if (v < 0 || v >= g.mesh.vertex_count() || s.vertex == s.edge[0] || s.vertex == s.edge[1] ||
            !(s.place >= 0 && s.place <= 1))
          return input_error("cloth \"" + g.name + "\": a stitch of vertex " + std::to_string(s.vertex) +
                             " cannot be sewn");
    if (const Status maps = check_maps(g); !maps) return maps;
    for (const ClothPin& pin : g.pins) {
      for (const int v : pin.vertices)
        if (v < 0 || v >= g.mesh.vertex_count())
          return input_error("cloth \"" + g.name + "\": pin names vertex " + std::to_string(v) + " of " +
                             std::to_string(g.mesh.vertex_count()));
      if (!pin.weights.empty() && pin.weights.size() != pin.vertices.size())
        return input_error("cloth \"" + g.name + "\": a pin needs one weight per vertex");
      if (pin.to >= static_cast<int>(setup.garments.size()))
        return input_error("cloth \"" + g.name + "\": a pin holds to garment " + std::to_string(pin.to) + " of " +
                           std::to_string(setup.garments.size()));
    }
  }
  if (!(setup.fps > 0) || setup.min_substeps < 1 || setup.max_substeps < setup.min_substeps ||
      setup.newton_iterations < 1 || !(setup.coarsen >= 1 && setup.coarsen <= 4) || !(setup.travel > 0))
    return input_error("cloth settings are out of range");
  return {};
}

}  // namespace ft::inline solvers
