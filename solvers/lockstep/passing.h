// Cords that stand in the way of what is driven and give way no further are let through it: which points pass through
// what, and until when.
#pragma once

#include <span>
#include <vector>

#include "solvers/lockstep/lockstep_contact.h"

namespace ft::inline solvers {

/// Adds to `through` (LockstepContact::let_through()) the points that block; false: there are none.
bool let_blocking_through(std::span<const LockstepContact::Blocked> blocking, std::vector<double>& through);

/// The last resort: all points pass through all scenery that moves.
void let_all_through(const LockstepModel& model, std::vector<double>& through);

/// Points that start inside a body, or with a cord that crosses it, pass through it. time: of the start [s].
void let_start_through(const LockstepModel& model, double time, std::vector<double>& through);

/// What was let through something at the places x and is clear of it is held back by it again. time: of these [s].
void hold_again(const LockstepModel& model, LockstepContact& contact, double time, std::span<const Vec3> x,
                std::vector<double>& through);

/// What points are let through: "\"ball\", which goes its way whatever stands in it".
std::string passed_text(const LockstepModel& model, std::span<const double> through);

}  // namespace ft::inline solvers
