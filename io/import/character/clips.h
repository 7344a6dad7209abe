// Which clip plays, and clips of another file put onto this skeleton.
#pragma once

#include <string>
#include <vector>

#include "io/import/character/character.h"
#include "io/import/character/import_request.h"

namespace ft::inline io {

/// Index of the named clip; empty name: the first, with a note when there are several; -1 when there are none at all.
/// An unknown name is an error that lists those that exist and the one that was probably meant.
Result<int> select_clip(const Character& character, const std::string& name, const std::string& file,
                        std::vector<std::string>& notes);

/// File units of the target in one of the source; 1 where one of them carries no unit (BVH).
double unit_ratio(const Character& source, const Character& target);

/// Takes the clips of `source` (a file with the motion only) for `target`, node by name
/// (match_nodes.h); lengths change from source's
/// unit to target's. Nodes that are missing here are noted, and those that are
/// matched by a guess; no match at all is an error.
Result<std::vector<Clip>> retarget_clips(const Character& source, const Character& target,
                                         const std::string& source_file, std::vector<std::string>& notes);

/// Refuses a shot that leaves the clip by more than a frame; of a clip that repeats only one that starts before it.
Status check_clip_range(const Clip& clip, const ImportRequest& request, const std::string& file);

/// Of the candidates, the one with the fewest letters changed from the word (Levenshtein), if it is near; else empty.
std::string nearest_name(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace ft::inline io
