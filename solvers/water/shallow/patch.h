// A rectangle of the domain that takes shorter steps than the rest (local time steps). The rest has gone first, by one
// long step; what has passed the patch's rim in it passes there evenly through all of the patch's steps, so that both
// sides agree on it to rounding. Cells at the rim keep back what they still owe.
#pragma once

#include "solvers/water/shallow/flow.h"

namespace ft::inline solvers {

/// Cells [i0, i1) x [k0, k1).
struct CellBox {
  int i0 = 0, k0 = 0, i1 = 0, k1 = 0;
  bool empty() const { return i0 >= i1 || k0 >= k1; }
  void include(const CellBox& o);
  CellBox inside(int nx, int nz, int margin) const;  ///< grown by a margin, and cut
  double size() const { return empty() ? 0.0 : static_cast<double>(i1 - i0) * (k1 - k0); }
};

class Patch {
 public:
  Flow flow;

  /// Takes the box's state from the whole. `alone`: it is all of it, and the whole has not moved; otherwise the whole
  /// is at the step's end, with its start in h1, u1..., and `rim()` has been called before.
  void begin(const Flow& whole, const CellBox& box, bool alone);
  /// After step_depths() of the whole: what has passed the box's rim.
  void rim(const Flow& whole, const CellBox& box, double dt);
  /// What has gone out over the whole's open sides beside the box [m3].
  static double outflow_beside(const Flow& whole, const CellBox& box, double dt);

  /// Ghosts beyond the rim at a share of the long step, 0 to 1.
  void set_ghosts(const Flow& whole, double share);
  /// After step_velocities(): velocities and fluxes of the rim's faces.
  void hold_rim(const Flow& whole, double share);
  /// Before step_depths(): cuts what leaves cells at the rim inwards to what they do not owe; `left` of the long step,
  /// this step included [s].
  void keep_owed(double dt, double left);
  /// The largest |velocity| + k_wave_share sqrt(g h) in the `width` cells along the rim [m/s].
  double rim_speed(double gravity, int width) const;
  /// Puts its state into the whole.
  void end(Flow& whole) const;

 private:
  struct Pair {
    std::size_t here, there;
  };
  CellBox box_;
  std::vector<double> rim_[4];
  std::vector<Pair> ghost_cells_, ghost_u_, ghost_w_;
};

}  // namespace ft::inline solvers
