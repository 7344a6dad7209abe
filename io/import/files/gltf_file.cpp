#include "io/import/files/gltf_file.h"

#include <cmath>

#include "baker/core/file.h"

namespace ft::inline io::gltf {
namespace {

Bytes decode_base64(std::string_view encoded) {
  Bytes out;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : encoded) {
    int value = -1;
    if (c >= 'A' && c <= 'Z')
      value = c - 'A';
    else if (c >= 'a' && c <= 'z')
      value = c - 'a' + 26;
    else if (c >= '0' && c <= '9')
      value = c - '0' + 52;
    else if (c == '+' || c == '-')
      value = 62;
    else if (c == '/' || c == '_')
      value = 63;
    if (value < 0) continue;
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    if ((count += 6) >= 8) out.push_back(static_cast<std::byte>(bits >> (count -= 8) & 255));
  }
  return out;
}

double component_value(const std::byte* at, std::int64_t component) {
  const auto get = [&]<class T>(T value) {
    std::memcpy(&value, at, sizeof value);
    return static_cast<double>(value);
  };
  switch (component) {
    case 5120: return std::max(get(std::int8_t{}) / 127.0, -1.0);
    case 5121: return get(std::uint8_t{}) / 255.0;
    case 5122: return std::max(get(std::int16_t{}) / 32767.0, -1.0);
    case 5123: return get(std::uint16_t{}) / 65535.0;
    default: return get(0.0f);
  }
}

}  // namespace

/// Member of an object, or a null value.
const Json& member(const Json& object, const char* key) {
  static const Json none;
  if (!object.is_object()) return none;
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}
const Json& element(const Json& array, std::int64_t index) {
  static const Json none;
  if (!array.is_array() || index < 0 || static_cast<std::size_t>(index) >= array.size()) return none;
  return array[static_cast<std::size_t>(index)];
}
std::int64_t integer(const Json& value, std::int64_t otherwise) {
  if (value.is_number_unsigned()) {
    const auto v = value.get<std::uint64_t>();
    return v < (std::uint64_t{1} << 53) ? static_cast<std::int64_t>(v) : otherwise;
  }
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (value.is_number_float()) {
    const double v = value.get<double>();
    if (std::isfinite(v) && std::abs(v) < 0x1p53) return static_cast<std::int64_t>(v);
  }
  return otherwise;
}
std::string text(const Json& value) {
  return value.is_string() ? value.get<std::string>() : std::string();
}
std::vector<double> numbers(const Json& array) {
  std::vector<double> out;
  if (array.is_array())
    for (const Json& v : array) out.push_back(v.is_number() ? v.get<double>() : std::nan(""));
  return out;
}

std::string decode_percent(const std::string& uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const auto digit = [&](std::size_t k) {
      const char c = k < uri.size() ? uri[k] : '?';
      return c >= '0' && c <= '9'   ? c - '0'
             : c >= 'a' && c <= 'f' ? c - 'a' + 10
             : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                    : -1;
    };
    if (uri[i] == '%' && digit(i + 1) >= 0 && digit(i + 2) >= 0)
      out.push_back(static_cast<char>(digit(i + 1) * 16 + digit(i + 2))), i += 2;
    else
      out.push_back(uri[i]);
  }
  return out;
}

Result<GltfFile> GltfFile::open(const std::filesystem::path& path) {
  auto data = read_file(path);
  if (!data) return data.error();
  GltfFile file;
  file.folder_ = path.parent_path();
  ByteReader in(*data);
  std::span<const std::byte> source = *data;
  if (in.read<std::uint32_t>() == 0x46546c67u) {  // "glTF"
    in.read<std::uint32_t>(), in.read<std::uint32_t>();
    source = {};
    for (bool first = true; in.ok() && in.remaining() >= 8; first = false) {
      const auto length = in.read<std::uint32_t>(), kind = in.read<std::uint32_t>();
      const std::size_t begin = in.position() - 8;
      const auto chunk = in.read_span(length);
      if (first)
        source = chunk;
      else if (kind == 0x004e4942u && file.embedded_.empty())  // "BIN"
        file.embedded_.assign(chunk.begin(), chunk.end());
      else if (in.ok())
        file.further_chunks_.insert(file.further_chunks_.end(), data->begin() + static_cast<std::ptrdiff_t>(begin),
                                    data->begin() + static_cast<std::ptrdiff_t>(in.position()));
    }
  }
  const char* begin = reinterpret_cast<const char*>(source.data());
  file.json_ = Json::parse(begin, begin + source.size(), nullptr, false);
  if (!file.json_.is_object()) return input_error("glTF's JSON cannot be read");
  file.buffers_.resize(member(file.json_, "buffers").is_array() ? member(file.json_, "buffers").size() : 0);
  return file;
}

Result<std::vector<double>> GltfFile::accessor(std::int64_t index, int& width) {
  const Json& a = element(member(json_, "accessors"), index);
  if (!a.is_object() || a.contains("sparse")) return input_error("an accessor is missing or sparse");
  const std::string type = text(member(a, "type"));
  width = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 0;
  const std::int64_t component = integer(member(a, "componentType"), 0), count = integer(member(a, "count"), -1);
  const std::size_t size = component == 5126                        ? 4
                           : component == 5122 || component == 5123 ? 2
                           : component == 5120 || component == 5121 ? 1
                                                                    : 0;
  const Json& view = element(member(json_, "bufferViews"), integer(member(a, "bufferView"), -1));
  if (width == 0 || size == 0 || count < 0 || !view.is_object())
    return input_error("an accessor is of an unknown kind");
  auto opened = buffer(integer(member(view, "buffer"), -1));
  if (!opened) return opened.error();
  const std::size_t packed = size * static_cast<std::size_t>(width);
  const auto stride = static_cast<std::uint64_t>(std::max<std::int64_t>(integer(member(view, "byteStride"), 0), 0));
  const auto step = stride == 0 ? packed : stride;
  const std::int64_t view_at = integer(member(view, "byteOffset"), 0), at = integer(member(a, "byteOffset"), 0);
  const Bytes& bytes = **opened;
  if (view_at < 0 || at < 0 || step > 4096 || static_cast<std::uint64_t>(count) > bytes.size())
    return input_error("an accessor leaves its buffer");
  const std::uint64_t begin = static_cast<std::uint64_t>(view_at) + static_cast<std::uint64_t>(at);
  if (count > 0 && begin + step * static_cast<std::uint64_t>(count - 1) + packed > bytes.size())
    return input_error("an accessor leaves its buffer");
  std::vector<double> out;
  out.reserve(static_cast<std::size_t>(count) * static_cast<std::size_t>(width));
  for (std::int64_t i = 0; i < count; ++i)
    for (int k = 0; k < width; ++k)
      out.push_back(component_value(
          bytes.data() + begin + step * static_cast<std::uint64_t>(i) + size * static_cast<std::size_t>(k), component));
  return out;
}

Result<const Bytes*> GltfFile::buffer(std::int64_t index) {
  const Json& about = element(member(json_, "buffers"), index);
  if (!about.is_object()) return input_error("a buffer is missing");
  const std::string uri = text(member(about, "uri"));
  if (uri.empty()) return &embedded_;
  Bytes& bytes = buffers_[static_cast<std::size_t>(index)];
  if (!bytes.empty()) return &bytes;
  if (uri.starts_with("data:")) {
    const auto comma = uri.find(',');
    if (comma == std::string::npos) return input_error("a buffer's data is not base64");
    bytes = decode_base64(std::string_view(uri).substr(comma + 1));
  } else {
    auto read = read_file(folder_ / decode_percent(uri));
    if (!read) return read.error();
    bytes = std::move(*read);
  }
  return &bytes;
}

std::vector<int> match_nodes(const Json& json, const Character& character) {
  const Json& nodes = member(json, "nodes");
  const Json& scenes = member(json, "scenes");
  const std::int64_t scene = integer(member(json, "scene"), 0);
  const Json& roots = member(element(scenes, scene), "nodes");
  if (!nodes.is_array() || !roots.is_array()) return {};
  std::vector<std::vector<int>> children(character.nodes.size());
  for (std::size_t i = 1; i < character.nodes.size(); ++i)
    if (character.nodes[i].parent >= 0)
      children[static_cast<std::size_t>(character.nodes[i].parent)].push_back(static_cast<int>(i));

  std::vector<int> out(nodes.size(), -1);
  std::vector<std::pair<std::int64_t, int>> stack;
  const auto pair_up = [&](const Json& theirs, const std::vector<int>& ours) {
    const std::size_t count = theirs.is_array() ? theirs.size() : 0;
    if (count != ours.size()) return false;
    for (std::size_t k = 0; k < count; ++k) stack.push_back({integer(theirs[k], -1), ours[k]});
    return true;
  };
  if (roots.size() == 1)
    stack.push_back({integer(roots[0], -1), 0});
  else if (!pair_up(roots, children[0]))
    return {};
  while (!stack.empty()) {
    const auto [theirs, ours] = stack.back();
    stack.pop_back();
    if (theirs < 0 || static_cast<std::size_t>(theirs) >= out.size() || out[static_cast<std::size_t>(theirs)] >= 0)
      return {};
    out[static_cast<std::size_t>(theirs)] = ours;
    if (!pair_up(member(element(nodes, theirs), "children"), children[static_cast<std::size_t>(ours)])) return {};
  }
  return out;
}

}  // namespace ft::inline io::gltf
