// Draws cloth back to where it lay on the skin when the garment was put on (in the bind pose), where what it lies on has
// been let go (absence.h): a hole in the body would swallow the sleeve on it, and what has got into the body has to come
// out on the side where it belongs. As pins do (pin_pull.h): no harder than a limit, and no faster than they.
#pragma once

#include <span>
#include <vector>

#include "solvers/cloth/pin_pull.h"
#include "solvers/energies/energy.h"

namespace ft {

struct ClothModel;
struct ClothMotion;
struct PieceMotion;

class DrawBack final : public Energy {
 public:
  /// Takes up the vertices that are to be drawn back, to where the piece of h [s] takes their places on the skin.
  void follow(const ClothModel& model, const ClothMotion& cloth, const PieceMotion& piece, std::span<const int> vertices,
              double h);

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
  std::vector<Held> held_;
};

}  // namespace ft
