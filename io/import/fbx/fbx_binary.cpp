// Binary FBX: a header of 27 bytes, then nodes (end offset, property count, property bytes, name, properties, children)
// up to an empty one. From version 7.5 on the three numbers have 64 bits. Arrays may be zlib streams.
#include <zlib.h>

#include <limits>

#include "io/import/fbx/fbx_tree.h"

namespace ft::inline io {
namespace {

/// zlib cannot pack better than this; an array that claims more is a lie.
constexpr std::uint64_t k_best_packing = 1040;

class BinaryParser {
 public:
  BinaryParser(std::span<const std::byte> data, int version) : data_(data), in_(data), wide_(version >= 7500) {
    in_.seek(27);
  }

  Status read_children(FbxNode& parent, std::uint64_t end, int depth) {
    while (in_.position() < end) {
      const std::uint64_t start = in_.position();
      const std::uint64_t node_end = word(), property_count = word(), property_bytes = word();
      const auto name_length = in_.read<std::uint8_t>();
      if (!in_.ok()) return cut(parent);
      if (node_end == 0 && name_length == 0) return {};
      const auto name = in_.read_span(name_length);
      FbxNode node;
      node.name.assign(reinterpret_cast<const char*>(name.data()), name.size());
      if (!in_.ok() || property_bytes > in_.remaining() || node_end > end) return cut(node);
      if (node_end != 0 && node_end < in_.position() + property_bytes)
        return input_error("is damaged: node \"" + node.name + "\" at byte " + std::to_string(start) +
                               " ends before its properties do",
                           "", "copy or export it again");
      if (depth >= k_max_fbx_depth)
        return input_error("is damaged: its nodes are more than " + std::to_string(k_max_fbx_depth) + " deep", "",
                           "copy or export it again");
      if (node_end != 0 && is_fbx_decoration(node.name)) {
        in_.seek(node_end);
        continue;
      }
      const std::uint64_t properties_end = in_.position() + property_bytes;
      if (property_count > property_bytes)  // each takes two bytes at least
        return input_error("is damaged: node \"" + node.name + "\" has more properties than bytes", "",
                           "copy or export it again");
      for (std::uint64_t k = 0; k < property_count; ++k)
        if (Status s = read_property(node, properties_end); !s) return s;
      in_.seek(properties_end);
      if (Status s = read_children(node, node_end == 0 ? end : node_end, depth + 1); !s) return s;
      if (node_end != 0) in_.seek(node_end);
      parent.children.push_back(std::move(node));
    }
    // Inside a node the end offset is enough; the file itself ends with an empty node.
    return depth == 0 ? cut(parent) : Status{};
  }

 private:
  std::uint64_t word() { return wide_ ? in_.read<std::uint64_t>() : in_.read<std::uint32_t>(); }

  static Error cut(const FbxNode& node) {
    return input_error("is cut or damaged: " +
                           (node.name.empty() ? "its end" : "the end of node \"" + node.name + "\"") + " is missing",
                       "", "copy or export it again");
  }

  Status read_property(FbxNode& node, std::uint64_t end) {
    const char type = in_.read<char>();
    switch (type) {
      case 'C':
      case 'B':
      case 'Z': node.properties.emplace_back(std::int64_t{in_.read<std::uint8_t>()}); break;
      case 'Y': node.properties.emplace_back(std::int64_t{in_.read<std::int16_t>()}); break;
      case 'I': node.properties.emplace_back(std::int64_t{in_.read<std::int32_t>()}); break;
      case 'L': node.properties.emplace_back(in_.read<std::int64_t>()); break;
      case 'F': node.properties.emplace_back(static_cast<double>(in_.read<float>())); break;
      case 'D': node.properties.emplace_back(in_.read<double>()); break;
      case 'S':
      case 'R': node.properties.emplace_back(in_.read_string()); break;
      case 'c':
      case 'b': return read_array<std::uint8_t>(node, end);
      case 'i': return read_array<std::int32_t>(node, end);
      case 'l': return read_array<std::int64_t>(node, end);
      case 'f': return read_array<float>(node, end);
      case 'd': return read_array<double>(node, end);
      default:
        return input_error("is damaged: node \"" + node.name + "\" has a property of an unknown kind (" +
                               std::to_string(static_cast<int>(type)) + ")",
                           "", "copy or export it again");
    }
    return in_.ok() && in_.position() <= end ? Status{} : Status{cut(node)};
  }

  template <class T>
  Status read_array(FbxNode& node, std::uint64_t end) {
    const auto count = in_.read<std::uint32_t>(), encoding = in_.read<std::uint32_t>(),
               packed = in_.read<std::uint32_t>();
    const auto bytes = in_.read_span(packed);
    if (!in_.ok() || in_.position() > end) return cut(node);
    const std::uint64_t size = std::uint64_t{count} * sizeof(T);
    const bool lie = encoding == 0 ? size != packed : size > k_best_packing * (std::uint64_t{packed} + 1);
    if (encoding > 1 || lie)
      return input_error("is damaged: the array of node \"" + node.name + "\" does not have the size that it claims",
                         "", "copy or export it again");
    array_bytes_ += size;
    if (array_bytes_ > k_max_fbx_array_bytes) return input_error("has more than 2 GB of arrays");
    std::vector<T> values(count);
    if (encoding == 0) {
      if (size > 0) std::memcpy(values.data(), bytes.data(), size);
    } else if (!inflate_all(bytes, values.data(), size)) {
      return input_error("is damaged: the packed array of node \"" + node.name + "\" cannot be unpacked", "",
                         "copy or export it again");
    }
    node.properties.emplace_back(std::move(values));
    return {};
  }

  static bool inflate_all(std::span<const std::byte> packed, void* out, std::uint64_t size) {
    uLongf unpacked = size;
    Bytef nothing = 0;  // zlib wants a place to write to
    const int code = uncompress(size > 0 ? static_cast<Bytef*>(out) : &nothing, &unpacked,
                                reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size()));
    return code == Z_OK && unpacked == size;
  }

  std::span<const std::byte> data_;
  ByteReader in_;
  bool wide_;
  std::uint64_t array_bytes_ = 0;
};

}  // namespace

Result<FbxTree> read_fbx_binary(std::span<const std::byte> data) {
  if (data.size() < 27) return input_error("is cut: it ends within its header", "", "copy or export it again");
  ByteReader head(data);
  head.seek(22);
  const bool big_endian = head.read<std::uint8_t>() != 0;
  const auto version = head.read<std::uint32_t>();
  if (big_endian)
    return input_error("is a big-endian FBX file, a format that is not read", "",
                       "export it as FBX 7.4 (2014/2015) binary");
  if (version < 7000) return old_fbx_error(static_cast<int>(version));
  if (version >= 10000) return input_error("is damaged: its version is " + std::to_string(version));
  FbxTree tree;
  tree.version = static_cast<int>(version);
  BinaryParser parser(data, tree.version);
  if (Status s = parser.read_children(tree.root, data.size(), 0); !s) return s.error();
  return tree;
}

}  // namespace ft::inline io
