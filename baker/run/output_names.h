// What a bake will write into its folder, by the shot alone: so that a folder in which one of these is an input of the
// shot is refused before anything is written. A character's animation that is overwritten with a skirt is lost.
#pragma once

#include <string>
#include <vector>

#include "baker/plan/inputs.h"
#include "baker/record/bake_folder.h"

namespace ft::inline baker {

/// File names in the folder; a few more than are written, since some caches depend on what the solvers find.
std::vector<std::string> output_names(const Shot& shot);

/// Refuses a folder in which one of output_names() is one of the inputs, by whatever path.
Status check_inputs_stay(const BakeInputs& inputs, const BakeFolder& folder);

}  // namespace ft::inline baker
