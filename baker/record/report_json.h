// A frame's certificate as JSON and back, exactly (shortest digits that give the same double). The manifest, the
// checkpoint, the log and `check` all speak through these, so a field is named once.
#pragma once

#include <nlohmann/json.hpp>

#include "baker/core/result.h"
#include "solvers/base/frame_metrics.h"

namespace ft::inline baker {

using Json = nlohmann::ordered_json;

/// Certificate and incidents; no times.
Json to_json(const FrameReport& report);
Json to_json(const Incident& incident);
Json to_json(const InteractionForce& force);
Json to_json(const AbsentRuns& absent);
/// Wall times [s].
Json to_json(const FrameProfile& profile);

/// Absent fields keep their defaults, null is infinity; a field of another type is an error.
Result<FrameReport> frame_report_from_json(const Json& json);
Result<FrameProfile> frame_profile_from_json(const Json& json);

/// Text -> JSON; a fault names `where`.
Result<Json> parse_json(const std::string& text, const std::string& where);

/// One indent level for the outer structure, frames and other small objects on one line each: small files that diff
/// well.
std::string to_text(const Json& json);

/// Several systems in one frame, as their metrics say: counts add up, depths and strains take the largest.
FrameReport merge(const FrameReport& a, const FrameReport& b);

}  // namespace ft::inline baker
