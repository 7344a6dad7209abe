// A benchmark case, as Blender's scripts write it and the judge reads it: meta.txt, cloth_tris.i32, body_tris.i32,
// rest.f32, cloth.f32 [frames][vertices][3], body.f32 [frames][vertices][3]. Coordinates are Blender's, Z up; ours are
// Y up.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "baker/core/result.h"
#include "baker/core/types.h"

namespace ft::bench {

struct Case {
  int frame_count = 0;
  std::vector<Triangle> cloth_triangles, body_triangles;
  std::vector<Vec3f> rest;                      ///< Y up, m
  std::vector<std::vector<Vec3f>> cloth, body;  ///< per frame, Y up, m
};

/// The frames are those of body.f32 and cloth.f32 that are whole, meta.txt or not (a case that ran out of its budget
/// has none).
Result<Case> read_case(const std::filesystem::path& folder);
Status write_case(const std::filesystem::path& folder, const Case& data);

}  // namespace ft::bench
