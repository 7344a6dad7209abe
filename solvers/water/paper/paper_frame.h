// The steps of one frame. For paper_*.cpp only.
#pragma once

#include "solvers/water/driven_near.h"
#include "solvers/water/droplet_numbers.h"
#include "solvers/water/paper/paper_solver.h"
#include "solvers/water/paper/paper_splash.h"

namespace ft::inline solvers {

/// What a frame works with and forgets.
struct PaperScratch {
  explicit PaperScratch(const PaperSetup& setup) : water(setup) {}
  PipeWater water;
  UnderBodies under;
  std::vector<DrivenNear> driven;
  std::vector<FloatState> floats;
  std::vector<std::vector<Vec3>> places;  ///< of floats
  std::vector<Droplet> droplets;
  std::uint64_t next_id = 1;
};

/// How hard a floating body and the water under it may push one another: the square of a rate [1/s2].
double float_rate(const FloatingHull& hull, const PaperSetup& setup);

class PaperFrame {
 public:
  /// driven: all of them, of which the scratch has what may meet the water; they have to stay.
  PaperFrame(const PaperSetup& setup, std::span<const FloatingHull> hulls, PaperScratch& scratch,
             std::span<const DrivenBody> driven, double frame_time, std::uint64_t number);
  /// Bodies where they are at a share of the frame, and heads.
  void meet(double share);
  /// Takes away the water in whose place driven bodies stand at the frame's start; how much [m3].
  double make_room();
  void go();
  WaterReport report() const;
  double outflow() const { return outflow_; }
  /// Of each cell: the water's top, under bodies and above them [m].
  std::vector<double> tops() const;
  /// Of the columns, by density and gravity [m4].
  double potential() const;

 private:
  double step_time() const;
  void step(double dt, std::uint64_t number);
  void push_driven(double dt);
  void move_floats(double dt);
  void add_panels(const DrivenNear& body, Wrench& on) const;
  Vec3 water_velocity(std::size_t body) const;

  const PaperSetup& setup_;
  std::span<const FloatingHull> hulls_;
  PaperScratch& s_;
  DropletBodies met_;
  double frame_time_, time_ = 0, outflow_ = 0, body_speed_ = 0;
  std::uint64_t number_;
  std::vector<WaterOnBody> on_driven_;
  WaterReport report_;
};

}  // namespace ft::inline solvers
