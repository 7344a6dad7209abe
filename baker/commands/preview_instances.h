// Instances as the preview's page holds them: prototypes once, and every frame a place of 16 bits per axis, a rotation
// of four times 16 bits and, where sizes change, a byte of size. 5000 of them for 150 frames are 14 MB in the page.
#pragma once

#include "baker/core/result.h"
#include "baker/record/cache_track.h"
#include "baker/record/report_json.h"

namespace ft::inline baker {

/// frames: how many are shown, from the first. Error: a frame that cannot be read (k_input).
///   vertices     number of instances; low, step, positions: their origins, quantised as vertices of meshes are
///   instances    { ids        u32, of each: the low half of its id, for its colour
///                  turns      i16 x 4, of each in each frame: quaternion x y z w, 32767 is 1
///                  scale      f32 x 3, of each: along the prototype's axes, the largest of all frames
///                  sizes      u8, of each in each frame: 255 is `scale`; not there where sizes never change
///                  of         u16, of each: its prototype
///                  prototypes [ { name, triangles u32, points f32 } ] }
Result<Json> preview_instances(const ManifestSystem& system, const CacheTrack& track, int frames);

}  // namespace ft::inline baker
