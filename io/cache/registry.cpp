// The list of cache formats. A new one: a file with a writer and a reader, their names in formats.h, a line here; the
// contract tests (tests/io_cache/contract_test.cpp) then run over it.
#include <algorithm>
#include <array>
#include <cctype>

#include "io/cache/formats.h"
#include "io/cache/input_file.h"

namespace ft::inline io {
namespace {

std::vector<std::string> nothing(const FrameContent&) {
  return {};
}
std::vector<std::string> all_scalars(const FrameContent& content) {
  return content.scalars;
}

const std::array k_formats = {
    CacheFormat{"abc", ".abc", "Alembic (Ogawa): meshes, curves, points, instances, with velocities", alembic_accepts,
                alembic_bytes_per_frame, open_alembic_writer, open_alembic_reader, nothing, "Ogawa"},
    CacheFormat{"pc2", ".pc2", "PointCache2: positions only", pc2_accepts, pc2_bytes_per_frame, open_pc2_writer,
                open_pc2_reader, all_scalars, "POINTCACHE2"},
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
  auto reader = open_cache_of_any_shape(path);
  if (!reader) return reader;
  const FrameContent& content = (*reader)->info().content;
  if (content.shape != OutputShape::k_mesh)
    return input_error("holds " + std::string(shape_name(content.shape)) + " and no polygon mesh", path.string());
  if (content.changes) return input_error("has a mesh whose topology changes", path.string());
  return reader;
}

Result<std::unique_ptr<CacheReader>> open_cache_of_any_shape(const std::filesystem::path& path) {
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

Status CacheWriter::write_frame(std::span<const Vec3> positions, std::span<const Vec3> velocities,
                                std::span<const std::vector<float>> scalars) {
  FrameData frame;
  for (const Vec3& p : positions) frame.positions.push_back(p.cast<float>());
  for (const Vec3& v : velocities) frame.velocities.push_back(v.cast<float>());
  CacheFrame view = frame.view();
  view.scalars = scalars;
  return write_frame(view);
}

Status CacheReader::read_velocities(int, std::vector<Vec3f>&) {
  return input_error("this cache format holds no velocities");
}

Status CacheReader::read(int index, FrameData& frame) {
  frame = {};
  const Status status = read_frame(index, frame.positions);
  return status && info().has_velocity ? read_velocities(index, frame.velocities) : status;
}

int constant_element_count(const CacheInfo& info) {
  switch (info.content.shape) {
    case OutputShape::k_curves: return static_cast<int>(info.curves.rest.size());
    case OutputShape::k_instances: return static_cast<int>(info.instances.ids.size());
    default: return info.mesh.vertex_count();
  }
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

}  // namespace ft::inline io
