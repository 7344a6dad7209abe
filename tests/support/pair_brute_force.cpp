#include "tests/support/pair_brute_force.h"

#include <algorithm>

#include "baker/core/mesh.h"

namespace ft::test {
namespace {

bool nowhere(const VertexBox& b) {
  return b.is_nowhere();
}

/// Unions of the boxes of the vertices of each feature; a vertex that is nowhere takes its feature with it.
template <class Features>
std::vector<VertexBox> feature_boxes(std::span<const VertexBox> boxes, const Features& features) {
  std::vector<VertexBox> out;
  for (const auto& feature : features) {
    VertexBox u = VertexBox::nowhere();
    for (const int v : feature) u.include(boxes[static_cast<std::size_t>(v)]);
    const bool gone =
        std::any_of(feature.begin(), feature.end(), [&](int v) { return nowhere(boxes[static_cast<std::size_t>(v)]); });
    out.push_back(gone ? VertexBox::nowhere() : u);
  }
  return out;
}

bool meets(const VertexBox& a, const VertexBox& b) {
  for (std::size_t i = 0; i < k_box_axes; ++i)
    if (a.lo[i] > -b.minus_hi[i] || b.lo[i] > -a.minus_hi[i]) return false;
  return true;
}

}  // namespace

ContactPairs brute_force(const PairScene& scene, bool self) {
  ContactPairs out;
  std::vector<Triangle> faces = scene.cloth;
  faces.insert(faces.end(), scene.collider.begin(), scene.collider.end());
  std::vector<Edge> edges = unique_edges(faces);
  const auto of_cloth = [&](int v) { return v < scene.cloth_vertices; };
  std::vector<int> vertices;
  for (const Triangle& t : faces) vertices.insert(vertices.end(), t.begin(), t.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  const auto wanted = [&](int a, int b) { return of_cloth(a) != of_cloth(b) || (self && of_cloth(a) && of_cloth(b)); };
  std::erase_if(edges, [](const Edge& e) { return e[0] == e[1]; });
  std::erase_if(faces, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });  // cords
  const std::vector<VertexBox> face_boxes = feature_boxes(scene.boxes, faces),
                               edge_boxes = feature_boxes(scene.boxes, edges);
  for (const int v : vertices) {
    const VertexBox& box = scene.boxes[static_cast<std::size_t>(v)];
    if (nowhere(box)) continue;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const Triangle& t = faces[i];
      if (meets(box, face_boxes[i]) && wanted(v, t[0]) && v != t[0] && v != t[1] && v != t[2])
        out.vertex_face.push_back({{v, t[0], t[1], t[2]}});
    }
  }
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t j = i + 1; j < edges.size(); ++j) {
      const Edge &a = edges[i], &b = edges[j];
      if (!meets(edge_boxes[i], edge_boxes[j]) || !wanted(a[0], b[0])) continue;
      if (a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1]) continue;
      out.edge_edge.push_back({{a[0], a[1], b[0], b[1]}});
    }
  std::sort(out.vertex_face.begin(), out.vertex_face.end());
  out.vertex_face.erase(std::unique(out.vertex_face.begin(), out.vertex_face.end()), out.vertex_face.end());
  std::sort(out.edge_edge.begin(), out.edge_edge.end());
  return out;
}

}  // namespace ft::test
