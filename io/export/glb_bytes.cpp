#include "io/export/glb_bytes.h"

#include <algorithm>
#include <array>

namespace ft::inline io {
namespace {

constexpr std::uint32_t k_glb = 0x46546c67, k_json = 0x4e4f534a, k_bin = 0x004e4942;

std::size_t push(gltf::Json& json, const char* list, gltf::Json item) {
  if (!json.contains(list)) json[list] = gltf::Json::array();
  json[list].push_back(std::move(item));
  return json[list].size() - 1;
}

}  // namespace

std::size_t append_aligned(Bytes& bin, std::span<const std::byte> data) {
  const std::size_t begin = (bin.size() + 15) / 16 * 16;
  bin.resize(begin + data.size());
  std::copy(data.begin(), data.end(), bin.begin() + static_cast<std::ptrdiff_t>(begin));
  return begin;
}

std::size_t add_view(gltf::Json& json, Bytes& bin, std::span<const std::byte> data) {
  const std::size_t begin = append_aligned(bin, data);
  return push(json, "bufferViews", {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", data.size()}});
}

std::size_t add_accessor(gltf::Json& json, Bytes& bin, std::span<const double> values, int width, bool with_range) {
  std::vector<float> floats(values.size());
  std::transform(values.begin(), values.end(), floats.begin(), [](double v) { return static_cast<float>(v); });
  const std::size_t view = add_view(json, bin, std::as_bytes(std::span(floats)));
  const char* type = width == 1 ? "SCALAR" : width == 3 ? "VEC3" : width == 4 ? "VEC4" : "MAT4";
  gltf::Json accessor = {
      {"bufferView", view}, {"componentType", 5126}, {"count", values.size() / at(width)}, {"type", type}};
  if (with_range) {
    const auto [least, most] = std::minmax_element(floats.begin(), floats.end());
    accessor["min"] = gltf::Json::array({*least});
    accessor["max"] = gltf::Json::array({*most});
  }
  return push(json, "accessors", std::move(accessor));
}

Result<Bytes> glb_bytes(gltf::Json& json, const Bytes& bin, std::span<const std::byte> further_chunks) {
  if (!bin.empty()) json["buffers"][0]["byteLength"] = bin.size();
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::size_t bin_size = (bin.size() + 3) / 4 * 4;
  const std::uint64_t total = 12 + 8 + text.size() + (bin.empty() ? 0 : 8 + bin_size) + further_chunks.size();
  if (total > 0xffffffffu) return output_error("is larger than the 4 GiB that a .glb may have");
  const std::array<std::uint32_t, 5> head{k_glb, 2, static_cast<std::uint32_t>(total),
                                          static_cast<std::uint32_t>(text.size()), k_json};
  const std::array<std::uint32_t, 2> bin_head{static_cast<std::uint32_t>(bin_size), k_bin};
  constexpr std::array<std::byte, 3> k_padding{};
  ByteWriter out;
  out.write_raw(head.data(), sizeof head).write_raw(text.data(), text.size());
  if (!bin.empty())
    out.write_raw(bin_head.data(), sizeof bin_head)
        .write_raw(bin.data(), bin.size())
        .write_raw(k_padding.data(), bin_size - bin.size());
  out.write_array(further_chunks);
  return out.take();
}

}  // namespace ft::inline io
