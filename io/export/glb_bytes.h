// The bytes of a .glb: data put behind what is there, named by views and accessors, and the chunks around it.
#pragma once

#include <span>

#include "baker/core/bytes.h"
#include "baker/core/result.h"
#include "io/import/gltf/gltf_file.h"

namespace ft::inline io {

/// Where the data begins in bin: a multiple of 16, which suits every kind of component.
std::size_t append_aligned(Bytes& bin, std::span<const std::byte> data);
/// Index of a new bufferView of the data.
std::size_t add_view(gltf::Json& json, Bytes& bin, std::span<const std::byte> data);
/// Index of a new accessor of 32-bit floats, width (1, 3, 4 or 16) per element; with least and largest value where
/// asked.
std::size_t add_accessor(gltf::Json& json, Bytes& bin, std::span<const double> values, int width, bool with_range);
/// The file: JSON, BIN and further chunks as they are. Sets the length of the first buffer. Refuses more than 4 GiB.
Result<Bytes> glb_bytes(gltf::Json& json, const Bytes& bin, std::span<const std::byte> further_chunks = {});

}  // namespace ft::inline io
