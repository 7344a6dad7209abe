// Horizontal slices of a body in its bind pose, and the landmarks that a tailor needs: waist, crotch, neck, width of
// the chest. For make_garments. Works on any closed or nearly closed surface (several overlapping shells too): a cell
// of a slice is inside when the winding number of its row is not zero, or of open shells the generalized one says so.
// The torso is followed from the waist slice by slice, so that hands that hang beside the hips are not taken for hips.
// Caution: a body whose arms lie on the torso reads as one wide torso.
#pragma once

#include <span>
#include <vector>

#include "baker/core/result.h"
#include "baker/core/types.h"

namespace ft::garments {

struct Body {
  std::vector<Vec3> positions;  ///< m, Y-up
  std::vector<Triangle> triangles;
};

/// What is inside of one horizontal slice and belongs to torso or legs.
struct Slice {
  double height = 0;          ///< m
  std::vector<Vec2> outline;  ///< convex hull of it in (x, z), counter-clockwise; empty where nothing is
  double area = 0;            ///< m2, of the inside, not of the hull
  Vec2 centre = Vec2::Zero();
  int component_count = 0;   ///< 1 torso, 2 legs
  double width_x = 0;        ///< m
  std::vector<Vec2> beside;  ///< what is inside and belongs to neither, hands beside the hips: cells of 5 mm [m]
};

struct BodyShape {
  Box bounds;
  double figure_height = 0;   ///< m, of somebody with such a body and a head of usual size
  double spacing = 0;         ///< m between slices
  std::vector<Slice> slices;  ///< from the feet up
  double waist = 0;           ///< heights [m]
  double crotch = 0;
  double neck = 0;       ///< narrowest
  double neck_base = 0;  ///< where the shoulders begin
  Vec2 waist_centre = Vec2::Zero();
  double chest_half_width = 0;  ///< m, between waist and shoulders

  const Slice& slice_at(double height) const;
};

/// Turns about the vertical so that the arms lie along x; identity where the body shows no direction.
Eigen::Isometry3d arms_along_x(const Body& body);

/// waist: height in shares of the body's height, 0: the narrowest slice between 0.55 and 0.68 of the figure's.
Result<BodyShape> measure_body(const Body& body, double waist);

std::vector<Vec2> convex_hull(std::vector<Vec2> points);
/// From an inner point in a direction to the hull's border [m]; 0 when the point is outside.
double hull_distance(std::span<const Vec2> hull, const Vec2& from, const Vec2& direction);

}  // namespace ft::garments
