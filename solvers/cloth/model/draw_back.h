// Holds cloth where what it lies on has been let go (absence.h): a hole in the body would swallow the sleeve on it, and
// what has got into the body has to come out on the side where it belongs. Cloth that is on its side stays above the
// skin and slides on it, and goes along with it while it is inside, so that what was pressed does not spring through;
// what is not is drawn back to where it lay when the garment was put on (in the bind pose), as
// pins do (pin_pull.h): no harder than a limit, and no faster than they.
#pragma once

#include <span>
#include <vector>

#include "solvers/cloth/model/pin_pull.h"
#include "solvers/energies/energy.h"

namespace ft::inline solvers {

struct ClothModel;
struct ClothMotion;
struct PieceMotion;

class DrawBack final : public Energy {
 public:
  /// Takes up what holds a piece of h [s].
  void follow(const ClothModel& model, const ClothMotion& cloth, const PieceMotion& piece,
              std::span<const SkinHold> holds, double h);

  std::string_view name() const override { return "draw_back"; }
  std::vector<std::array<int, 4>> stencils() const override { return {}; }
  void begin_step(const StepContext&) override {}
  double value(std::span<const Vec3> x) const override;
  void add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const override;
  void add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const override;

 private:
  struct Held {
    int vertex;
    PinPull pull;
  };
  struct Above {
    int vertex;
    Vec3 normal;
    double height;     ///< of the plane along its normal, with the contact radius [m]
    double stiffness;  ///< N/m
  };
  struct Slowed {
    int vertex;
    Vec3 place;        ///< at the end of the piece, if it does not move against the body [m]
    double stiffness;  ///< N/m
  };
  std::vector<Held> held_;
  std::vector<Slowed> slowed_;
  std::vector<Above> above_;
};

}  // namespace ft::inline solvers
