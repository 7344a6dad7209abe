// Buttons, hooks and zips: a vertex hangs by a cord (cords.h) on a point of a triangle, of another garment or of its
// own, as long as its hold_span.h says. Nothing is left out of contact for it, so that what opens meets as any cloth; a
// cord is therefore no shorter than the distance at which the two touch (solvers/cloth/model/attach.cpp).
#pragma once

#include <vector>

#include "solvers/energies/cloth_topology.h"
#include "solvers/energies/cords.h"

namespace ft::inline solvers {

class Attachments final : public Cords {
 public:
  explicit Attachments(const ClothTopology& topology);
  std::string_view name() const override { return "attachments"; }
  bool is_internal() const override { return false; }
  void begin_step(const StepContext& context) override;

 private:
  std::vector<AttachPoint> points_;
};

}  // namespace ft::inline solvers
