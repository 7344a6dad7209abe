// Which of the formats that a shot lists take what a secondary is. A format that does not is left out of it with a
// note; where none is left, that is said before the first frame.
#pragma once

#include <vector>

#include "baker/plan/plan.h"
#include "io/cache/cache.h"

namespace ft::inline baker {

/// Those of the shot that take it, in the shot's order.
std::vector<const CacheFormat*> formats_for(const Shot& shot, const FrameContent& content);

/// Of all outputs of a plan; notes go into it. Errors: a secondary that no format of the shot takes, volumes of
/// no water or without the caches that they are made from (k_usage).
Status check_output_formats(BakePlan& plan);

}  // namespace ft::inline baker
