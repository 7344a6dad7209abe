// Points that come and go as the preview's page holds them: in every frame as many places of 16 bits per axis as there
// are points then, and a width of 16 bits.
#pragma once

#include "baker/core/result.h"
#include "baker/record/cache_track.h"
#include "baker/record/report_json.h"

namespace ft::inline baker {

/// frames: how many are shown, from the first. Error: a frame that cannot be read (k_input).
///   vertices     the most points of any frame; low, step, positions: their places, quantised as vertices of meshes
///                are, frame by frame without gaps
///   points       { counts  u32, of each frame
///                  widths  u16, of each point in turn: 65535 is `widest`
///                  widest  m }
Result<Json> preview_points(const ManifestSystem& system, const CacheTrack& track, int frames);

}  // namespace ft::inline baker
