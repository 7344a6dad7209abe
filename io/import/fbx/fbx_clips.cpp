#include "io/import/fbx/fbx_clips.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <set>

#include "io/import/character/name_list.h"
#include "io/import/fbx/fbx_curves.h"
#include "io/import/fbx/fbx_transform.h"

namespace ft::inline io {
namespace {

/// Which numbers are animated: a property of an object.
using AnimatedProperty = std::pair<std::int64_t, std::string>;

/// Properties of a Model that change how it stands and are not evaluated when they are animated.
constexpr const char* k_not_evaluated[] = {
    "RotationOrder",    "RotationActive",           "InheritType", "GeometricTranslation", "GeometricRotation",
    "GeometricScaling", "RotationSpaceForLimitOnly"};

std::string seconds(double s) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f s", s);
  return text;
}

class ClipReader {
 public:
  ClipReader(const FbxDocument& document, std::span<const FbxObject* const> models,
             std::span<const FbxShapeChannel> shapes, Character& out)
      : document_(document), models_(models), shapes_(shapes), out_(out), ticks_(fbx_ticks_per_second(document)) {}

  void read() {
    int empty = 0;
    std::int64_t stack_count = 0;
    for (const FbxObject& object : document_.objects()) {
      if (object.kind != "AnimationStack") continue;
      Clip clip;
      clip.name = object.name.empty() ? "animation_" + std::to_string(stack_count) : object.name;
      ++stack_count;
      read_stack(object, clip);
      if (clip.moved_count() == 0) {
        ++empty;
        continue;
      }
      out_.clips.push_back(std::move(clip));
    }
    describe(stack_count, empty);
  }

 private:
  void read_stack(const FbxObject& stack, Clip& clip) {
    index_of_curve_.clear();
    animated_.clear();
    read_layers(stack, clip);
    add_stacks(clip);
    add_shapes(clip);
    find_range(stack, clip);
  }

  void read_layers(const FbxObject& stack, Clip& clip) {
    const auto layers = document_.members(stack.id, "AnimationLayer");
    const bool solo =
        std::any_of(layers.begin(), layers.end(), [](const FbxObject* l) { return l->integer("Solo", 0) != 0; });
    for (std::size_t l = 0; l < layers.size(); ++l) {
      const FbxObject& object = *layers[l];
      ++layer_count_;
      if (solo ? object.integer("Solo", 0) == 0 : object.integer("Mute", 0) != 0) {
        ++silent_layers_;
        continue;
      }
      const auto layer = static_cast<std::int32_t>(clip.curves.layers.size());
      clip.curves.layers.push_back(read_layer(object, l == 0, clip));
      for (const FbxObject* values : document_.members(object.id, "AnimationCurveNode"))
        for (const FbxConnection& to : document_.out_of(values->id))
          if (!to.destination_property.empty() && to.destination != object.id) add_values(*values, to, layer, clip);
    }
  }

  AnimationLayer read_layer(const FbxObject& object, bool is_first, Clip& clip) {
    AnimationLayer out;
    if (is_first) return out;  // whatever it says: there is nothing below it
    const std::int64_t mode = object.integer("BlendMode", 0);
    out.mode = mode == 0 ? LayerMode::k_additive : mode == 2 ? LayerMode::k_blend : LayerMode::k_override;
    const double weight = object.number("Weight", 100) / 100;
    out.weight = weight > 0.99999 ? 1 : std::max(weight, 0.0);
    out.composes_rotations = object.integer("RotationAccumulationMode", 0) == 0;
    out.multiplies_scales = object.integer("ScaleAccumulationMode", 0) == 0;
    for (const FbxConnection& from : document_.into(object.id))
      if (from.destination_property == "Weight" && out.weight_curve < 0)
        if (const FbxObject* values = document_.object(from.source); values != nullptr)
          out.weight_curve = curves_of(*values, clip)[0];
    return out;
  }

  /// The curves of x, y and z of an AnimationCurveNode; -1: none.
  std::array<std::int32_t, 3> curves_of(const FbxObject& values, Clip& clip) {
    std::array<std::int32_t, 3> out{-1, -1, -1};
    for (const FbxConnection& from : document_.into(values.id)) {
      const FbxObject* object = document_.object(from.source);
      if (object == nullptr || object->kind != "AnimationCurve") continue;
      const std::string& to = from.destination_property;
      const std::size_t k = to == "d|Y" || to == "Y" ? 1 : to == "d|Z" || to == "Z" ? 2 : 0;
      const auto [found, is_new] = index_of_curve_.try_emplace(object->id, -1);
      if (is_new) {
        Curve curve = read_fbx_curve(*object, document_.version(), ticks_, faults_);
        ++curve_count_;
        if (!curve.empty()) {
          found->second = static_cast<std::int32_t>(clip.curves.curves.size());
          clip.curves.curves.push_back(std::move(curve));
        }
      }
      if (found->second >= 0) out[k] = found->second;
    }
    return out;
  }

  void add_values(const FbxObject& values, const FbxConnection& to, std::int32_t layer, Clip& clip) {
    AnimatedNumbers& numbers = animated_[{to.destination, to.destination_property}];
    if (!numbers.layers.empty() && numbers.layers.back().layer == layer) return;  // the first one holds
    LayeredNumbers said;
    said.layer = layer;
    const std::string single = "d|" + to.destination_property;
    said.fixed = {values.number("d|X", values.number("X", values.number(single, 0))),
                  values.number("d|Y", values.number("Y", 0)), values.number("d|Z", values.number("Z", 0))};
    said.curves = curves_of(values, clip);
    numbers.layers.push_back(said);
  }

  const AnimatedNumbers* find(std::int64_t object, const std::string& property) const {
    const auto found = animated_.find({object, property});
    return found == animated_.end() ? nullptr : &found->second;
  }

  static bool moves(const AnimatedNumbers* numbers) {
    std::vector<std::int32_t> curves;
    if (numbers != nullptr) add_curves(*numbers, curves);
    return !curves.empty();
  }

  /// Nodes whose transform is animated, and those whose matrix depends on one through the scale that they inherit.
  std::vector<char> nodes_to_move(const std::vector<FbxTransform>& transforms) const {
    const std::size_t n = models_.size();
    std::vector<char> wanted(n, 0), passes(n, 0);  // passes: hands on a scale that moves
    const auto parent_of = [&](std::size_t i) { return out_.nodes[i].parent; };
    for (std::size_t i = 0; i < n; ++i) {
      if (models_[i] == nullptr) continue;
      const FbxTransform& t = transforms[i];
      for (const std::string& property : t.properties) wanted[i] |= find(models_[i]->id, property) != nullptr;
      passes[i] = moves(find(models_[i]->id, "Lcl Scaling"));
      if (t.stack.inheritance == ScaleInheritance::k_product || parent_of(i) < 0) continue;
      const char above = passes[static_cast<std::size_t>(parent_of(i))];
      wanted[i] |= above, passes[i] |= above;
    }
    for (std::size_t i = n; i-- > 0;)
      if (wanted[i] && transforms[i].stack.inheritance != ScaleInheritance::k_product && parent_of(i) >= 0 &&
          models_[static_cast<std::size_t>(parent_of(i))] != nullptr)
        wanted[static_cast<std::size_t>(parent_of(i))] = 1;
    return wanted;
  }

  void add_stacks(Clip& clip) {
    std::vector<FbxTransform> transforms(models_.size());
    for (std::size_t i = 0; i < models_.size(); ++i)
      if (models_[i] != nullptr) transforms[i] = fbx_transform(*models_[i], static_cast<int>(i), true);
    const std::vector<char> wanted = nodes_to_move(transforms);
    for (std::size_t i = 0; i < models_.size(); ++i) {
      if (models_[i] == nullptr) continue;
      const FbxObject& model = *models_[i];
      for (const char* property : k_not_evaluated)
        if (moves(find(model.id, property))) not_evaluated_[property].insert(model.name);
      if (!wanted[i]) continue;
      FbxTransform& t = transforms[i];
      TransformStack stack{t.stack.node, t.stack.inheritance, {}};
      for (std::size_t e = 0; e < t.stack.elements.size(); ++e) {
        ElementaryTransform& element = t.stack.elements[e];
        const AnimatedNumbers* numbers = find(model.id, t.properties[e]);
        if (numbers != nullptr) element.numbers.layers = numbers->layers;
        const Vec3 none = Vec3::Constant(element.kind == TransformKind::k_scale ? 1 : 0);
        if (numbers != nullptr || element.numbers.rest != none) stack.elements.push_back(std::move(element));
      }
      clip.stacks.push_back(std::move(stack));
    }
  }

  void add_shapes(Clip& clip) {
    for (const FbxShapeChannel& shape : shapes_) {
      const AnimatedNumbers* numbers = find(shape.object, shape.property);
      if (numbers == nullptr || shape.node < 0 || shape.shapes.empty()) continue;
      ShapeChannel channel{shape.node, shape.shapes, *numbers};
      channel.percent.rest = Vec3(shape.percent, 0, 0);
      clip.shapes.push_back(std::move(channel));
    }
  }

  void find_range(const FbxObject& stack, Clip& clip) {
    clip.find_range();
    const double first = clip.start, last = clip.end;
    for (const auto& [from, to] : {std::pair{"LocalStart", "LocalStop"}, {"ReferenceStart", "ReferenceStop"}}) {
      const double start = static_cast<double>(stack.integer(from, 0)) / ticks_;
      const double end = static_cast<double>(stack.integer(to, 0)) / ticks_;
      if (!(end > start) || !(std::abs(start) < 1e6 && end < 1e6)) continue;
      clip.start = start, clip.end = end, clip.has_own_range = true;
      break;
    }
    if (clip.has_own_range && clip.moved_count() > 0 && (first < clip.start - 0.02 || last > clip.end + 0.02))
      out_.notes.push_back("clip \"" + clip.name + "\" plays " + seconds(clip.start) + " to " + seconds(clip.end) +
                           ", as the file says; its keys reach from " + seconds(first) + " to " + seconds(last));
  }

  void describe(std::int64_t stack_count, int empty) {
    const auto content = [&](const char* what, std::int64_t count, std::string use) {
      if (count > 0) out_.contents.push_back({what, count, std::move(use)});
    };
    content("animation stacks", stack_count,
            empty == 0 ? "used: a clip each"
                       : "used: a clip each, but for " + std::to_string(empty) + " that move nothing");
    content("animation layers", layer_count_,
            silent_layers_ == 0 ? "used"
                                : "used, but for " + std::to_string(silent_layers_) + " that are muted or not soloed");
    content("animation curves", curve_count_, "used where they move nodes or shapes");
    for (const auto& [property, names] : not_evaluated_)
      out_.notes.push_back("keys of " + property + " are not evaluated: it stays as it is at rest on " +
                           name_list(names));
    if (faults_.damaged > 0)
      out_.notes.push_back(std::to_string(faults_.damaged) +
                           " animation curves are damaged (keys, values and flags do "
                           "not match) and were left out; export the file again");
    if (faults_.unordered > 0)
      out_.notes.push_back(std::to_string(faults_.unordered) + " keys were earlier than the one before; dropped");
    if (faults_.velocity > 0)
      out_.notes.push_back(std::to_string(faults_.velocity) +
                           " animation curves have tangents with velocities, which "
                           "are not evaluated: bake the animation to keys to be sure");
    std::set<std::string> spherical;
    for (const FbxObject* model : models_)
      if (model != nullptr && fbx_transform(*model, 0, false).spherical) spherical.insert(model->name);
    if (!spherical.empty())
      out_.notes.push_back("rotation order \"spheric XYZ\" is evaluated as XYZ on " + name_list(spherical));
  }

  const FbxDocument& document_;
  std::span<const FbxObject* const> models_;
  std::span<const FbxShapeChannel> shapes_;
  Character& out_;
  double ticks_;
  std::map<std::int64_t, std::int32_t> index_of_curve_;  // into the clip's curves
  std::map<AnimatedProperty, AnimatedNumbers> animated_;
  FbxCurveFaults faults_;
  std::int64_t layer_count_ = 0, silent_layers_ = 0, curve_count_ = 0;
  std::map<std::string, std::set<std::string>> not_evaluated_;
};

}  // namespace

void read_fbx_clips(const FbxDocument& document, std::span<const FbxObject* const> models,
                    std::span<const FbxShapeChannel> shapes, Character& out) {
  ClipReader(document, models, shapes, out).read();
}

}  // namespace ft::inline io
