// Maps of the shot file -> one number per vertex of the garment's mesh, as the solver takes them. Sources are the
// weights of vertex groups (vertex colours among them) and files of numbers; both are in the order of the garment's
// file, before anything is welded.
#pragma once

#include <span>

#include "baker/core/mesh.h"
#include "baker/core/result.h"
#include "baker/systems/cloth/cloth_spec.h"
#include "solvers/energies/cloth_topology.h"

namespace ft::inline baker {

/// `mesh` as it was read. Names vertex and file in messages; never a value outside of the map's range (cloth_maps.h).
Result<VertexMaps> resolve_maps(std::span<const MapSpec> maps, const Mesh& mesh);

/// Values on vertices of the file -> on joined ones, which take the mean.
VertexMaps on_joined(const VertexMaps& maps, std::span<const int> joined_of, int joined_count);

}  // namespace ft::inline baker
