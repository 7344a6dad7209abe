// The cloth solver for garments with edges so short that nobody sees their ends part: what moves is the garment without
// them (without_short_edges()), and the vertices that are missing there ride on it. Unlike in a preview the certificate
// is that of all vertices. What rides lies on a triangle of what moves, or microns off it; where edges fold sharply, or
// something is nearer than that, it might cross: then what was drawn into that vertex is drawn in around it, and turns
// with it as one, until it is clear.
#pragma once

#include <memory>

#include "solvers/cloth/model/cloth_setup.h"

namespace ft::inline solvers {

/// Null when no garment has such edges. Systems, incidents, crossings and strains are those of the given garments, gaps
/// and depths those of what moves. With setup.coarsen above 1 it is a preview of that, and crossings and strains, too,
/// are those of what moves. make_inner makes the solver of what moves.
Result<std::unique_ptr<Solver>> make_riding_solver(const ClothSetup& setup, const ClothSolverMaker& make_inner);

}  // namespace ft::inline solvers
