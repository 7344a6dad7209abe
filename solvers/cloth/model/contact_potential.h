// Contact and friction as terms of the incremental potential, over the pairs that can touch in one solve.
//   E(d) = k/2 (r - d)^2             r/2 < d < r
//   E(d) = -k r^2/4 ln(2d/r) + c     d < r/2      (C2 at r/2: force k r/2, stiffness k; unbounded as d -> 0)
//        + k r^2/4 ln(r/8d)^3        d < r/8      (C2 at r/8: taut cloth keeps a gap in which it can follow the body)
// k = stiffness per area times the lumped cloth area of the pair, so that pressure does not depend on the mesh. The
// radius is cut to half the rest distance for pairs of cloth that are near each other at rest: neighbours never repel.
// Friction is lagged (normal force of the current linearisation), relative to the moving surface, smooth below eps_v.
// Offset geometric contact's rule keeps each contact once: edge-edge pairs count only where both parameters are
// interior.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collision/broad_phase/pair_view.h"
#include "collision/geometry/pair_geometry.h"
#include "solvers/linear/block_matrix.h"

namespace ft::inline solvers {

/// Per vertex of the common numbering (cloth first). A side of a pair takes the radius at its closest point, linear
/// between its vertices, so that a contact feels no step where it slides from one triangle to the next; between two
/// cloths the smaller of the sides counts. Of areas the pair takes the mean, of friction the larger.
struct ContactModel {
  int cloth_vertex_count = 0;
  /// N/m3. 1e5 soft as flesh, 1e7 hard; gravity on cotton is 1.5 Pa, so 5e5 rests 3 um deep. Much harder contacts hold
  /// cloth between two surfaces so fast that friction tears at it.
  double stiffness_per_area = 5e5;
  double sliding_speed = 2e-5;  ///< below this speed friction is viscous [m/s]: the creep of a contact at rest
  std::vector<double> area;     ///< lumped area of each cloth vertex [m2]
  std::vector<double> radius;   ///< contact radius against the body of each cloth vertex [m]
  std::vector<int> garment;     ///< of each cloth vertex
  std::vector<double> friction, self_friction;  ///< Coulomb coefficient of each garment [1]
  std::span<const Vec3> rest;                   ///< rest positions of the cloth vertices, which must stay [m]

  /// Among cloths, where it is `radius` against the body [m].
  static double self_radius(double radius) { return radius * 2 / 3; }
};

/// One active contact of the current linearisation.
struct Contact {
  std::array<int, 4> vertex;
  PairGeometry geometry;
  double radius = 0, stiffness = 0, friction = 0;
};

class ContactPotential {
 public:
  explicit ContactPotential(const ContactModel& model) : model_(model) {}

  /// Takes the pairs of one solve. x_start: all positions at the start of the step (friction measures slip from there),
  /// h: its length [s], friction_share: of all friction [1].
  void begin(const PairList& pairs, std::span<const Vec3> x_start, double h, double friction_share = 1);

  /// Finds the active contacts at x (all vertices): where the cloth was at the last update, and on by `share` of the
  /// move (per cloth vertex [m]); empty: nothing has moved, or it is the first. Distances are evaluated anew only where
  /// the pair can have come within reach.
  void update(std::span<const Vec3> x, std::span<const Vec3> move = {}, double share = 1);
  /// Fixes normal forces for friction at the contacts of the last update.
  void lag_friction();
  bool has_friction() const { return !lagged_.empty(); }
  /// Gives back the memory of the contacts: there are none until the next update. Friction stays fixed.
  void forget_contacts();
  /// Takes up the pairs that have come behind those of begin(), at x, the positions of the last update and of
  /// lag_friction().
  void extend(std::span<const Vec3> x);

  double value(std::span<const Vec3> x) const;  ///< J, at the positions of the last update
  void add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const;  ///< N, cloth vertices only
  void add_terms(std::span<const Vec3> x, std::vector<PairTerm>& terms) const;

  /// Of add_gradient() what garments do to each other alone.
  void add_gradient_between_garments(std::span<const Vec3> x, std::span<Vec3> gradient) const;
  /// Of add_gradient() what garments do to one of several bodies; body_of_vertex: per vertex behind the cloth's.
  void add_gradient_with_body(std::span<const Vec3> x, int body, std::span<const int> body_of_vertex,
                              std::span<Vec3> gradient) const;
  /// Marks the garments that touched the body at the last update.
  void mark_touching(std::span<char> of_garment) const;

  /// Pairs that displacements of the cloth's vertices by no more than these lengths [m] can bring nearer than floor
  /// [m], for truncation.
  void near_pairs(std::span<const double> lengths, double floor, PairPlaces& out);
  std::span<const Contact> contacts() const { return contacts_; }
  double smallest_gap() const;  ///< m, over the contacts of the last update; infinite without any

 private:
  /// Friction at a contact of an earlier linearisation. There are as many as contacts, all through a solve: floats.
  struct Lagged {
    float most;  ///< N
    Vec3f normal;
    std::array<float, 3> last_weights;  ///< of PairGeometry::weight, without the first
    std::array<int, 4> vertex;

    Lagged(const Contact& contact, double most_force);
    bool is_at(const Contact& contact) const;
    /// They sum to zero as exactly as doubles do: friction makes no momentum.
    std::array<double, 4> weight() const;
    /// Along the surface, of the first feature against the second, since the start [m].
    Vec3 slip(std::span<const Vec3> x, std::span<const Vec3> x_start) const;
  };
  template <class Counts>
  void add_gradient_where(std::span<const Vec3> x, std::span<Vec3> gradient, Counts&& counts) const;
  /// Force by slip, which below eps is viscous [N/m].
  static double friction_stiffness(const Lagged& lagged, const Vec3& slip, double eps);
  double pair_radius(const std::array<int, 4>& v, bool vertex_face, const PairGeometry& geometry, double* friction,
                     double* area) const;
  void update_kind(bool vertex_face, std::span<const Vec3> x, std::size_t first);
  void lag_friction_from(std::size_t first);
  float way_of(const std::array<int, 4>& v, bool vertex_face, bool farthest) const;
  bool may_be_within(const std::array<int, 4>& v, bool vertex_face, std::uint16_t known, float reach) const;

  const ContactModel& model_;
  const PairList* pairs_ = nullptr;  ///< those in front are in known_vf_, known_ee_
  std::span<const Vec3> x_start_;
  double h_ = 0, friction_share_ = 1;
  std::vector<float> way_;  ///< how far each cloth vertex has gone in this solve [m]
  /// Per pair: its distance when that was last evaluated and what its vertices had gone then, at least, together [1e-6
  /// m], rounded down; 0: nothing is known. Less what they have gone by now it is no more than their distance.
  std::vector<std::uint16_t> known_vf_, known_ee_;
  std::vector<Contact> contacts_;
  std::vector<Lagged> lagged_;
  std::vector<std::vector<Contact>> block_contacts_;
  std::vector<float> reach_;  ///< per cloth vertex: pairs nearer than this may have to be truncated [m]
};

/// E, -dE/dd and d2E/dd2 of the contact law above.
struct ContactLaw {
  double energy, force, stiffness;
};
ContactLaw contact_law(double distance, double radius, double stiffness);

}  // namespace ft::inline solvers
