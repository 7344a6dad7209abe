#include "tests/support/cache_samples.h"

namespace ft::test {

CacheSample waving_patch(int columns, int rows, int frame_count) {
  CacheSample s;
  Mesh& mesh = s.info.mesh;
  const auto vertex = [&](int i, int j) { return j * (columns + 1) + i; };
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      mesh.positions.emplace_back(0.25 * i, 1, 0.5 * j);
      mesh.uvs.emplace_back(0.125 * i, 0.25 * j);
    }
  mesh.uvs.emplace_back(0.75, 0.75);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int a = vertex(i, j), b = vertex(i, j + 1), c = vertex(i + 1, j + 1), d = vertex(i + 1, j);
      if (i + 1 == columns && j + 1 == rows) {
        for (const int v : {a, b, c, a, c, d}) mesh.face_vertices.push_back(v);
        mesh.face_sizes.insert(mesh.face_sizes.end(), {3, 3});
      } else {
        for (const int v : {a, b, c, d}) mesh.face_vertices.push_back(v);
        mesh.face_sizes.push_back(4);
      }
    }
  mesh.face_uvs = mesh.face_vertices;
  if (!mesh.face_uvs.empty()) mesh.face_uvs.back() = static_cast<int>(mesh.uvs.size()) - 1;
  mesh.name = s.info.system = "patch";
  s.info.fps = 24;
  s.info.first_frame = 1001;
  s.info.frame_count = frame_count;
  s.info.metadata = {{"inputs", "0123456789abcdef"}, {"units", "m; y=up"}, {"version", "1.0"}};
  for (int f = 0; f < frame_count; ++f) {
    const int t = f == 4 ? 3 : f;  // the fifth frame rests
    std::vector<Vec3> x = mesh.positions, v = x;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const int k = (7 * static_cast<int>(i) + 13 * t) % 32;
      v[i] = Vec3(k, 16 - k, f == 0 ? 0 : t) / 16;
      x[i] += Vec3(0.125 * t, k / 64.0, -k / 128.0);
    }
    s.positions.push_back(std::move(x));
    s.velocities.push_back(std::move(v));
  }
  return s;
}

Status write_frames(CacheWriter& writer, const CacheSample& sample, int end) {
  for (int f = writer.frame_count(); f < end; ++f) {
    const auto i = static_cast<std::size_t>(f);
    Status status = writer.write_frame(sample.positions[i], sample.velocities[i]);
    if (!status) return status;
  }
  return writer.close();
}

Status write_cache(const CacheFormat& format, const std::filesystem::path& path, const CacheSample& sample, int end,
                   int keep_frames) {
  auto writer = format.open_writer(path, sample.info, keep_frames);
  if (!writer) return writer.error();
  return write_frames(**writer, sample, end);
}

}  // namespace ft::test
