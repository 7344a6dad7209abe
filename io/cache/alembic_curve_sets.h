// All curves of an Alembic archive of any origin, for hair. Programs write a groom as one object or as one for each
// curve, beside meshes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "baker/core/output_shape.h"
#include "baker/core/result.h"

namespace ft::inline io {

struct CurveObject {
  std::string name;
  CurveSet curves;     ///< in the world and the file's unit; at rest where the file says how, else its first sample
  bool linear = true;  ///< else the vertices are control points of smooth curves
};

/// In the archive's order. Errors: no curves, curves that change in number, damage.
Result<std::vector<CurveObject>> read_alembic_curve_sets(const std::filesystem::path& path);

}  // namespace ft::inline io
