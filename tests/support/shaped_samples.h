// Small caches of every shape for tests. Coordinates are exact in float; some frames repeat the one before; where the
// number may change, some frames are empty.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/cache/cache.h"

namespace ft::test {

struct ShapedSample {
  std::string name;
  CacheInfo info;
  std::vector<FrameData> frames;
};

ShapedSample sheet(int frame_count);    ///< a mesh of constant topology
ShapedSample pool(int frame_count);     ///< the same with scalars of its vertices
ShapedSample splash(int frame_count);   ///< a mesh whose faces change, first frame empty
ShapedSample strands(int frame_count);  ///< curves with ids, widths for each vertex, attributes of all kinds
ShapedSample spray(int frame_count);    ///< points that are born and die
ShapedSample leaves(int frame_count);   ///< instances of two prototypes
std::vector<ShapedSample> all_shapes(int frame_count);

/// Opens, writes the frames [keep_frames, end), closes.
Status write_shaped(const CacheFormat& format, const std::filesystem::path& path, const ShapedSample& sample, int end,
                    int keep_frames = 0);

}  // namespace ft::test
