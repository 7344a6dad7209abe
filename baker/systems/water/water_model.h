// Which model of water suits a rectangle of it, and why.
#pragma once

#include <string>
#include <vector>

namespace ft::inline baker {

struct WaterAdvice {
  std::string model;    ///< "shallow" or "pond"
  std::string reason;   ///< one clause, for a note: "waves of 1 m ..."
  double wave = 0;      ///< length of the waves that it is judged by [m]
  double too_fast = 0;  ///< by how much shallow water carries them too fast [1]
};

/// depth: of the still water at its deepest [m]; along, across: of the rectangle [m]; has_bed: the ground is not level.
/// Never "paper", which a shot may only name.
WaterAdvice advise_water(double depth, double along, double across, bool has_bed);

/// What is wrong with a model that the shot names in the place of the advice; empty: it is right enough.
std::string doubt_of_model(const std::string& model, const WaterAdvice& advice, double depth);

/// What a model leaves out, whatever the water: notes for the plan. floats: how many bodies float in it.
std::vector<std::string> limits_of_model(const std::string& model, std::size_t floats);

}  // namespace ft::inline baker
