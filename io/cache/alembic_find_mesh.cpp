// Archive to cache: faces and uvs of a polygon mesh. Where faces change, they are checked frame by frame.
#include <algorithm>
#include <utility>

#include "io/cache/alembic_view.h"

namespace ft::inline io::alembic {
namespace {

class MeshReader {
 public:
  MeshReader(const InputFile& file, ShapeView& view) : file_(file), view_(view) {}

  Status run(const Property& geom) {
    const Status status = read_faces(geom);
    if (status) find_scalars(geom);
    return status;
  }

 private:
  Error fault(std::string what) const { return input_error(std::move(what), file_.path().string()); }

  /// What has a number for each vertex in every frame, under the names of the file.
  void find_scalars(const Property& geom) {
    const Property* parameters = geom.find(".arbGeomParams");
    if (parameters == nullptr) return;
    FrameContent& content = view_.info.content;
    const Property& positions = view_.channels[k_positions];
    for (const Property& p : parameters->children) {
      if (p.kind != PropertyKind::k_array || p.pod != Pod::k_f32 || p.extent != 1 ||
          p.metadata.find("geoScope=vtx") == std::string::npos || p.sample_count != positions.sample_count ||
          content.scalars.size() == k_most_scalars)
        continue;
      const std::uint64_t count = static_cast<std::uint64_t>(view_.info.vertex_count);
      const auto fits = [&](const Sample& s) { return s.size == (count > 0 ? 16 + 4 * count : 0); };
      if (!content.changes && !std::ranges::all_of(p.samples, fits)) continue;
      view_.channels[k_scalars + content.scalars.size()] = p;
      content.scalars.push_back(p.name);
    }
  }

  Status read_faces(const Property& geom) {
    const Property *sizes = geom.find(".faceCounts"), *corners = geom.find(".faceIndices");
    const auto is_numbers = [](const Property* p) {
      return p != nullptr && p->kind == PropertyKind::k_array && p->pod == Pod::k_i32 && p->extent == 1;
    };
    if (!is_numbers(sizes) || !is_numbers(corners)) return fault("has a mesh without faces");
    const bool empty = sizes->samples.empty() && corners->samples.empty();
    if (empty || !sizes->constant() || !corners->constant()) view_.info.content.changes = true;
    if (!view_.info.content.changes) {
      if (sizes->samples.empty() || corners->samples.empty()) return fault("has a mesh without faces");
      const Status status = read_topology(*sizes, *corners);
      return status ? read_uvs(geom) : status;
    }
    const auto adopt = [&](Channel channel, Property p) {
      // What does not change may be stored for one frame only.
      if (p.constant()) p.sample_count = view_.channels[k_positions].sample_count;
      return empty || adopt_channel(view_, channel, &p, Pod::k_i32, 1);
    };
    if (!adopt(k_face_sizes, *sizes) || !adopt(k_face_corners, *corners))
      return fault("has a mesh whose faces and positions do not come at the same times");
    return {};
  }

  Status read_topology(const Property& sizes, const Property& corners) {
    auto face_sizes = values_of<int>(file_, sizes.samples.front());
    if (!face_sizes) return face_sizes.error();
    auto face_vertices = values_of<int>(file_, corners.samples.front());
    if (!face_vertices) return face_vertices.error();
    for (const int n : *face_sizes)  // a mesh of other programs, not a damaged one
      if (n < 3) return fault("has a face with " + std::to_string(n) + " corners");
    if (const std::string wrong = fault_of_faces(*face_sizes, *face_vertices, at(view_.info.vertex_count));
        !wrong.empty())
      return fault("is damaged: " + wrong);
    Mesh& mesh = view_.info.mesh;
    mesh.name = view_.info.system;
    mesh.face_sizes = std::move(*face_sizes);
    mesh.face_vertices = std::move(*face_vertices);
    reverse_faces(mesh.face_sizes, mesh.face_vertices);
    return {};
  }

  /// UVs per corner or per vertex, indexed or not; others are left out.
  Status read_uvs(const Property& geom) {
    const Property* uv = geom.find("uv");
    if (uv == nullptr) return {};
    const bool indexed = uv->kind == PropertyKind::k_compound;
    const Property* values = indexed ? uv->find(".vals") : uv;
    const Property* indices = indexed ? uv->find(".indices") : nullptr;
    if (!is_array(values, Pod::k_f32, 2) || (indexed && !is_array(indices, Pod::k_u32, 1))) return {};
    const auto floats = values_of<float>(file_, values->samples.front());
    if (!floats) return floats.error();
    std::vector<int> corners;
    if (indexed) {
      auto read = values_of<int>(file_, indices->samples.front());
      if (!read) return read.error();
      corners = std::move(*read);
    } else {
      for (std::size_t i = 0; i < floats.value().size() / 2; ++i) corners.push_back(static_cast<int>(i));
    }
    Mesh& mesh = view_.info.mesh;
    if (corners.size() == mesh.face_vertices.size()) {
      reverse_faces(mesh.face_sizes, corners);
    } else if (corners.size() == static_cast<std::size_t>(view_.info.vertex_count)) {
      std::vector<int> of_vertex = std::exchange(corners, {});
      for (const int v : mesh.face_vertices) corners.push_back(of_vertex[static_cast<std::size_t>(v)]);
    } else {
      return {};
    }
    for (const int i : corners)
      if (i < 0 || static_cast<std::size_t>(i) >= floats.value().size() / 2)
        return fault("is damaged: a face uses a missing uv");
    for (std::size_t i = 0; i + 1 < floats.value().size(); i += 2) {
      const Vec2 value(floats.value()[i], floats.value()[i + 1]);
      if (!value.allFinite()) return fault("is damaged: uvs that are not finite");
      mesh.uvs.push_back(value);
    }
    mesh.face_uvs = std::move(corners);
    return {};
  }

  const InputFile& file_;
  ShapeView& view_;
};

}  // namespace

Status view_mesh(const InputFile& file, const Property& geom, ShapeView& view) {
  return MeshReader(file, view).run(geom);
}

}  // namespace ft::inline io::alembic
