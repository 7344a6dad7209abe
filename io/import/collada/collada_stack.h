// A <node>'s transform as a stack, and the keys of <sampler> elements as curves.
#pragma once

#include "io/import/collada/collada_file.h"

namespace ft::inline io {

struct ColladaTransform {
  TransformStack stack;
  std::vector<std::string> sids;   ///< one per element
  std::vector<std::string> kinds;  ///< "translate", "rotate", "scale", "matrix", "lookat", one per element
  bool skewed = false;             ///< there is a <skew>, which is left out
};

ColladaTransform collada_transform(const pugi::xml_node& node, int index);

/// Curves of the output's numbers in turn. Cubic keys of both kinds become handles. unknown: set where an interpolation
/// is none of STEP, LINEAR, BEZIER and HERMITE; straight lines take its place.
Result<std::vector<Curve>> collada_curves(const ColladaFile& file, const pugi::xml_node& sampler, bool& unknown);

}  // namespace ft::inline io
