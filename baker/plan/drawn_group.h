// Groups that meet bodies as they are drawn, without a feasible collider of their own: leaves, hair.
#pragma once

#include "baker/systems/interface/system.h"

namespace ft::inline baker {

class DrawnGroup : public SystemGroup {
 public:
  using SystemGroup::SystemGroup;

  std::vector<std::size_t> meets;  ///< primaries, into BakePlan::primaries
  Box around;                      ///< all that is solved, at the start [m]

  Box start() const override { return around; }
  /// All of them, whole.
  std::vector<ColliderSlice> slices(const BakePlan& plan, std::span<const std::string> taken) const override;

 protected:
  /// In quotes, for lines().
  std::string met_names(const BakePlan& plan) const;
};

/// What a secondary meets: what it is on, and what its patterns name, into `meets`; a note for each that it cannot.
/// Error: a pattern that names none.
Status find_met(const SecondarySpec& spec, std::span<const std::string> patterns, BakePlan& plan,
                std::vector<std::size_t>& meets);

}  // namespace ft::inline baker
