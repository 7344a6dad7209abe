// What can be wrong with a setup of cloth, before anything is built of it.
#pragma once

#include "baker/core/result.h"
#include "solvers/cloth/model/cloth_setup.h"

namespace ft::inline solvers {

/// What is wrong with a setup, by garment and vertex.
Status check(const ClothSetup& setup);

}  // namespace ft::inline solvers
