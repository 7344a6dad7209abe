// Accessors: every component type and width, strides, values put in sparsely, accessors without bytes (all zeros), and
// bufferViews that meshoptimizer has compressed (EXT_meshopt_compression).
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>

#include "io/import/gltf/gltf_file.h"

namespace ft::inline io::gltf {
namespace {

constexpr std::uint64_t k_most_elements = k_max_character_keys;

int width_of(const std::string& type) {
  static const std::pair<const char*, int> all[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                                                    {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
  for (const auto& [word, width] : all)
    if (type == word) return width;
  return 0;
}

std::size_t component_size(std::int64_t component) {
  switch (component) {
    case 5120:
    case 5121: return 1;
    case 5122:
    case 5123: return 2;
    case 5125:
    case 5126: return 4;
    default: return 0;
  }
}

/// Where the components of an element lie: columns of small matrices begin at multiples of four bytes.
struct Layout {
  int width = 0;
  std::size_t size = 0, rows = 0, column = 0;
  std::size_t offset(std::size_t k) const { return k / rows * column + k % rows * size; }
  std::size_t bytes() const { return offset(static_cast<std::size_t>(width) - 1) + size; }
};

Layout layout_of(const Json& accessor, std::int64_t component) {
  const std::string type = text(member(accessor, "type"));
  Layout out;
  out.width = width_of(type), out.size = component_size(component);
  const bool matrix = type.starts_with("MAT");
  out.rows = matrix ? (type == "MAT2" ? 2 : type == "MAT3" ? 3 : 4) : 16;
  out.column = matrix ? (out.rows * out.size + 3) / 4 * 4 : out.rows * out.size;
  return out;
}

template <class T>
double scaled(T value, bool fraction) {
  if constexpr (std::is_floating_point_v<T>) {
    return static_cast<double>(value);
  } else {
    const double v = static_cast<double>(value);
    return fraction ? std::max(v / static_cast<double>(std::numeric_limits<T>::max()), -1.0) : v;
  }
}

template <class T>
void gather(std::span<const std::byte> bytes, std::size_t step, const Layout& layout, bool fraction,
            std::span<double> out) {
  const auto width = static_cast<std::size_t>(layout.width);
  const std::byte* at = bytes.data();
  for (std::size_t i = 0; i < out.size(); at += step)
    for (std::size_t k = 0; k < width; ++k, ++i) {
      T value;
      std::memcpy(&value, at + layout.offset(k), sizeof value);
      out[i] = scaled(value, fraction);
    }
}

void gather(std::int64_t component, std::span<const std::byte> bytes, std::size_t step, const Layout& layout,
            bool fraction, std::span<double> out) {
  if (out.empty()) return;
  switch (component) {
    case 5120: return gather<std::int8_t>(bytes, step, layout, fraction, out);
    case 5121: return gather<std::uint8_t>(bytes, step, layout, fraction, out);
    case 5122: return gather<std::int16_t>(bytes, step, layout, fraction, out);
    case 5123: return gather<std::uint16_t>(bytes, step, layout, fraction, out);
    case 5125: return gather<std::uint32_t>(bytes, step, layout, fraction, out);
    default: return gather<float>(bytes, step, layout, fraction, out);
  }
}

bool fractions(const Json& accessor, Integers integers) {
  if (integers != Integers::k_as_flagged) return integers == Integers::k_fractions;
  const Json& flag = member(accessor, "normalized");
  return flag.is_boolean() && flag.get<bool>();
}

/// The bytes of `count` elements from `offset` in a view; refused when they leave it.
Result<std::span<const std::byte>> elements(const ViewBytes& view, std::int64_t offset, std::size_t step,
                                            std::size_t size, std::uint64_t count, const std::string& name) {
  const std::uint64_t room = view.bytes.size();
  if (offset < 0 || static_cast<std::uint64_t>(offset) > room)
    return input_error(name + " begins outside of its bufferView");
  const std::uint64_t left = room - static_cast<std::uint64_t>(offset);
  if (count > 0 && (size > left || (count - 1) > (left - size) / std::max<std::size_t>(step, 1)))
    return input_error(name + " leaves its bufferView: " + std::to_string(count) + " elements of " +
                       std::to_string(step) + " bytes, and " + std::to_string(left) + " bytes are there");
  return view.bytes.subspan(static_cast<std::size_t>(offset));
}

}  // namespace

std::int64_t GltfFile::count(std::int64_t accessor) const {
  return std::max<std::int64_t>(integer(member(element(member(json_, "accessors"), accessor), "count"), 0), 0);
}

Result<AccessorValues> GltfFile::read(std::int64_t index, Integers integers) {
  const Json& about = element(member(json_, "accessors"), index);
  const std::string name = named(json_, "accessors", index);
  if (!about.is_object()) return input_error(name + " is not there");
  AccessorValues out;
  Status read = read_values(about, name, integers, out);
  if (read && about.contains("sparse")) read = put_sparse(about, name, integers, out);
  if (!read) return read.error();
  return out;
}

Status GltfFile::read_values(const Json& about, const std::string& name, Integers integers, AccessorValues& out) {
  const std::int64_t component = integer(member(about, "componentType"), 0),
                     count = integer(member(about, "count"), -1);
  const Layout layout = layout_of(about, component);
  if (layout.width == 0 || layout.size == 0)
    return input_error(name + " has the unknown kind " + text(member(about, "type")) + " of " +
                       std::to_string(component));
  if (count < 0 || static_cast<std::uint64_t>(count) > k_most_elements)
    return input_error(name + " has no count, or one beyond 200 million");
  out.width = layout.width;
  const std::size_t total = static_cast<std::size_t>(count) * static_cast<std::size_t>(layout.width);
  if (!about.contains("bufferView")) {
    if (static_cast<std::uint64_t>(count) > most_zero_elements())
      return input_error(name + " has " + std::to_string(count) +
                         " elements and no bytes: more than the file can have a use for");
    out.values.assign(total, 0.0);
    return {};
  }
  auto view = this->view(integer(member(about, "bufferView"), -1));
  if (!view) return input_error(name + ": " + view.error().what);
  const std::size_t step = view->stride == 0 ? layout.bytes() : view->stride;
  auto bytes = elements(*view, integer(member(about, "byteOffset"), 0), step, layout.bytes(),
                        static_cast<std::uint64_t>(count), name);
  if (!bytes) return bytes.error();
  out.values.resize(total);
  gather(component, *bytes, step, layout, fractions(about, integers), out.values);
  return {};
}

Status GltfFile::put_sparse(const Json& about, const std::string& accessor, Integers integers, AccessorValues& out) {
  const std::string name = accessor + ", sparse";
  const Json& sparse = member(about, "sparse");
  const Json &indices = member(sparse, "indices"), &values = member(sparse, "values");
  const std::int64_t count = integer(member(sparse, "count"), -1);
  if (count < 0 || static_cast<std::size_t>(count) > out.count())
    return input_error(name + ": puts in " + std::to_string(count) + " of " + std::to_string(out.count()) + " values");
  const std::int64_t index_kind = integer(member(indices, "componentType"), 0),
                     component = integer(member(about, "componentType"), 0);
  const Layout index_layout{1, component_size(index_kind), 1, component_size(index_kind)};
  const Layout layout = layout_of(about, component);
  if (index_kind != 5121 && index_kind != 5123 && index_kind != 5125)
    return input_error(name + ": its indices are no unsigned integers");
  auto index_view = view(integer(member(indices, "bufferView"), -1));
  if (!index_view) return input_error(name + ": " + index_view.error().what);
  auto index_bytes = elements(*index_view, integer(member(indices, "byteOffset"), 0), index_layout.size,
                              index_layout.size, static_cast<std::uint64_t>(count), name);
  if (!index_bytes) return index_bytes.error();
  auto value_view = view(integer(member(values, "bufferView"), -1));
  if (!value_view) return input_error(name + ": " + value_view.error().what);
  auto value_bytes = elements(*value_view, integer(member(values, "byteOffset"), 0), layout.bytes(), layout.bytes(),
                              static_cast<std::uint64_t>(count), name);
  if (!value_bytes) return value_bytes.error();
  const auto width = static_cast<std::size_t>(out.width), rows = static_cast<std::size_t>(count);
  std::vector<double> at(rows), put(rows * width);
  gather(index_kind, *index_bytes, index_layout.size, index_layout, false, at);
  gather(component, *value_bytes, layout.bytes(), layout, fractions(about, integers), put);
  for (std::size_t i = 0; i < rows; ++i) {
    if (at[i] >= static_cast<double>(out.count()))
      return input_error(name + ": index " + std::to_string(static_cast<std::uint64_t>(at[i])) + " of " +
                         std::to_string(out.count()) + " values");
    std::copy_n(put.begin() + static_cast<std::ptrdiff_t>(i * width), width,
                out.values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(at[i]) * width));
  }
  return {};
}

Result<std::vector<double>> GltfFile::accessor(std::int64_t index, int& width) {
  auto out = read(index, Integers::k_fractions);
  if (!out) return out.error();
  width = out->width;
  return std::move(out->values);
}

Result<ViewBytes> GltfFile::view(std::int64_t index) {
  const Json& about = element(member(json_, "bufferViews"), index);
  const std::string name = "bufferViews[" + std::to_string(index) + "]";
  if (!about.is_object()) return input_error(name + " is not there");
  const std::int64_t stride = integer(member(about, "byteStride"), 0);
  if (stride < 0 || stride > 4096) return input_error(name + " has a byteStride of " + std::to_string(stride));
  for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    const Json& packed = member(member(about, "extensions"), extension);
    if (!packed.is_object()) continue;
    auto found = decompressed_.find(index);
    if (found == decompressed_.end()) {
      auto bytes = decompress(packed, name + ", " + extension);
      if (!bytes) return bytes.error();
      found = decompressed_.emplace(index, std::move(*bytes)).first;
    }
    return ViewBytes{found->second, static_cast<std::size_t>(stride)};
  }
  auto opened = buffer(integer(member(about, "buffer"), -1));
  if (!opened) return input_error(name + ": " + opened.error().what);
  const std::int64_t offset = integer(member(about, "byteOffset"), 0),
                     length = integer(member(about, "byteLength"), -1);
  const std::uint64_t room = (*opened)->size();
  if (offset < 0 || length < 0 || static_cast<std::uint64_t>(offset) > room ||
      static_cast<std::uint64_t>(length) > room - static_cast<std::uint64_t>(offset))
    return input_error(name + " leaves its buffer: " + std::to_string(length) + " bytes from " +
                       std::to_string(offset) + ", and the buffer has " + std::to_string(room));
  const std::span<const std::byte> all = **opened;
  return ViewBytes{all.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(length)),
                   static_cast<std::size_t>(stride)};
}

Result<Bytes> GltfFile::decompress(const Json& extension, const std::string& name) {
  auto opened = buffer(integer(member(extension, "buffer"), -1));
  if (!opened) return input_error(name + ": " + opened.error().what);
  const std::int64_t offset = integer(member(extension, "byteOffset"), 0),
                     length = integer(member(extension, "byteLength"), -1),
                     stride = integer(member(extension, "byteStride"), 0),
                     count = integer(member(extension, "count"), -1);
  const std::uint64_t room = (*opened)->size();
  if (offset < 0 || length < 0 || static_cast<std::uint64_t>(offset) > room ||
      static_cast<std::uint64_t>(length) > room - static_cast<std::uint64_t>(offset))
    return input_error(name + " leaves its buffer");
  const auto n = static_cast<std::size_t>(count), step = static_cast<std::size_t>(stride);
  const auto size = static_cast<std::size_t>(length);
  const std::string mode = text(member(extension, "mode")), filter = text(member(extension, "filter"));
  const bool vertices = mode == "ATTRIBUTES", triangles = mode == "TRIANGLES";
  if (!vertices && !triangles && mode != "INDICES") return input_error(name + " has the unknown mode \"" + mode + "\"");
  const auto* packed = reinterpret_cast<const unsigned char*>((*opened)->data()) + offset;
  if (vertices && size > 0 && (packed[0] & 15) > 0)
    return input_error(name + " is of version " + std::to_string(packed[0] & 15) + " of its codec, which is not read",
                       "", "export it with EXT_meshopt_compression, or uncompressed");
  // The codec spends at least two bits on sixteen bytes of vertices, and a byte on a triangle or on a single index.
  const bool fits = vertices
                        ? stride > 0 && stride <= 256 && stride % 4 == 0 && count >= 0 && n <= (64 * size + 4096) / step
                        : (stride == 2 || stride == 4) && count >= 0 && n <= (triangles ? 3 * size : size) &&
                              (!triangles || count % 3 == 0);
  if (!fits)
    return input_error(name + " says " + std::to_string(count) + " elements of " + std::to_string(stride) +
                       " bytes, which cannot come out of " + std::to_string(length));
  Bytes out(n * step);
  const int failed = vertices    ? meshopt_decodeVertexBuffer(out.data(), n, step, packed, size)
                     : triangles ? meshopt_decodeIndexBuffer(out.data(), n, step, packed, size)
                                 : meshopt_decodeIndexSequence(out.data(), n, step, packed, size);
  if (failed != 0)
    return input_error(name + " cannot be decompressed (" + std::to_string(failed) +
                       "): it is damaged, or of a later version");
  if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8))
    meshopt_decodeFilterOct(out.data(), n, step);
  else if (filter == "QUATERNION" && stride == 8)
    meshopt_decodeFilterQuat(out.data(), n, step);
  else if (filter == "EXPONENTIAL" && stride % 4 == 0)
    meshopt_decodeFilterExp(out.data(), n, step);
  else if (!filter.empty() && filter != "NONE")
    return input_error(name + " has the filter \"" + filter + "\" on elements of " + std::to_string(stride) +
                       " bytes, which cannot be undone");
  return out;
}

}  // namespace ft::inline io::gltf
