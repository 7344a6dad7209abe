// Whether a body's shape and its motion's size can be right. A stated height or unit says how tall a character is, and
// nothing of how wide: a torn body can be 1.75 m tall and 10 m wide.
#pragma once

#include <string>
#include <vector>

#include "baker/core/result.h"
#include "baker/core/trajectory.h"
#include "io/import/character/import_request.h"

namespace ft::inline io {

/// What is looked at: built is a body around a skeleton, figure one with two arms and two legs.
struct SizedBody {
  bool built = false, figure = false;
};

/// A figure that is wider than it is tall beyond all poses is refused where its body was built, else noted.
Status check_shape(const Box& bind, const SizedBody& body, const std::string& file, std::vector<std::string>& notes);

/// Looks at frames all through the shot: one whose figure is much larger than the bind pose is noted; where its body
/// was built, and it is absurd, refused.
Status check_growth(const Trajectory& trajectory, const ImportRequest& request, const SizedBody& body,
                    std::vector<std::string>& notes);

}  // namespace ft::inline io
