// Small caches for tests: a patch of quads and triangles that moves, and helpers to write it whole or in part.
#pragma once

#include <filesystem>
#include <vector>

#include "io/cache/cache.h"

namespace ft::test {

/// Frames of a cache in memory.
struct CacheSample {
  CacheInfo info;
  std::vector<std::vector<Vec3>> positions, velocities;  ///< per frame
};

/// A waving patch of columns x rows quads (the last one split into two triangles), uvs with a seam, quarter-exact
/// coordinates, so that float holds them exactly. Some frames repeat the one before, as a resting cloth does.
CacheSample waving_patch(int columns, int rows, int frame_count);

/// Writes frames [writer->frame_count(), end) and closes.
Status write_frames(CacheWriter& writer, const CacheSample& sample, int end);
/// Opens, writes the first end frames (of info.frame_count announced ones), closes.
Status write_cache(const CacheFormat& format, const std::filesystem::path& path, const CacheSample& sample, int end,
                   int keep_frames = 0);

}  // namespace ft::test
