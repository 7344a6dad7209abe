// The bodies that strands meet, at the start and the end of a step, with a box tree for the start.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "collision/body/part_distance.h"
#include "collision/geometry/triangle_tree.h"
#include "solvers/hair/hair_setup.h"
#include "solvers/hair/sharp_edges.h"

namespace ft::inline solvers {

class HairBodies {
 public:
  /// bodies have to stay. segment: length of strands' segments [m]; 0: edges() are not asked for.
  explicit HairBodies(std::span<const HairBody> bodies, double segment = 0);

  /// Where all are at a time [s], as the start of the step that comes.
  void start_at(double time);
  /// The end of the step. common: the motion in it that most of what is asked for shares, as of a head [m].
  void end_at(double time, const Vec3& common = Vec3::Zero());
  /// The end becomes the start of the next step.
  void advance();

  int count() const { return static_cast<int>(bodies_.size()); }
  bool sheet(int body) const { return given_[at(body)].sheet; }
  double friction(int body) const { return given_[at(body)].friction; }
  std::span<const Triangle> triangles(int body) const { return bodies_[at(body)].triangles; }
  std::span<const Vec3> before(int body) const { return bodies_[at(body)].before; }
  std::span<const Vec3> after(int body) const { return bodies_[at(body)].after; }
  /// Over the triangles at the start.
  const MovingTree& tree(int body) const { return bodies_[at(body)].tree; }
  /// The motion that end_at() was given [m].
  const Vec3& common() const { return common_; }
  /// At the start.
  const SharpEdges& edges(int body) const { return bodies_[at(body)].edges; }
  /// Whether a point, whose closest one on a body is known, is inside; and the normal there, outwards. A body's own
  /// folds, where the closest triangle tells the wrong side, are asked by rays.
  bool inside(int body, const Vec3& point, const TriangleTree::Hit& hit, Vec3& normal) const;
  /// By rays alone: also where a body is inside of itself, as an arm in a trunk, and the nearest surface says nothing.
  bool rays_inside(const Vec3& point) const;
  struct Nearest {
    Vec3 place = Vec3::Zero(), normal = Vec3::UnitY();  ///< of the body there, outwards
    double gap = 0;                                     ///< below 0: inside [m]
  };
  /// Of all bodies at the start what is nearest to a point within a distance, or what the point is deepest in.
  std::optional<Nearest> nearest(const Vec3& point, double look) const;
  /// How far a point is inside of the body that it is deepest in, at the start; below 0: how far
  /// it is outside of all, at most `look` [m].
  double depth(const Vec3& point, double look) const;
  bool has_sheets() const;
  /// Whether a segment goes through a sheet at the start.
  bool through_sheet(const Vec3& a, const Vec3& b) const;
  /// The farthest that a vertex of any body goes in the step [m].
  double way() const { return way_; }

 private:
  struct Body {
    std::vector<Vec3> before, after;
    std::span<const Triangle> triangles;
    MovingTree tree;
    SharpEdges edges;
    std::optional<PartSurface> surface;  ///< as one part; of sheets, none
  };
  static bool is_behind_any(const Body& body, const Vec3& point, double distance);

  std::span<const HairBody> given_;
  std::vector<Body> bodies_;
  Vec3 common_ = Vec3::Zero();
  double way_ = 0;
  std::vector<double> ways_;  ///< scratch
};

/// A point near a body as the start of a step has it.
struct NearSurface {
  int body = -1, triangle = -1;
  Vec3 weights = Vec3::Zero();  ///< of the triangle's corners: where it is nearest
  Vec3 normal = Vec3::UnitY();  ///< unit, away from the body there, at the start
  double gap = 0;               ///< below 0: inside [m]
};

/// The nearest places of bodies around a point, of up to `most` directions that differ by more than 40 degrees, the
/// nearest first; none farther than reach and, where the point goes somewhere in the step, what it goes beside the
/// body there. candidates: pairs of body and triangle in which all of them are.
int find_nearest(const HairBodies& bodies, std::span<const std::pair<int, int>> candidates, const Vec3& point,
                 double reach, int most, NearSurface* out, const Vec3* goes = nullptr);

/// Pairs of body and triangle, in any order: all that are within reach of a box at the start, or may get there.
void find_candidates(const HairBodies& bodies, const Box& box, double reach, std::vector<std::pair<int, int>>& out);

/// Where a segment of a strand is nearest to a sharp edge of a body, between its ends.
struct NearEdge {
  NearSurface surface;  ///< of the place on the edge; its gap may be below 0: the segment is inside there
  double share = 0;     ///< of the segment, from its first end
};

/// The nearest one within reach and, where the ends go somewhere in the step, what they go beside the body there.
std::optional<NearEdge> find_nearest_edge(const HairBodies& bodies, const Vec3& a, const Vec3& b, double least_reach,
                                          const Vec3* a_goes = nullptr, const Vec3* b_goes = nullptr);

}  // namespace ft::inline solvers
