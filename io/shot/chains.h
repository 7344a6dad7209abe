// Chains: secondaries that are on other secondaries, or meet them. What was baked is a body like any other, so a shot
// is baked in stages; the references alone say in which order, wherever the sections stand in the file. What is in one
// stage can feel each other; of an earlier stage it feels the motion, which no longer changes (one-way).
#pragma once

#include <vector>

#include "io/shot/shot.h"
#include "io/shot/shot_judge.h"

namespace ft::inline io {

/// The secondaries that one is on or names in `meets`: indices into all, ascending.
std::vector<std::size_t> references_of(const SecondarySpec& secondary, const Secondaries& all);

/// Faults: what is on itself, circles with their members, and who cannot carry or be carried.
void judge_chains(const Value& root, const Shot& shot, FaultList& faults);

/// Of each secondary, of a shot without faults: 0, or one more than the latest that it refers to; and no earlier than
/// those that it is solved together with.
std::vector<int> stages_of(const Secondaries& all);

}  // namespace ft::inline io
