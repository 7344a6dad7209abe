// What a reader needs of an archive of any origin: its first polygon mesh, else its first curves, else its first
// points, checked so that nothing in it can be out of range later. Points that have an orientation each are instances.
#pragma once

#include <array>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

#include "io/cache/alembic_transform.h"
#include "io/cache/alembic_tree.h"

namespace ft::inline io::alembic {

/// Corners of every face in reverse order; applied twice it changes nothing.
void reverse_faces(std::span<const int> face_sizes, std::vector<int>& corners);

struct ShapeView {
  CacheInfo info;  ///< mesh.positions: the first frame, or the rest positions of a cache without frames, in the world
  std::array<Property, k_channel_count> channels;  ///< no samples where there are none
  TransformChain transforms;                       ///< of the objects around
  TimeSampling times;                              ///< of positions
};

Result<ShapeView> find_shape(const InputFile& file, const Archive& archive);

/// The parts of find_shape(): each reads what is particular to a shape from the compound .geom.
Status view_mesh(const InputFile& file, const Property& geom, ShapeView& view);
Status view_curves(const InputFile& file, const Property& geom, ShapeView& view);
Status view_points(const InputFile& file, const Property& geom, ShapeView& view);

/// An array of this type with at least one sample.
bool is_array(const Property* p, Pod pod, int extent);
/// Takes a property over as a channel: an array of this type with as many samples as there are positions.
bool adopt_channel(ShapeView& view, Channel channel, const Property* p, Pod pod, int extent);

template <class T>
Result<std::vector<T>> values_of(const InputFile& file, const Sample& sample) {
  const auto raw = read_values(file, sample);
  if (!raw) return raw.error();
  std::vector<T> out(raw.value().size() / sizeof(T));
  if (!out.empty()) std::memcpy(static_cast<void*>(out.data()), raw.value().data(), out.size() * sizeof(T));
  return out;
}

/// Zero-terminated texts in turn.
Result<std::vector<std::string>> strings_of(const InputFile& file, const Sample& sample);

}  // namespace ft::inline io::alembic
