// Cloth that is let through a part, because there is no room for it, sticks to what still holds it: a strong drag
// relative to the nearest surface of the larger parts. So it neither springs up into the part that it passes nor
// wanders off in it, and when the part opens it is found where it was. Stretched cloth still tears itself loose.
#pragma once

#include <span>
#include <vector>

#include "solvers/energies/energy.h"

namespace ft {

struct ClothModel;
struct ClothMotion;
struct PieceMotion;

class LetThroughDrag final : public Energy {
 public:
  explicit LetThroughDrag(std::span<const double> mass) : mass_(mass) {}
  /// Takes up the cloth that is let through now, and what it is to follow in this piece.
  void follow(const ClothModel& model, const ClothMotion& cloth, const PieceMotion& piece);

  std::string_view name() const override { return "let_through"; }
  std::vector<std::array<int, 4>> stencils() const override { return {}; }
  void begin_step(const StepContext& context) override { h_ = context.h; }
  double value(std::span<const Vec3> x) const override;
  void add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const override;
  void add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const override;

 private:
  double stiffness(int vertex) const;

  struct Held {
    int vertex;
    Vec3 place;  ///< at the end of the piece, if it does not slip [m]
  };
  std::span<const double> mass_;  ///< kg
  std::vector<Held> held_;
  double h_ = 0;  ///< s
};

}  // namespace ft
