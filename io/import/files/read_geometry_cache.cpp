#include "io/import/files/read_geometry_cache.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>

#include "baker/core/bytes.h"
#include "baker/core/file.h"
#include "io/cache/cache.h"
#include "io/import/repair/stray_vertices.h"
#include "io/reading/lower_extension.h"
#include "io/reading/numbered_files.h"
#include "io/shot/mesh_file.h"

namespace ft::inline io {
namespace {

constexpr float k_max_coordinate = 1e9f;

std::uint32_t swapped(std::uint32_t v) {
  return v >> 24 | (v >> 8 & 0xff00u) | (v << 8 & 0xff0000u) | v << 24;
}

Status check_positions(const GeometryCache& cache, const std::string& name) {
  for (std::size_t i = 0; i < cache.positions.size(); ++i) {
    const Vec3f& p = cache.positions[i];
    if (p.allFinite() && p.cwiseAbs().maxCoeff() <= k_max_coordinate) continue;
    const std::size_t n = static_cast<std::size_t>(cache.vertex_count);
    return input_error("sample " + std::to_string(i / n) + ", vertex " + std::to_string(i % n) +
                           " is not a finite position, or is beyond 1e9",
                       name);
  }
  return {};
}

Status read_pc2(const Bytes& bytes, double fps, const std::string& name, GeometryCache& out) {
  ByteReader in(bytes);
  const auto magic = in.read_span(12);
  if (!in.ok() || std::memcmp(magic.data(), "POINTCACHE2", 12) != 0) return input_error("is not a PC2 file", name);
  const auto version = in.read<std::int32_t>(), points = in.read<std::int32_t>();
  in.read<float>();  // start frame: the shot says where the clip goes
  const auto rate = static_cast<double>(in.read<float>());
  const auto samples = in.read<std::int32_t>();
  if (!in.ok() || version != 1) return input_error("is a PC2 file of an unknown version", name);
  if (points <= 0 || samples <= 0) return input_error("holds no points or no samples", name);
  if (!(rate > 0 && rate < 1e6)) return input_error("has a sample rate that is no number above 0", name);
  const auto need = static_cast<std::uint64_t>(points) * static_cast<std::uint64_t>(samples) * 12;
  if (need > in.remaining())
    return input_error("is cut: " + std::to_string(samples) + " samples of " + std::to_string(points) +
                           " points are announced, " +
                           std::to_string(in.remaining() / (static_cast<std::uint64_t>(points) * 12)) + " are there",
                       name);
  out.vertex_count = points;
  out.positions.resize(static_cast<std::size_t>(points) * static_cast<std::size_t>(samples));
  std::memcpy(static_cast<void*>(out.positions.data()), bytes.data() + in.position(), static_cast<std::size_t>(need));
  for (int s = 0; s < samples; ++s) out.times.push_back(s * rate / (fps > 0 ? fps : 25));
  return {};
}

Status read_mdd(const Bytes& bytes, double fps, const std::string& name, GeometryCache& out) {
  ByteReader in(bytes);
  const auto frames = swapped(in.read<std::uint32_t>()), points = swapped(in.read<std::uint32_t>());
  if (!in.ok() || frames == 0 || points == 0) return input_error("is not an MDD file, or holds no points", name);
  const std::uint64_t need = std::uint64_t{4} * frames + std::uint64_t{12} * frames * points;
  if (points > 1'000'000'000u || need > in.remaining()) return input_error("is cut, or is not an MDD file", name);
  for (std::uint32_t f = 0; f < frames; ++f)
    out.times.push_back(static_cast<double>(std::bit_cast<float>(swapped(in.read<std::uint32_t>()))));
  bool ascending = std::isfinite(out.times.front()) && std::isfinite(out.times.back());
  for (std::size_t f = 1; f < out.times.size(); ++f) ascending = ascending && out.times[f] > out.times[f - 1];
  if (fps > 0 || !ascending) {
    if (fps <= 0) out.notes.push_back("the file's times do not ascend; 25 samples a second assumed");
    for (std::size_t f = 0; f < out.times.size(); ++f) out.times[f] = static_cast<double>(f) / (fps > 0 ? fps : 25);
  }
  const double first = out.times.front();
  for (double& t : out.times) t -= first;
  out.vertex_count = static_cast<int>(points);
  out.positions.resize(std::size_t{frames} * points);
  for (Vec3f& p : out.positions)
    for (int k = 0; k < 3; ++k) p[k] = std::bit_cast<float>(swapped(in.read<std::uint32_t>()));
  return {};
}

Status read_obj_sequence(const std::filesystem::path& file, double fps, Hasher& hasher, GeometryCache& out) {
  auto files = numbered_sequence(file);
  if (!files) return files.error();
  for (std::size_t i = 0; i < files->size(); ++i) {
    const auto& path = (*files)[i];
    const auto bytes = read_file(path);
    if (!bytes) return bytes.error();
    const Hash128 hash = hash_bytes(*bytes);
    hasher.number(hash.low).number(hash.high);
    auto mesh = read_obj(path);
    if (!mesh) return mesh.error();
    if (i == 0) {
      out.vertex_count = mesh->vertex_count();
      if (out.vertex_count == 0) return input_error("holds no vertices", path.string());
    } else if (mesh->vertex_count() != out.vertex_count || mesh->face_vertices != out.mesh.face_vertices) {
      return input_error("has other faces or another number of vertices than " + files->front().filename().string(),
                         path.string(), "all files of a sequence have one topology");
    }
    for (const Vec3& p : mesh->positions) out.positions.push_back(p.cast<float>());
    out.times.push_back(static_cast<double>(i) / (fps > 0 ? fps : 25));
    if (i == 0) out.mesh = std::move(*mesh);
  }
  return {};
}

/// A mesh of an Alembic archive, by our own reader. fps above 0 is in the place of the file's.
Status read_alembic(const std::filesystem::path& file, double fps, GeometryCache& out) {
  auto reader = open_cache(file);
  if (!reader) return reader.error();
  const CacheInfo& info = (*reader)->info();
  if (info.frame_count < 1) return input_error("holds no sample", file.string());
  out.mesh = info.mesh;
  out.vertex_count = info.vertex_count;
  out.positions.reserve(at(info.frame_count) * at(info.vertex_count));
  std::vector<Vec3f> frame;
  for (int i = 0; i < info.frame_count; ++i) {
    if (const Status read = (*reader)->read_frame(i, frame); !read) return read;
    out.positions.insert(out.positions.end(), frame.begin(), frame.end());
    out.times.push_back(i / (fps > 0 ? fps : info.fps));
  }
  return {};
}

}  // namespace

bool knows_its_times(const std::filesystem::path& file) {
  const std::string e = lower_extension(file);
  return e == ".mdd" || e == ".abc";
}

bool is_geometry_cache(const std::filesystem::path& file) {
  const std::string e = lower_extension(file);
  return e == ".pc2" || e == ".mdd" || e == ".obj" || e == ".abc";
}

Result<std::vector<std::filesystem::path>> numbered_sequence(const std::filesystem::path& file) {
  std::string stem = file.stem().string();
  const bool pattern = stem.find('#') != std::string::npos;
  const auto is_number = [&](char c) { return pattern ? c == '#' : std::isdigit(static_cast<unsigned char>(c)) != 0; };
  std::size_t end = pattern ? stem.find_last_of('#') + 1 : stem.size(), begin = end;
  while (begin > 0 && is_number(stem[begin - 1])) --begin;
  if (begin == end) return std::vector{file};
  const std::string prefix = stem.substr(0, begin), suffix = stem.substr(end) + file.extension().string();
  auto numbered = numbered_files(file, prefix, suffix);
  if (!numbered) return numbered.error();
  return std::move(numbered->files);
}

Result<GeometryCache> read_geometry_cache(const std::filesystem::path& file, const std::filesystem::path& topology,
                                          double fps, bool faces_needed) {
  GeometryCache out;
  Hasher hasher;
  const std::string kind = lower_extension(file), name = file.string();
  if (kind == ".obj") {
    out.format = "OBJ";
    if (Status s = read_obj_sequence(file, fps, hasher, out); !s) return s.error();
  } else {
    const auto bytes = read_file(file);
    if (!bytes) return bytes.error();
    const Hash128 hash = hash_bytes(*bytes);
    hasher.number(hash.low).number(hash.high);
    out.format = kind == ".pc2" ? "PC2" : kind == ".mdd" ? "MDD" : "Alembic";
    const Status read = kind == ".pc2"   ? read_pc2(*bytes, fps, name, out)
                        : kind == ".mdd" ? read_mdd(*bytes, fps, name, out)
                                         : read_alembic(file, fps, out);
    if (!read) return read.error();
  }
  if (!topology.empty()) {
    const auto bytes = read_file(topology);
    if (!bytes) return bytes.error();
    const Hash128 hash = hash_bytes(*bytes);
    hasher.number(hash.low).number(hash.high);
    auto mesh = read_obj(topology);
    if (!mesh) return mesh.error();
    if (mesh->vertex_count() != out.vertex_count)
      return input_error("has " + std::to_string(mesh->vertex_count()) + " vertices, " + file.filename().string() +
                             " has " + std::to_string(out.vertex_count),
                         topology.string(), "the topology file has to hold the same vertices in the same order");
    out.mesh = std::move(*mesh);
  }
  if (out.mesh.face_count() == 0 && faces_needed)
    return input_error("holds points but no faces", name,
                       out.format == "OBJ" ? "" : "give an OBJ with the same vertices: topology = \"body.obj\"");
  if (out.mesh.face_count() == 0) {
    if (Status s = check_positions(out, name); !s) return s.error();
  } else {
    auto strays = mend_stray_vertices(out, name);
    if (!strays) return strays.error();
    out.strays = std::move(*strays);
  }
  out.content = hasher.digest();
  return out;
}

}  // namespace ft::inline io
