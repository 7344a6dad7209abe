// Opening: the chunks of a .glb, the JSON, and buffers from the .glb, from data: URIs and from files beside it.
#include "io/import/gltf/gltf_file.h"

#include <algorithm>

#include "baker/core/file.h"

namespace ft::inline io::gltf {
namespace {

constexpr std::uint32_t k_magic = 0x46546c67u, k_json_chunk = 0x4e4f534au, k_bin_chunk = 0x004e4942u;

struct Chunks {
  std::span<const std::byte> json;
  std::size_t bin_begin = 0, bin_size = 0;
  bool has_bin = false;
};

/// Reads the heads of a .glb of version 2; further chunks are appended as they are.
Result<Chunks> find_chunks(std::span<const std::byte> data, Bytes& further) {
  ByteReader in(data);
  in.seek(12);
  Chunks out;
  bool first = true;
  while (in.ok() && in.remaining() >= 8) {
    const std::size_t begin = in.position();
    const auto length = in.read<std::uint32_t>(), kind = in.read<std::uint32_t>();
    if (length > in.remaining())
      return input_error("is cut short: a chunk of its .glb has " + std::to_string(length) + " bytes, and " +
                         std::to_string(in.remaining()) + " are there");
    const auto chunk = in.read_span(length);
    if (first && kind != k_json_chunk) return input_error("is no .glb: its first chunk is not JSON");
    if (first)
      out.json = chunk;
    else if (kind == k_bin_chunk && !out.has_bin)
      out.bin_begin = begin + 8, out.bin_size = length, out.has_bin = true;
    else
      further.insert(further.end(), data.begin() + static_cast<std::ptrdiff_t>(begin),
                     data.begin() + static_cast<std::ptrdiff_t>(in.position()));
    first = false;
  }
  if (first) return input_error("is cut short: its .glb has no JSON chunk");
  return out;
}

constexpr int k_deepest_json = 200;

/// Levels of brackets, outside of strings: who copies or writes JSON goes down by recursion.
int nesting(std::string_view source) {
  int depth = 0, most = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const char c = source[i];
    if (quoted && c == '\\')
      ++i;
    else if (c == '"')
      quoted = !quoted;
    else if (!quoted && (c == '{' || c == '['))
      most = std::max(most, ++depth);
    else if (!quoted && (c == '}' || c == ']'))
      --depth;
  }
  return most;
}

Result<Json> parse(std::span<const std::byte> source) {
  const char* begin = reinterpret_cast<const char*>(source.data());
  if (nesting({begin, source.size()}) > k_deepest_json)
    return input_error("glTF's JSON is nested deeper than " + std::to_string(k_deepest_json) + " levels");
  try {
    Json json = Json::parse(begin, begin + source.size());
    if (!json.is_object()) return input_error("glTF's JSON cannot be read: it is no object");
    return json;
  } catch (const Json::exception& e) {
    std::string why = e.what();
    if (why.size() > 160) why = why.substr(0, 160) + "...";
    for (char& c : why)
      if (static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126) c = '?';
    return input_error("glTF's JSON cannot be read: " + why);
  }
}

/// The file that a URI names: decoded, else as written (some exporters do not encode), else with slashes of Windows.
std::filesystem::path uri_file(const std::filesystem::path& folder, const std::string& uri) {
  std::string turned = decode_percent(uri);
  std::replace(turned.begin(), turned.end(), '\\', '/');
  for (const std::string& name : {decode_percent(uri), uri, turned}) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(folder / name, ignored)) return folder / name;
  }
  return folder / decode_percent(uri);
}

Result<Bytes> data_uri(const std::string& uri, const std::string& name) {
  const auto comma = uri.find(',');
  if (comma == std::string::npos) return input_error(name + ": its data: URI has no comma");
  if (std::string_view(uri).substr(0, comma).ends_with(";base64"))
    return decode_base64(std::string_view(uri).substr(comma + 1));
  const std::string decoded = decode_percent(uri.substr(comma + 1));
  const auto* first = reinterpret_cast<const std::byte*>(decoded.data());
  return Bytes(first, first + decoded.size());
}

}  // namespace

Result<GltfFile> GltfFile::open(const std::filesystem::path& path) {
  auto data = read_file(path);
  if (!data) return data.error();
  GltfFile file;
  file.folder_ = path.parent_path();
  file.byte_count_ = data->size();
  ByteReader in(*data);
  std::span<const std::byte> source = *data;
  Chunks chunks;
  if (in.read<std::uint32_t>() == k_magic) {
    const auto version = in.read<std::uint32_t>();
    if (version == 1) {
      file.version_1_ = file.binary_ = true;
      in.read<std::uint32_t>();
      const auto length = in.read<std::uint32_t>();
      in.read<std::uint32_t>();
      source = in.read_span(length);
    } else {
      if (version != 2) return input_error("is a .glb of version " + std::to_string(version) + "; 2 can be read");
      auto found = find_chunks(*data, file.further_chunks_);
      if (!found) return found.error();
      chunks = *found, source = chunks.json, file.binary_ = true;
    }
  }
  auto json = parse(source);
  if (!json) return json.error();
  file.json_ = std::move(*json);
  if (text(member(member(file.json_, "asset"), "version")).starts_with("1")) file.version_1_ = true;
  if (chunks.has_bin) {  // the bytes in front and behind go, so that the file is held once
    data->resize(chunks.bin_begin + chunks.bin_size);
    data->erase(data->begin(), data->begin() + static_cast<std::ptrdiff_t>(chunks.bin_begin));
    file.embedded_ = std::move(*data);
  }
  const Json& buffers = member(file.json_, "buffers");
  file.buffers_.resize(size_of_array(buffers));
  for (std::size_t b = 0; b < file.buffers_.size(); ++b) {
    const Json& uri = member(buffers[b], "uri");
    if (!uri.is_string() || uri.get_ref<const std::string&>().starts_with("data:")) continue;
    std::error_code failed;
    const auto bytes = std::filesystem::file_size(uri_file(file.folder_, text(uri)), failed);
    if (!failed) file.byte_count_ += bytes;
  }
  return file;
}

Result<const Bytes*> GltfFile::buffer(std::int64_t index) {
  const Json& about = element(member(json_, "buffers"), index);
  const std::string name = "buffers[" + std::to_string(index) + "]";
  if (!about.is_object()) return input_error(name + " is not there");
  Bytes& bytes = buffers_[static_cast<std::size_t>(index)];
  if (!bytes.empty()) return &bytes;
  const std::string uri = text(member(about, "uri"));
  if (uri.empty()) {
    if (index != 0 || !binary_) return input_error(name + " has no bytes: no uri, and it is not the one of a .glb");
    return &embedded_;
  }
  if (uri.starts_with("data:")) {
    auto decoded = data_uri(uri, name);
    if (!decoded) return decoded.error();
    bytes = std::move(*decoded);
    return &bytes;
  }
  const auto file = uri_file(folder_, uri);
  auto read = read_file(file);
  if (!read) return input_error(name + ": " + read.error().text());
  bytes = std::move(*read);
  const auto relative = file.lexically_relative(folder_);
  opened_.push_back({relative.empty() ? file.string() : relative.string(), hash_bytes(bytes)});
  return &bytes;
}

}  // namespace ft::inline io::gltf
