// What the registry lists: one writer and one reader per format. Private to this folder; everybody else goes through
// cache.h.
#pragma once

#include "io/cache/cache.h"

namespace ft::inline io {

Result<std::unique_ptr<CacheWriter>> open_alembic_writer(const std::filesystem::path& path, const CacheInfo& info,
                                                         int keep_frames);
Result<std::unique_ptr<CacheReader>> open_alembic_reader(const std::filesystem::path& path);
Status alembic_accepts(const FrameContent& content);
std::uint64_t alembic_bytes_per_frame(const FrameContent& content, const FrameCounts& counts);

Result<std::unique_ptr<CacheWriter>> open_pc2_writer(const std::filesystem::path& path, const CacheInfo& info,
                                                     int keep_frames);
Result<std::unique_ptr<CacheReader>> open_pc2_reader(const std::filesystem::path& path);
Status pc2_accepts(const FrameContent& content);
std::uint64_t pc2_bytes_per_frame(const FrameContent& content, const FrameCounts& counts);

/// Elements of a frame where their number is constant: vertices at rest, instances.
int constant_element_count(const CacheInfo& info);

/// Raw little-endian floats to points; false when one is not finite.
bool points_from_bytes(std::span<const std::byte> raw, std::vector<Vec3f>& points);

/// The error of a writer that is asked to continue what is not there.
Error cannot_continue(const std::filesystem::path& path, std::string why);

}  // namespace ft::inline io
