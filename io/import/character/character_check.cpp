// Looks at every number of an imported character once. It runs on what the child process wrote and on what the import
// cache held, so it assumes nothing.
#include <algorithm>
#include <cmath>

#include "io/import/character/character.h"

namespace ft::inline io {
namespace {

/// Beyond this a coordinate is a fault of the file, and its square would leave float's range [file units].
constexpr double k_max_coordinate = 1e9;

bool usable(double x) {
  return std::isfinite(x) && std::abs(x) <= k_max_coordinate;
}
bool usable(const Vec3& p) {
  return usable(p.x()) && usable(p.y()) && usable(p.z());
}
bool usable(const Mat4& m) {
  return m.allFinite() && m.cwiseAbs().maxCoeff() <= k_max_coordinate;
}

Error fault(const std::string& where, const std::string& what) {
  return input_error(what, where);
}

Status check_track(const Track& track, int width, const std::string& where) {
  if (track.empty() && track.values.empty()) return {};
  if (track.width <= 0 || (width > 0 && track.width != width)) return fault(where, "key values have the wrong width");
  if (track.values.size() != track.times.size() * track.stride())
    return fault(where, "key times and values do not match");
  if (track.interpolation > KeyInterpolation::k_cubic) return fault(where, "interpolation is unknown");
  for (std::size_t i = 0; i < track.times.size(); ++i) {
    if (!usable(track.times[i])) return fault(where, "a key's time is not a finite number");
    if (i > 0 && !(track.times[i] > track.times[i - 1])) return fault(where, "key times do not ascend");
  }
  for (const double v : track.values)
    if (!usable(v)) return fault(where, "a key's value is not a finite number, or is beyond 1e9");
  return {};
}

Status check_curve(const Curve& curve, const std::string& where) {
  const std::size_t n = curve.times.size();
  if (curve.values.size() != n || (!curve.interpolation.empty() && curve.interpolation.size() != n) ||
      (!curve.handles.empty() && curve.handles.size() != n))
    return fault(where, "key times and values of a curve do not match");
  for (std::size_t i = 0; i < n; ++i) {
    if (!usable(curve.times[i])) return fault(where, "a key's time is not a finite number");
    if (i > 0 && curve.times[i] < curve.times[i - 1]) return fault(where, "key times of a curve do not ascend");
    if (!usable(curve.values[i])) return fault(where, "a key's value is not a finite number, or is beyond 1e9");
  }
  for (const CurveInterpolation how : curve.interpolation)
    if (how > CurveInterpolation::k_cubic) return fault(where, "interpolation is unknown");
  for (const CurveHandles& h : curve.handles)
    if (!std::isfinite(h.before_value) || !std::isfinite(h.after_value) || !(h.before_time >= 0 && h.after_time >= 0) ||
        !usable(h.before_time) || !usable(h.after_time))
      return fault(where, "a curve's tangent is not finite, or goes backwards in time");
  for (const CurveEnd* end : {&curve.before, &curve.after})
    if (end->rule > CurveInfinity::k_repeat_relative) return fault(where, "what follows a curve's keys is unknown");
  return {};
}

Status check_numbers(const AnimatedNumbers& numbers, const ClipCurves& set, const std::string& where) {
  if (!usable(numbers.rest)) return fault(where, "an animated number's rest is not finite");
  for (const LayeredNumbers& said : numbers.layers) {
    if (said.layer < 0 || static_cast<std::size_t>(said.layer) >= set.layers.size())
      return fault(where, "an animation layer is missing");
    if (!usable(said.fixed)) return fault(where, "an animated number is not finite");
    for (const std::int32_t c : said.curves)
      if (c < -1 || c >= static_cast<std::int32_t>(set.curves.size())) return fault(where, "a curve is missing");
  }
  return {};
}

Status check_stacks(const Clip& clip, const Character& character, const std::string& where) {
  const int node_count = static_cast<int>(character.nodes.size());
  for (const Curve& curve : clip.curves.curves)
    if (Status s = check_curve(curve, where); !s) return s;
  for (const AnimationLayer& layer : clip.curves.layers)
    if (layer.mode > LayerMode::k_blend || !std::isfinite(layer.weight) || layer.weight_curve < -1 ||
        layer.weight_curve >= static_cast<std::int32_t>(clip.curves.curves.size()))
      return fault(where, "an animation layer is of an unknown kind or has no weight");
  std::vector<char> seen(character.nodes.size(), 0);
  for (const TransformStack& stack : clip.stacks) {
    if (stack.node < 0 || stack.node >= node_count) return fault(where, "transforms move no node");
    const auto node = static_cast<std::size_t>(stack.node);
    const std::string here = where + ", node \"" + character.nodes[node].name + "\"";
    if (seen[node]++ != 0) return fault(here, "is moved by two lists of transforms");
    if (stack.inheritance > ScaleInheritance::k_compensated) return fault(here, "inherits scale in an unknown way");
    for (const ElementaryTransform& e : stack.elements) {
      if (e.kind > TransformKind::k_matrix || e.order > RotationOrder::k_zyx)
        return fault(here, "has a transform of an unknown kind");
      if (!usable(e.matrix) || !usable(e.unit) || !usable(e.axis) || !(e.axis.norm() > 0))
        return fault(here, "has a transform that is not finite");
      if (Status s = check_numbers(e.numbers, clip.curves, here); !s) return s;
    }
  }
  for (const ShapeChannel& channel : clip.shapes) {
    if (channel.node < 0 || channel.node >= node_count) return fault(where, "a shape channel belongs to no node");
    const auto& node = character.nodes[static_cast<std::size_t>(channel.node)];
    for (const ShapeChannel::Shape& shape : channel.shapes)
      if (shape.morph < 0 || static_cast<std::size_t>(shape.morph) >= node.morph_weights.size() || !usable(shape.full))
        return fault(where + ", node \"" + node.name + "\"", "a shape channel names a shape that is not there");
    if (Status s = check_numbers(channel.percent, clip.curves, where); !s) return s;
  }
  return {};
}

Status check_mesh(const CharacterMesh& mesh, int node_count) {
  const std::string where = "mesh \"" + mesh.name + "\"";
  const auto n = mesh.positions.size();
  if (mesh.node < 0 || mesh.node >= node_count) return fault(where, "belongs to no node");
  for (std::size_t i = 0; i < n; ++i)
    if (!usable(mesh.positions[i]))
      return fault(where, "vertex " + std::to_string(i) + " is not a finite position, or is beyond 1e9");
  for (const Triangle& t : mesh.triangles)
    for (const int v : t)
      if (v < 0 || static_cast<std::size_t>(v) >= n) return fault(where, "a triangle names a vertex that is not there");
  for (const SkinBone& bone : mesh.bones) {
    if (bone.node < 0 || bone.node >= node_count) return fault(where, "a bone belongs to no node");
    if (!usable(bone.inverse_bind)) return fault(where, "an inverse bind matrix is not finite");
  }
  if (mesh.bones.empty() != mesh.influence_start.empty()) return fault(where, "skin is incomplete");
  if (!mesh.bones.empty()) {
    if (mesh.influence_start.size() != n + 1 || mesh.influence_start.front() != 0 ||
        static_cast<std::size_t>(mesh.influence_start.back()) != mesh.influence_bone.size() ||
        mesh.influence_bone.size() != mesh.influence_weight.size())
      return fault(where, "skin weights do not match the vertices");
    for (std::size_t i = 0; i < n; ++i)
      if (mesh.influence_start[i + 1] < mesh.influence_start[i]) return fault(where, "skin rows do not ascend");
    for (const int b : mesh.influence_bone)
      if (b < 0 || static_cast<std::size_t>(b) >= mesh.bones.size()) return fault(where, "a weight names no bone");
    for (const double w : mesh.influence_weight)
      if (!(w > 0 && w <= 1)) return fault(where, "a skin weight is outside (0, 1]");
  } else if (!mesh.influence_bone.empty() || !mesh.influence_weight.empty()) {
    return fault(where, "skin is incomplete");
  }
  if (!mesh.dual_share.empty() && (mesh.bones.empty() || mesh.dual_share.size() != n))
    return fault(where, "shares of dual quaternions do not match the vertices");
  for (const double share : mesh.dual_share)
    if (!(share >= 0 && share <= 1)) return fault(where, "a share of dual quaternions is outside [0, 1]");
  for (const MorphTarget& morph : mesh.morphs) {
    if (morph.deltas.size() != n) return fault(where, "a morph target does not match the vertices");
    for (const Vec3& d : morph.deltas)
      if (!usable(d)) return fault(where, "morph target \"" + morph.name + "\" has a number that is not finite");
  }
  return {};
}

}  // namespace

void Clip::find_range() {
  if (has_own_range) return;
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (const Channel& c : channels)
    for (const Track* t : {&c.translation, &c.rotation, &c.scale, &c.weights})
      if (!t->empty()) first = std::min(first, t->times.front()), last = std::max(last, t->times.back());
  std::vector<std::int32_t> used;
  for (const TransformStack& stack : stacks) add_curves(stack, used);
  for (const ShapeChannel& shape : shapes) add_curves(shape.percent, used);
  for (const std::int32_t c : used) {
    const std::vector<double>& times = curves.curves[static_cast<std::size_t>(c)].times;
    if (!times.empty()) first = std::min(first, times.front()), last = std::max(last, times.back());
  }
  start = first <= last ? first : 0;
  end = first <= last ? last : 0;
}

Status check_character(const Character& character) {
  const int node_count = static_cast<int>(character.nodes.size());
  if (character.nodes.empty()) return fault("", "has no nodes");
  if (character.nodes.size() > k_max_character_nodes) return fault("", "has too many nodes");
  if (!(std::isfinite(character.file_unit) && character.file_unit >= 0)) return fault("", "unit is not a number");
  if (!character.file_axes.allFinite() ||
      !(character.file_axes * character.file_axes.transpose()).isApprox(Mat3::Identity(), 1e-9))
    return fault("", "axes are not a rotation");
  for (int i = 0; i < node_count; ++i) {
    const CharacterNode& node = character.nodes[static_cast<std::size_t>(i)];
    const std::string where = "node \"" + node.name + "\"";
    if (node.parent < -1 || node.parent >= i) return fault(where, "parent does not come before it");
    if (!usable(node.local)) return fault(where, "transform is not finite");
    for (const double w : node.morph_weights)
      if (!usable(w)) return fault(where, "a morph weight is not finite");
  }
  std::size_t vertices = 0;
  for (const CharacterMesh& mesh : character.meshes) {
    vertices += mesh.positions.size();
    if (vertices > k_max_character_vertices) return fault("", "has more than 20 million vertices");
    if (Status s = check_mesh(mesh, node_count); !s) return s;
  }
  for (const Clip& clip : character.clips) {
    const std::string where = "clip \"" + clip.name + "\"";
    if (!usable(clip.start) || !usable(clip.end) || clip.end < clip.start) return fault(where, "range is not finite");
    for (const Channel& channel : clip.channels) {
      if (channel.node < 0 || channel.node >= node_count) return fault(where, "a channel moves no node");
      const auto& name = character.nodes[static_cast<std::size_t>(channel.node)].name;
      const std::string here = where + ", node \"" + name + "\"";
      for (const auto& [track, width] : {std::pair<const Track*, int>{&channel.translation, 3},
                                         {&channel.rotation, 4},
                                         {&channel.scale, 3},
                                         {&channel.weights, 0}})
        if (Status s = check_track(*track, width, here); !s) return s;
    }
    if (Status s = check_stacks(clip, character, where); !s) return s;
  }
  return {};
}

}  // namespace ft::inline io
