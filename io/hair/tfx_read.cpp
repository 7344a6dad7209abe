// The layout of TressFX 4 (TressFXFileFormat.h of GPUOpen's TressFX): a header of 160 bytes,
//
//   f32 version   u32 strands   u32 vertices per strand
//   u32 offsets of: positions (4 x f32 each: x, y, z, inverse mass), strand uvs, vertex uvs, thickness, colours
//   u32 reserved[32]
//
// and the arrays at these offsets, counted from the start of the file; 0: there is none. Nothing but the positions is
// read. Careful: positions of strands that the simulation pins have inverse mass 0, which is no part of the shape.
#include "io/hair/tfx_read.h"

#include <fmt/format.h>

#include "baker/core/file.h"

namespace ft::inline io {
namespace {

constexpr std::uint64_t k_most_bytes = std::uint64_t{1} << 30;
constexpr std::uint64_t k_header_bytes = 160, k_vertex_bytes = 16;

struct Header {
  float version;
  std::uint32_t strands, vertices;
  std::uint32_t positions, strand_uvs, vertex_uvs, thickness, colours;
};

}  // namespace

Result<std::vector<std::vector<Vec3>>> read_tfx(const std::filesystem::path& file, std::vector<std::string>& notes) {
  const auto fault = [&](std::string what, std::string hint = "the file may be cut or damaged; export it again") {
    return input_error(std::move(what), file.string(), std::move(hint));
  };
  const auto bytes = read_file(file, k_most_bytes);
  if (!bytes) return bytes.error();
  if (bytes->size() < k_header_bytes)
    return fault(fmt::format("has {} bytes, and the header of a TressFX file has {}", bytes->size(), k_header_bytes));
  ByteReader in(*bytes);
  const auto h = in.read<Header>();
  if (!(h.version >= 4 && h.version < 5))
    return fault(fmt::format("says to be of version {}", h.version), "TressFX files of version 4 can be read");
  if (h.strands == 0) return fault("holds no strands");
  if (h.vertices < 2) return fault(fmt::format("has strands of {} vertices; 2 are needed", h.vertices));
  if (h.positions < k_header_bytes)
    return fault(fmt::format("has its positions at byte {}, inside the header", h.positions));
  const std::uint64_t total = std::uint64_t{h.strands} * h.vertices;
  const std::uint64_t room = h.positions <= bytes->size() ? (bytes->size() - h.positions) / k_vertex_bytes : 0;
  if (total > room)
    return fault(
        fmt::format("has {} strands of {} vertices, and is long enough for {} vertices", h.strands, h.vertices, room));
  if (h.thickness != 0) notes.push_back("a thickness of each strand is left out: the format does not say in what unit");
  in.seek(h.positions);
  std::vector<std::vector<Vec3>> out(h.strands);
  for (std::size_t s = 0; s < out.size(); ++s)
    for (std::uint32_t v = 0; v < h.vertices; ++v) {
      const float x = in.read<float>(), y = in.read<float>(), z = in.read<float>();
      in.read<float>();
      out[s].emplace_back(x, y, z);
      if (!out[s].back().allFinite())
        return fault(fmt::format("has a position that is not finite: strand {}, vertex {}, from 0", s, v));
    }
  return out;
}

}  // namespace ft::inline io
