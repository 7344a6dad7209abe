// A BlendShape deformer has channels, a channel one shape or several (in between), each a Geometry. Up to 7.1 the
// shapes stand in the mesh's own Geometry, and the percentage is a property of it that has the shape's name. Traps met:
// Blender writes DeformPercent as a field, and FullWeights as weights of single offsets.
#include "io/import/fbx/fbx_shapes.h"

#include <algorithm>
#include <numeric>

namespace ft::inline io {
namespace {

double deform_percent(const FbxObject& channel) {
  if (channel.property("DeformPercent") != nullptr) return channel.number("DeformPercent", 0);
  const FbxNode* field = channel.node->child("DeformPercent");
  return field != nullptr ? fbx_number(*field, 0, 100) : 0;
}

/// A shape's offsets on all vertices; `factors` of single offsets, or empty.
MorphTarget read_shape(const FbxNode& shape, const std::string& name, std::span<const double> factors,
                       const Mat3& linear, std::size_t vertex_count, int& bad) {
  MorphTarget out{name, std::vector<Vec3>(vertex_count, Vec3::Zero())};
  const std::vector<std::int32_t> indices = fbx_indices(shape.child("Indexes"));
  const std::vector<Vec3> offsets = fbx_points(shape.child("Vertices"));
  bool odd = indices.size() != offsets.size();
  for (std::size_t k = 0; k < std::min(indices.size(), offsets.size()); ++k) {
    if (indices[k] < 0 || static_cast<std::size_t>(indices[k]) >= vertex_count)
      odd = true;
    else
      out.deltas[static_cast<std::size_t>(indices[k])] += linear * offsets[k] * (factors.empty() ? 1.0 : factors[k]);
  }
  bad += odd;
  return out;
}

void add_rest(const FbxShapeChannel& channel, std::vector<double>& rest) {
  const std::size_t first = rest.size();
  rest.resize(first + channel.shapes.size());
  shape_weights(channel.shapes, channel.percent, std::span(rest).subspan(first));
}

}  // namespace

std::vector<Vec3> fbx_points(const FbxNode* node) {
  const std::vector<double> numbers = fbx_numbers(node);
  std::vector<Vec3> out(numbers.size() / 3);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = Eigen::Map<const Vec3>(numbers.data() + 3 * i);
  return out;
}

int read_fbx_shapes(const FbxDocument& document, const FbxObject& geometry, const Mat3& linear, CharacterMesh& mesh,
                    std::vector<double>& rest, std::vector<FbxShapeChannel>& channels) {
  int bad = 0;
  const std::size_t vertex_count = mesh.positions.size();
  for (const FbxNode& shape : geometry.node->children) {
    if (shape.name != "Shape") continue;
    const std::string& name = fbx_text(shape, 0);
    FbxShapeChannel channel;
    channel.object = geometry.id, channel.property = name, channel.node = mesh.node;
    channel.percent = geometry.number(name, 0);
    channel.shapes.push_back({static_cast<std::int32_t>(mesh.morphs.size()), 100});
    mesh.morphs.push_back(read_shape(shape, name, {}, linear, vertex_count, bad));
    add_rest(channel, rest);
    channels.push_back(std::move(channel));
  }
  for (const FbxObject* deformer : document.members(geometry.id, "Deformer", "BlendShape"))
    for (const FbxObject* object : document.members(deformer->id, "Deformer", "BlendShapeChannel")) {
      const auto shapes = document.members(object->id, "Geometry", "Shape");
      if (shapes.empty()) continue;
      std::vector<double> full = fbx_numbers(object->node->child("FullWeights")), factors;
      if (shapes.size() == 1 && full.size() > 1) {
        if (full.size() == fbx_indices(shapes.front()->node->child("Indexes")).size())
          for (const double percent : full) factors.push_back(percent / 100);
        full.clear();
      }
      full.resize(shapes.size(), 100.0);
      std::vector<std::size_t> order(shapes.size());
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return full[a] < full[b]; });
      FbxShapeChannel channel;
      channel.object = object->id, channel.node = mesh.node;
      channel.percent = deform_percent(*object);
      for (const std::size_t k : order) {
        channel.shapes.push_back({static_cast<std::int32_t>(mesh.morphs.size()), full[k]});
        mesh.morphs.push_back(read_shape(*shapes[k]->node, shapes[k]->name, factors, linear, vertex_count, bad));
      }
      add_rest(channel, rest);
      channels.push_back(std::move(channel));
    }
  return bad;
}

}  // namespace ft::inline io
