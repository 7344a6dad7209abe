// Curves as the preview's page holds them: every frame a place of 16 bits per axis between the frame's own bounds, so
// that hair of a character who runs through a hall is as fine as of one who stands. 2000 strands of 32 vertices for
// 100 frames are 51 MB in the page. Where a page would be larger than its limit, a share of the strands is in it.
#pragma once

#include <cstdint>

#include "baker/core/result.h"
#include "baker/record/cache_track.h"
#include "baker/record/report_json.h"

namespace ft::inline baker {

/// Bytes that all vertices of a system of curves need in the page.
std::uint64_t preview_bytes_of_curves(const CacheTrack& track, int frames);

/// Of `count` strands as many as are this share, one at least, evenly chosen: indices, ascending.
std::vector<int> chosen_strands(int count, double share);

/// frames: how many are shown, from the first. share: of the strands, above 0. Error: a frame that cannot be read
/// (k_input).
///   vertices     of the strands that are drawn; strand by strand from its root
///   low, step    bounds of all frames, as meshes have them
///   positions    u16 x 3, of each vertex in each frame, between the bounds of the frame
///   curves       { strands  number of all in the cache
///                  counts   u32, of each that is drawn: its vertices
///                  ids      u32, of each that is drawn: its id, or its index where there are none
///                  widths   f32, of each vertex: diameter [m]; not there where the cache has none
///                  bounds   f64 x 6, of each frame: low, and what a step of 16 bits is
///                  note     that it is a share; not there where all are drawn }
Result<Json> preview_curves(const ManifestSystem& system, const CacheTrack& track, int frames, double share);

}  // namespace ft::inline baker
