// Small .vdb files of a given field, written by OpenVDB itself.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "baker/core/types.h"

namespace ft::test {

using Field = std::function<Vec3(const Vec3&)>;

struct SampleGrid {
  enum Kind { k_vec3s, k_vec3d, k_float, k_double, k_int };
  std::string name = "vel";
  Kind kind = k_vec3s;
  int component = 0;  ///< of numbers: which of the field's
  Field field;        ///< at a place in the file's units and axes
  std::array<int, 3> lowest{-3, 2, 10}, count{5, 4, 6};
  Eigen::Affine3d to_world = Eigen::Affine3d(Eigen::Translation3d(1, 2, 3) * Eigen::Scaling(0.1));
  bool staggered = false;  ///< of vectors: components half a voxel lower along their axes, and said so
  bool half = false, frustum = false, local = false;
  bool far_voxel = false;  ///< one more, a million voxels away
};

struct SampleFile {
  std::vector<SampleGrid> grids;
  bool blosc = true;
  bool seekable = true;    ///< with positions of grids, as files have; else as a pipe
  bool instanced = false;  ///< the second grid has its tree from the first
};

void write_vdb(const std::filesystem::path& path, const SampleFile& file);

}  // namespace ft::test
