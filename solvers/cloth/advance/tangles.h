// Cloth that crosses cloth where it starts: a garment modelled with its lapel through its front, a body that closed on
// it. The crossings, and what they make infeasible, are found anew for every piece of a substep (way_out.h); everything
// else goes on holding itself apart. A displacement after which more would cross somewhere than before is not made: a
// tangle gets smaller or stays as it is. A function of the positions alone; the marks only say where to look.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "collision/check/crossings.h"
#include "solvers/cloth/model/cloth_model.h"
#include "solvers/cloth/model/cloth_motion.h"
#include "solvers/cloth/solve/way_out.h"

namespace ft::inline solvers {

/// Of the crossings within the cloth those that are of garments that collide with themselves.
std::vector<Crossing> own_crossings(const ClothModel& model, std::vector<Crossing> within);

/// Fills `tangled` (per cloth vertex, 0 or 1) with the vertices of these crossings and of all edges within two of them:
/// where a contour can be when a piece of a substep is over.
void mark_tangled(const ClothModel& model, std::span<const Crossing> crossings, std::vector<char>& tangled);

bool any_tangled(std::span<const char> tangled);

/// What crosses in the cloth, and the way out of it, as one piece of a substep after the other has it.
class Tangles {
 public:
  explicit Tangles(const ClothModel& model) : model_(model), finder_(model) {}
  /// Before a piece of h [s]. Cloth that is not marked tangled costs nothing; what is, is marked anew.
  void look(double h, ClothMotion& cloth);
  const WayOut& way_out() const { return way_out_; }
  /// Whether x [m] has no more crossings anywhere than look() has seen there.
  bool no_worse(std::span<const Vec3> x);
  /// What is open no longer, because the way to x [m] would leave more crossings; empty: it may be gone.
  ContactPairs close_growing(std::span<const Vec3> x);
  /// Accelerations of the cloth's vertices, given (or empty), and what shortens contours besides way_out() [m/s2].
  std::span<const Vec3> push(std::span<const Vec3> given);

 private:
  std::vector<Crossing> crossings_of(std::span<const Vec3> x);

  const ClothModel& model_;
  std::optional<CheckedSurface> cloth_;  ///< since the first tangle
  WayOutFinder finder_;
  WayOut way_out_;
  std::vector<Vec3> push_;
};

/// A crossing that was there when `tangled` was marked, or grew out of one.
bool among_tangled(const Crossing& crossing, std::span<const char> tangled);

}  // namespace ft::inline solvers
