// The torture scenes as functions; scenes.cpp lists them.
#pragma once

#include "solvers/cloth/cloth_solver.h"

namespace ft::torture {

// pull_scenes.cpp: cloth that is twisted, pulled through openings, knotted, drawn over an edge.
ClothSetup twist();
ClothSetup ring();
ClothSetup funnel();
ClothSetup knot();
ClothSetup taut();

// press_scenes.cpp: cloth between things that close.
ClothSetup plates();
ClothSetup plates_no_room();
ClothSetup elbow();
ClothSetup legs();

// hit_scenes.cpp: cloth that is hit, falls, lies on points, or is badly meshed.
ClothSetup ball_5();
ClothSetup ball_10();
ClothSetup ball_20();
ClothSetup ball_40();
ClothSetup stack();
ClothSetup needles();
/// A tenth of the triangles of a sheet on a swinging ball has edges so many times shorter than the others.
ClothSetup dense_spots(double ratio);
ClothSetup tiny_triangles();
ClothSetup cut_edges();
/// The same sheet, in which some triangles have a vertex at that height [m] above the middle of their longest edge.
ClothSetup caps_of(double height);
ClothSetup caps();
ClothSetup tiny_edges();

}  // namespace ft::torture
