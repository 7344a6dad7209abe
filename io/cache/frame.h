// One frame of an output. The conductor fills a FrameData and hands over its view(); a reader fills a FrameData. What
// a shape does not have stays empty (shape.h says what it has).
#pragma once

#include <span>
#include <vector>

#include "baker/core/result.h"
#include "io/cache/shape.h"

namespace ft::inline io {

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
};

struct FrameData {
  std::vector<Vec3f> positions, velocities;
  std::vector<int> face_sizes, face_vertices;
  std::vector<std::uint64_t> ids;
  std::vector<float> widths;
  std::vector<Eigen::Quaternionf> orientations;
  std::vector<Vec3f> angular_velocities, scales;

  CacheFrame view() const {
    return {positions, velocities, face_sizes, face_vertices, ids, widths, orientations, angular_velocities, scales};
  }
};

struct CacheInfo;

/// What is wrong with a cache before its first frame: counts that do not agree, ids that are there twice.
Status check_rest(const CacheInfo& info);

/// What is wrong with a frame: counts, numbers that are not finite, faces, ids. Says where: frame, system, vertex.
/// velocities: whether this cache has them.
Status check_frame(const CacheFrame& frame, const CacheInfo& info, int frame_index, bool velocities);

/// Faces are whole and use vertices that are there; an empty message when they are.
std::string fault_of_faces(std::span<const int> sizes, std::span<const int> corners, std::size_t vertex_count);

}  // namespace ft::inline io
