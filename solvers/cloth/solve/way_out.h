// The way out of a tangle, from positions alone, anew for every piece of a substep: which pairs the crossings make
// infeasible, and where to they are pulled. All other pairs go on holding each other, next to the contour and inside
// of what it cuts off, so that a tangle can give crossings up and not get new ones.
//
// What a contour cuts off: the meshes, cut at all edges that cross a face, fall into regions, and of the two ends of
// such an edge the one in the smaller region is on the wrong side (global intersection analysis: Baraff, Witkin and
// Kass, "Untangling Cloth", 2003). It is pulled back through the face, and the contour travels one row of vertices
// after the other until the region is through; which way each piece of it goes follows from counting (Volino and
// Magnenat-Thalmann 2006 ask for the shorter contour): when a vertex passes a face, its edges that cross the face cease
// to and the others begin to; when two edges pass each other it is the same with the faces beside them.
//
//            q                    q held by T, its edges are not through
//     ======/==========  T        (p, q) crosses T, p is cut off: pair (p, T) is open, p is pulled up through T
//          p
//
// Caution: passing is allowed by pairs. Two open pairs that pass at once can leave a crossing more than one after the
// other would; the next piece sees it.
#pragma once

#include <span>
#include <vector>

#include "baker/core/mesh.h"
#include "collision/broad_phase/contact_pairs.h"
#include "collision/check/crossings.h"
#include "solvers/cloth/model/cloth_model.h"

namespace ft::inline solvers {

/// A pair that is pulled through itself, by a spring along a fixed normal:
///   E = k/2 (goal - s)^2   s < goal,  s = normal . sum weight[i] x[i]
struct Pull {
  std::array<int, 4> vertex;
  std::array<double, 4> weight;  ///< as PairGeometry's
  Vec3 normal;                   ///< the way that the first feature has to go against the second
  double goal = 0;               ///< m
  double stiffness = 0;          ///< N/m

  double missing(std::span<const Vec3> x) const {
    Vec3 offset = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) offset += weight[k] * x[at(vertex[k])];
    return std::max(0.0, goal - normal.dot(offset));
  }
  double energy(std::span<const Vec3> x) const { return 0.5 * stiffness * missing(x) * missing(x); }
  void add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const {
    const Vec3 force = -stiffness * missing(x) * normal;
    for (std::size_t k = 0; k < 4; ++k) gradient[at(vertex[k])] += weight[k] * force;
  }
  PairTerm term() const;
};

struct WayOut {
  ContactPairs open;         ///< pairs that contact and truncation leave alone; sorted, see is_open()
  std::vector<char> beside;  ///< per cloth vertex: whether it is in such a pair; empty: there are none
  std::vector<Pull> pulls;
  std::vector<Crossing> unexplained;  ///< crossings that no region is cut off by: the contour's gradient has to do

  bool empty() const { return beside.empty(); }
  bool is_open(PairKind kind, const Stencil& pair) const;
};

/// Fills `out` for crossings (own_crossings()) of the cloth at x [m], for a piece of h [s].
class WayOutFinder {
 public:
  explicit WayOutFinder(const ClothModel& model) : model_(model) {}
  void find(std::span<const Vec3> x, std::span<const Crossing> crossings, double h, WayOut& out);
  /// Whether somewhere more crossings have come than gone, where these are those after a displacement.
  bool grows(std::span<const Crossing> after);
  /// With the crossings of where a displacement would lead from there: takes out of out.open what would let more
  /// crossings come than go somewhere, and returns it. Nothing when all is well.
  ContactPairs close_growing(std::span<const Crossing> after, WayOut& out);

 private:
  using Place = std::uint64_t;  ///< an edge by its rank, a face by its number
  static Place place(int edge, int face) {
    return static_cast<Place>(static_cast<std::uint32_t>(edge)) << 32 | static_cast<std::uint32_t>(face);
  }
  void learn_mesh();
  int edge_of(int a, int b) const;
  int face_of(const Triangle& t) const;
  bool crosses(int edge, int face) const;
  void cut_regions(std::span<const Crossing> crossings);
  int wrong_end(const Edge& edge) const;
  std::vector<Crossing> find_growth(std::span<const Crossing> after);
  void look_at_vertex(int v, int face, bool is_wrong);
  void look_at_edges(int e, int f, int face);
  void open_around(int wrong, int e, int face);
  void make_pulls();
  void mark_beside();

  const ClothModel& model_;
  // Of the mesh, since the first tangle.
  Adjacency triangles_of_;  ///< of each vertex
  Adjacency edges_of_;      ///< of each vertex, by rank
  // Scratch.
  std::vector<Place> crossing_;   ///< ascending
  std::vector<char> cut_;         ///< per edge
  std::vector<int> region_;       ///< per vertex
  std::vector<Crossing> before_;  ///< those of find()
  std::vector<double> area_;      ///< of each region, at its root [m2]
  ContactPairs pulled_;
  std::vector<int> place_, growth_;  ///< per vertex, its place's root; per root
  std::span<const Vec3> x_;
  double h_ = 0;
  WayOut* out_ = nullptr;
};

}  // namespace ft::inline solvers
