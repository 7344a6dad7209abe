// One frame of an output. A solver or a reader fills a FrameData; what writes takes its view(). What a shape does not
// have stays empty (output_shape.h says what it has).
#pragma once

#include <span>
#include <vector>

#include "baker/core/output_shape.h"

namespace ft {

struct CacheFrame {
  std::span<const Vec3f> positions;                  ///< m
  std::span<const Vec3f> velocities;                 ///< m/s; in every frame or in none
  std::span<const int> face_sizes;                   ///< corners of each face, where faces change
  std::span<const int> face_vertices;                ///< counter-clockwise, where faces change
  std::span<const std::uint64_t> ids;                ///< points: who is who, none twice
  std::span<const float> widths;                     ///< points: diameters [m]
  std::span<const Eigen::Quaternionf> orientations;  ///< instances: of length 1, prototype to world
  std::span<const Vec3f> angular_velocities;         ///< instances: in the world [rad/s]
  std::span<const Vec3f> scales;                     ///< instances: along the axes of the prototype
  std::span<const std::vector<float>> scalars{};     ///< meshes: of vertices, a list for each name of the content
};

struct FrameData {
  std::vector<Vec3f> positions, velocities;
  std::vector<int> face_sizes, face_vertices;
  std::vector<std::uint64_t> ids;
  std::vector<float> widths;
  std::vector<Eigen::Quaternionf> orientations;
  std::vector<Vec3f> angular_velocities, scales;
  std::vector<std::vector<float>> scalars;

  CacheFrame view() const {
    return {positions, velocities,   face_sizes,         face_vertices, ids,
            widths,    orientations, angular_velocities, scales,        scalars};
  }
};

/// Whether all its numbers are finite.
bool all_finite(const FrameData& frame);

}  // namespace ft
