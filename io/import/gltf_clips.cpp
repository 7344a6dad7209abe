#include "io/import/gltf_clips.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "baker/core/bytes.h"
#include "baker/core/file.h"

namespace ft {
namespace {

using Json = nlohmann::json;

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

/// The JSON and the buffers; a buffer is read when it is first needed.
class GltfFile {
 public:
  static Result<GltfFile> open(const std::filesystem::path& path) {
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
        const auto chunk = in.read_span(length);
        if (first)
          source = chunk;
        else if (kind == 0x004e4942u && file.embedded_.empty())  // "BIN"
          file.embedded_.assign(chunk.begin(), chunk.end());
      }
    }
    const char* begin = reinterpret_cast<const char*>(source.data());
    file.json_ = Json::parse(begin, begin + source.size(), nullptr, false);
    if (!file.json_.is_object()) return input_error("glTF's JSON cannot be read");
    file.buffers_.resize(member(file.json_, "buffers").is_array() ? member(file.json_, "buffers").size() : 0);
    return file;
  }

  const Json& json() const { return json_; }

  /// Numbers of an accessor, `width` per element, normalised integers as the specification says.
  Result<std::vector<double>> accessor(std::int64_t index, int& width) {
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
    auto buffer = open_buffer(integer(member(view, "buffer"), -1));
    if (!buffer) return buffer.error();
    const std::size_t packed = size * static_cast<std::size_t>(width);
    const auto stride = static_cast<std::uint64_t>(std::max<std::int64_t>(integer(member(view, "byteStride"), 0), 0));
    const auto step = stride == 0 ? packed : stride;
    const std::int64_t view_at = integer(member(view, "byteOffset"), 0), at = integer(member(a, "byteOffset"), 0);
    const Bytes& bytes = **buffer;
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
            bytes.data() + begin + step * static_cast<std::uint64_t>(i) + size * static_cast<std::size_t>(k),
            component));
    return out;
  }

 private:
  static double component_value(const std::byte* at, std::int64_t component) {
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

  Result<const Bytes*> open_buffer(std::int64_t index) {
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

  Json json_;
  std::filesystem::path folder_;
  Bytes embedded_;
  std::vector<Bytes> buffers_;
};

/// Node of ours for each node of the JSON, by walking both trees side by side; empty when the trees differ.
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

/// A channel that moves a part of a node leaves the other parts as the JSON has them (scale may hold a reflection that
/// cannot be told from a rotation once it is in a matrix).
void fill_rest(const Json& node, Channel& channel) {
  if (node.contains("matrix")) return;
  double first = std::numeric_limits<double>::infinity();  // constant keys do not lengthen the clip
  for (const Track* t : {&channel.translation, &channel.rotation, &channel.scale})
    if (!t->empty()) first = std::min(first, t->times.front());
  const auto fill = [&](Track& track, const char* key, std::vector<double> otherwise) {
    if (!track.empty()) return;
    std::vector<double> value = numbers(member(node, key));
    if (value.size() != otherwise.size()) value = std::move(otherwise);
    track.width = static_cast<int>(value.size());
    track.times = {first};
    track.values = std::move(value);
  };
  fill(channel.translation, "translation", {0, 0, 0});
  fill(channel.rotation, "rotation", {0, 0, 0, 1});
  fill(channel.scale, "scale", {1, 1, 1});
}

Result<Track> read_sampler(GltfFile& file, const Json& sampler, int width) {
  Track track;
  int time_width = 0, value_width = 0;
  auto times = file.accessor(integer(member(sampler, "input"), -1), time_width);
  if (!times) return times.error();
  auto values = file.accessor(integer(member(sampler, "output"), -1), value_width);
  if (!values) return values.error();
  const std::string how = text(member(sampler, "interpolation"));
  track.interpolation = how == "STEP"          ? Interpolation::k_step
                        : how == "CUBICSPLINE" ? Interpolation::k_cubic
                                               : Interpolation::k_linear;
  track.times = std::move(*times);
  track.values = std::move(*values);
  const std::size_t per_key = track.interpolation == Interpolation::k_cubic ? 3 : 1;
  if (width == 0 && !track.times.empty()) width = static_cast<int>(track.values.size() / track.times.size() / per_key);
  track.width = width;
  if (time_width != 1 || width == 0 || (width == 3 && value_width != 3 && value_width != 1) ||
      track.values.size() != track.times.size() * track.stride())
    return input_error("a sampler's keys and values do not match");
  for (std::size_t i = 1; i < track.times.size(); ++i)
    if (!(track.times[i] > track.times[i - 1])) return input_error("key times do not ascend");
  return track;
}

Result<std::vector<Clip>> read_clips(GltfFile& file, const std::vector<int>& node_of, const Character& character) {
  std::vector<Clip> clips;
  const Json& animations = member(file.json(), "animations");
  for (std::size_t a = 0; animations.is_array() && a < animations.size(); ++a) {
    Clip clip;
    clip.name = text(member(animations[a], "name"));
    if (clip.name.empty()) clip.name = "animation_" + std::to_string(a);
    std::vector<Channel> of_node(character.nodes.size());
    const Json& channels = member(animations[a], "channels");
    for (std::size_t c = 0; channels.is_array() && c < channels.size(); ++c) {
      const Json& target = member(channels[c], "target");
      const std::int64_t node = integer(member(target, "node"), -1);
      const std::string path = text(member(target, "path"));
      if (node < 0 || static_cast<std::size_t>(node) >= node_of.size() || node_of[static_cast<std::size_t>(node)] < 0)
        continue;
      Channel& channel = of_node[static_cast<std::size_t>(node_of[static_cast<std::size_t>(node)])];
      Track* track = path == "translation" ? &channel.translation
                     : path == "rotation"  ? &channel.rotation
                     : path == "scale"     ? &channel.scale
                     : path == "weights"   ? &channel.weights
                                           : nullptr;
      if (track == nullptr) continue;
      const int width = path == "weights" ? 0 : path == "rotation" ? 4 : 3;
      auto read = read_sampler(
          file, element(member(animations[a], "samplers"), integer(member(channels[c], "sampler"), -1)), width);
      if (!read) return read.error();
      *track = std::move(*read);
      channel.node = static_cast<int>(node);  // of the JSON, until the rest is filled in
    }
    for (std::size_t n = 0; n < of_node.size(); ++n) {
      Channel& channel = of_node[n];
      if (channel.node < 0) continue;
      if (!channel.translation.empty() || !channel.rotation.empty() || !channel.scale.empty())
        fill_rest(element(member(file.json(), "nodes"), channel.node), channel);
      channel.node = static_cast<int>(n);
      clip.channels.push_back(std::move(channel));
    }
    clip.find_range();
    clips.push_back(std::move(clip));
  }
  return clips;
}

void read_rest_weights(const Json& json, const std::vector<int>& node_of, Character& character) {
  for (std::size_t n = 0; n < node_of.size(); ++n) {
    if (node_of[n] < 0) continue;
    const Json& node = element(member(json, "nodes"), static_cast<std::int64_t>(n));
    std::vector<double> weights = numbers(member(node, "weights"));
    if (weights.empty())
      weights = numbers(member(element(member(json, "meshes"), integer(member(node, "mesh"), -1)), "weights"));
    auto& rest = character.nodes[static_cast<std::size_t>(node_of[n])].morph_weights;
    for (std::size_t k = 0; k < rest.size() && k < weights.size(); ++k) rest[k] = weights[k];
  }
}

}  // namespace

void read_gltf_clips(const std::filesystem::path& path, Character& character) {
  const char* doubt = "; keys are joined by straight lines, steps and splines in the file may be lost";
  try {
    auto file = GltfFile::open(path);
    if (!file) return character.notes.push_back("animation read by assimp: " + file.error().what + doubt);
    const std::vector<int> node_of = match_nodes(file->json(), character);
    if (node_of.empty())
      return character.notes.push_back(std::string("animation read by assimp: node trees differ") + doubt);
    read_rest_weights(file->json(), node_of, character);
    auto clips = read_clips(*file, node_of, character);
    if (!clips) return character.notes.push_back("animation read by assimp: " + clips.error().what + doubt);
    character.clips = std::move(*clips);
  } catch (const std::exception& e) {
    character.notes.push_back(std::string("animation read by assimp: ") + e.what() + doubt);
  }
}

}  // namespace ft
