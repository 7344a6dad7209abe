// The list of cache formats. A new one: a file with a writer and a reader, their names in formats.h, a line here; the
// contract tests (tests/io_cache/contract_test.cpp) then run over it.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "io/cache/formats.h"
#include "io/cache/input_file.h"

namespace ft {
namespace {

const std::array k_formats = {
    CacheFormat{"abc", ".abc", "Alembic (Ogawa), mesh with velocities", open_alembic_writer, open_alembic_reader,
                "Ogawa"},
    CacheFormat{"pc2", ".pc2", "PointCache2, points only", open_pc2_writer, open_pc2_reader, "POINTCACHE2"},
};

}  // namespace

std::span<const CacheFormat> cache_formats() {
  return k_formats;
}

const CacheFormat* find_cache_format(std::string_view name) {
  for (const CacheFormat& f : k_formats)
    if (f.name == name) return &f;
  return nullptr;
}

Result<std::unique_ptr<CacheReader>> open_cache(const std::filesystem::path& path) {
  auto file = InputFile::open(path);
  if (!file) return file.error();
  for (const CacheFormat& f : k_formats) {
    std::string start(f.magic.size(), '\0');
    if (file->read_at(0, std::as_writable_bytes(std::span(start))) && start == f.magic) return f.open_reader(path);
  }
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  for (const CacheFormat& f : k_formats)
    if (extension == f.extension) return f.open_reader(path);
  std::string names;
  for (const CacheFormat& f : k_formats) names += (names.empty() ? "" : ", ") + std::string(f.name);
  return input_error("is not a cache", path.string(), "formats that can be read: " + names);
}

Status CacheReader::read_velocities(int, std::vector<Vec3f>&) {
  return input_error("this cache format holds no velocities");
}

Result<std::vector<float>> frame_floats(std::span<const Vec3> values, std::size_t expected_count, const CacheInfo& info,
                                        int frame_index, std::string_view what) {
  const std::string where = "frame " + std::to_string(info.first_frame + frame_index) + ", " + info.system;
  if (values.size() != expected_count)
    return Error{ErrorKind::k_bug,
                 std::to_string(values.size()) + " values for " + std::to_string(expected_count) + " vertices",
                 where,
                 {}};
  std::vector<float> out;
  out.reserve(3 * values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const float x = static_cast<float>(values[i][c]);
      if (!std::isfinite(x))
        return Error{
            ErrorKind::k_diverged, std::string(what) + " is not finite", where + ", vertex " + std::to_string(i), {}};
      out.push_back(x);
    }
  return out;
}

bool points_from_bytes(std::span<const std::byte> raw, std::vector<Vec3f>& points) {
  points.resize(raw.size() / sizeof(Vec3f));
  static_assert(sizeof(Vec3f) == 12);
  if (!points.empty()) std::memcpy(static_cast<void*>(points.data()), raw.data(), points.size() * sizeof(Vec3f));
  return std::all_of(points.begin(), points.end(), [](const Vec3f& p) { return p.allFinite(); });
}

Error cannot_continue(const std::filesystem::path& path, std::string why) {
  return output_error("cannot be continued: " + why, path.string(), "bake again without --resume");
}

}  // namespace ft
