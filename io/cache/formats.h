// What the registry lists: one writer and one reader per format. Private to this folder; everybody else goes through
// cache.h.
#pragma once

#include "io/cache/cache.h"

namespace ft {

Result<std::unique_ptr<CacheWriter>> open_alembic_writer(const std::filesystem::path& path, const CacheInfo& info,
                                                         int keep_frames);
Result<std::unique_ptr<CacheReader>> open_alembic_reader(const std::filesystem::path& path);

Result<std::unique_ptr<CacheWriter>> open_pc2_writer(const std::filesystem::path& path, const CacheInfo& info,
                                                     int keep_frames);
Result<std::unique_ptr<CacheReader>> open_pc2_reader(const std::filesystem::path& path);

/// One frame as floats, x y z in turn; refused when the count is wrong or a number is not finite in float.
/// what: "position" or "velocity", for the message.
Result<std::vector<float>> frame_floats(std::span<const Vec3> values, std::size_t expected_count, const CacheInfo& info,
                                        int frame_index, std::string_view what);

/// Raw little-endian floats to points; false when one is not finite.
bool points_from_bytes(std::span<const std::byte> raw, std::vector<Vec3f>& points);

/// The error of a writer that is asked to continue what is not there.
Error cannot_continue(const std::filesystem::path& path, std::string why);

}  // namespace ft
