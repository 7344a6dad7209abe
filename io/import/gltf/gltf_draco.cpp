#include "io/import/gltf/gltf_draco.h"

#include <draco/compression/decode.h>

#include <algorithm>
#include <cmath>

namespace ft::inline io::gltf {
namespace {

/// Largest value of the integer kinds that can be normalised; 0 for others.
double largest(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8: return 127;
    case draco::DT_UINT8: return 255;
    case draco::DT_INT16: return 32767;
    case draco::DT_UINT16: return 65535;
    default: return 0;
  }
}

Result<AccessorValues> values_of(const draco::PointAttribute& attribute, std::uint32_t point_count, bool fraction,
                                 const std::string& name) {
  const int width = attribute.num_components();
  if (width < 1 || width > 16) return input_error(name + " has " + std::to_string(width) + " components");
  const bool real = attribute.data_type() == draco::DT_FLOAT32 || attribute.data_type() == draco::DT_FLOAT64;
  const double divisor = fraction ? largest(attribute.data_type()) : 0;
  AccessorValues out;
  out.width = width;
  out.values.reserve(static_cast<std::size_t>(point_count) * static_cast<std::size_t>(width));
  std::vector<float> reals(static_cast<std::size_t>(width));
  std::vector<std::int64_t> integers(reals.size());
  const auto components = static_cast<std::int8_t>(width);
  for (std::uint32_t p = 0; p < point_count; ++p) {
    const draco::AttributeValueIndex at = attribute.mapped_index(draco::PointIndex(p));
    if (at.value() >= attribute.size()) return input_error(name + " has no value for point " + std::to_string(p));
    const bool read = real ? attribute.ConvertValue<float>(at, components, reals.data())
                           : attribute.ConvertValue<std::int64_t>(at, components, integers.data());
    if (!read) return input_error(name + " is of a kind that cannot be read");
    for (std::size_t k = 0; k < reals.size(); ++k) {
      const double v = real ? static_cast<double>(reals[k]) : static_cast<double>(integers[k]);
      out.values.push_back(divisor > 0 ? std::max(v / divisor, -1.0) : v);
    }
  }
  return out;
}

}  // namespace

Result<DracoMesh> read_draco(GltfFile& file, const Json& primitive, const Json& extension) {
  const std::string name = "KHR_draco_mesh_compression";
  auto view = file.view(integer(member(extension, "bufferView"), -1));
  if (!view) return input_error(name + ": " + view.error().what);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(view->bytes.data()), view->bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) return input_error(name + ": cannot be decompressed: " + decoded.status().error_msg_string());
  const draco::Mesh& mesh = *decoded.value();
  DracoMesh out;
  out.vertex_count = mesh.num_points();
  if (out.vertex_count > k_max_character_vertices || mesh.num_faces() > 2 * k_max_character_vertices)
    return input_error(name + ": has more than 20 million vertices");
  out.triangles.reserve(mesh.num_faces());
  for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
    const draco::Mesh::Face& face = mesh.face(draco::FaceIndex(f));
    for (const draco::PointIndex& p : face)
      if (p.value() >= mesh.num_points()) return input_error(name + ": a triangle names a vertex that is not there");
    out.triangles.push_back(
        {static_cast<int>(face[0].value()), static_cast<int>(face[1].value()), static_cast<int>(face[2].value())});
  }
  const Json& attributes = member(extension, "attributes");
  for (const auto& [semantic, id] : attributes.items()) {
    const bool weights = semantic.starts_with("WEIGHTS_"), joints = semantic.starts_with("JOINTS_");
    if (semantic != "POSITION" && !weights && !joints) continue;
    const std::int64_t unique = integer(id, -1);
    const draco::PointAttribute* attribute =
        unique < 0 || unique > 0xffff ? nullptr : mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(unique));
    if (attribute == nullptr) return input_error(name + ": " + semantic + " is not in the block");
    const Json& accessor = element(member(file.json(), "accessors"),
                                   integer(member(member(primitive, "attributes"), semantic.c_str()), -1));
    const Json& flag = member(accessor, "normalized");
    const bool fraction = weights || (!joints && flag.is_boolean() && flag.get<bool>());
    auto values = values_of(*attribute, mesh.num_points(), fraction, name + ": " + semantic);
    if (!values) return values.error();
    out.attributes.emplace(semantic, std::move(*values));
  }
  return out;
}

}  // namespace ft::inline io::gltf
