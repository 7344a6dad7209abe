#include "tests/bench/bench_case.h"

#include <algorithm>
#include <cstring>

#include "baker/core/file.h"

namespace ft::bench {
namespace {

template <class T>
Result<std::vector<T>> read_values(const std::filesystem::path& path) {
  auto bytes = read_file(path);
  if (!bytes) return bytes.error();
  std::vector<T> values(bytes->size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes->data(), values.size() * sizeof(T));
  return values;
}

Result<std::vector<Triangle>> read_triangles(const std::filesystem::path& path) {
  auto values = read_values<std::int32_t>(path);
  if (!values) return values.error();
  std::vector<Triangle> triangles;
  for (std::size_t k = 0; k + 2 < values->size(); k += 3)
    triangles.push_back({(*values)[k], (*values)[k + 1], (*values)[k + 2]});
  return triangles;
}

Result<std::vector<Vec3f>> read_points(const std::filesystem::path& path) {
  auto values = read_values<float>(path);
  if (!values) return values.error();
  std::vector<Vec3f> points;
  for (std::size_t k = 0; k + 2 < values->size(); k += 3)
    points.emplace_back((*values)[k], (*values)[k + 2], -(*values)[k + 1]);
  return points;
}

std::vector<std::vector<Vec3f>> split(const std::vector<Vec3f>& points, std::size_t vertex_count) {
  std::vector<std::vector<Vec3f>> frames;
  for (std::size_t k = 0; k + vertex_count <= points.size(); k += vertex_count)
    frames.emplace_back(points.begin() + static_cast<std::ptrdiff_t>(k),
                        points.begin() + static_cast<std::ptrdiff_t>(k + vertex_count));
  return frames;
}

template <class T>
Status write_values(const std::filesystem::path& path, const std::vector<T>& values) {
  return write_file_durably(path, std::as_bytes(std::span(values)));
}

Status write_triangles(const std::filesystem::path& path, const std::vector<Triangle>& triangles) {
  std::vector<std::int32_t> values;
  for (const Triangle& t : triangles) values.insert(values.end(), t.begin(), t.end());
  return write_values(path, values);
}

Status write_points(const std::filesystem::path& path, std::span<const std::vector<Vec3f>> frames) {
  std::vector<float> values;
  for (const auto& frame : frames)
    for (const Vec3f& p : frame) values.insert(values.end(), {p.x(), -p.z(), p.y()});
  return write_values(path, values);
}

}  // namespace

Result<Case> read_case(const std::filesystem::path& folder) {
  auto cloth_triangles = read_triangles(folder / "cloth_tris.i32"),
       body_triangles = read_triangles(folder / "body_tris.i32");
  auto rest = read_points(folder / "rest.f32"), cloth = read_points(folder / "cloth.f32"),
       body = read_points(folder / "body.f32");
  for (const Error* error :
       {cloth_triangles ? nullptr : &cloth_triangles.error(), body_triangles ? nullptr : &body_triangles.error(),
        rest ? nullptr : &rest.error(), cloth ? nullptr : &cloth.error(), body ? nullptr : &body.error()})
    if (error) return *error;
  Case data;
  data.cloth_triangles = std::move(*cloth_triangles);
  data.body_triangles = std::move(*body_triangles);
  data.rest = std::move(*rest);
  int body_vertices = 0;
  for (const Triangle& t : data.body_triangles) body_vertices = std::max({body_vertices, t[0] + 1, t[1] + 1, t[2] + 1});
  if (data.rest.empty() || body_vertices == 0)
    return input_error("the case holds no cloth or no body", folder.string());
  data.cloth = split(*cloth, data.rest.size());
  data.body = split(*body, static_cast<std::size_t>(body_vertices));
  data.frame_count = static_cast<int>(std::min(data.cloth.size(), data.body.size()));
  if (data.frame_count == 0) return input_error("the case holds no whole frame", folder.string());
  return data;
}

Status write_case(const std::filesystem::path& folder, const Case& data) {
  if (Status status = make_folders(folder); !status) return status;
  if (Status status = write_triangles(folder / "cloth_tris.i32", data.cloth_triangles); !status) return status;
  if (Status status = write_triangles(folder / "body_tris.i32", data.body_triangles); !status) return status;
  if (Status status = write_points(folder / "rest.f32", {&data.rest, 1}); !status) return status;
  if (Status status = write_points(folder / "cloth.f32", data.cloth); !status) return status;
  if (Status status = write_points(folder / "body.f32", data.body); !status) return status;
  return write_text_durably(folder / "meta.txt", std::to_string(data.rest.size()) + " " +
                                                     std::to_string(data.cloth_triangles.size()) + " " +
                                                     std::to_string(data.body.front().size()) + " " +
                                                     std::to_string(data.body_triangles.size()) + " " +
                                                     std::to_string(data.frame_count) + "\n");
}

}  // namespace ft::bench
