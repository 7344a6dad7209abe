#include "io/import/fbx/fbx_transform.h"

namespace ft::inline io {

FbxTransform fbx_transform(const FbxObject& model, int node, bool whole) {
  FbxTransform out;
  out.stack.node = node;
  const std::int64_t inherits = model.integer("InheritType", 1);
  out.stack.inheritance = inherits == 0   ? ScaleInheritance::k_componentwise
                          : inherits == 2 ? ScaleInheritance::k_compensated
                                          : ScaleInheritance::k_product;
  // Without its own space of rotation a model turns about x, y, z and has no pre- and post-rotation.
  const bool own_space = model.integer("RotationActive", 1) != 0 && model.integer("RotationSpaceForLimitOnly", 0) == 0;
  RotationOrder order = RotationOrder::k_xyz;
  if (const std::int64_t asked = model.integer("RotationOrder", 0); own_space) {
    if (asked > 0 && asked <= 5) order = static_cast<RotationOrder>(asked);
    out.spherical = asked == 6;
  }
  const auto add = [&](TransformKind kind, const char* property, double otherwise, bool inverted,
                       RotationOrder turns = RotationOrder::k_xyz) {
    const Vec3 none = Vec3::Constant(otherwise), value = model.vector(property, none);
    if (!whole && value == none) return;
    ElementaryTransform e;
    e.kind = kind, e.order = turns, e.inverted = inverted;
    e.numbers.rest = value;
    out.stack.elements.push_back(std::move(e));
    out.properties.emplace_back(property);
  };
  using enum TransformKind;
  add(k_translate, "Lcl Translation", 0, false);
  add(k_translate, "RotationOffset", 0, false);
  add(k_translate, "RotationPivot", 0, false);
  if (own_space) add(k_rotate, "PreRotation", 0, false);
  add(k_rotate, "Lcl Rotation", 0, false, order);
  if (own_space) add(k_rotate, "PostRotation", 0, true);
  add(k_translate, "RotationPivot", 0, true);
  add(k_translate, "ScalingOffset", 0, false);
  add(k_translate, "ScalingPivot", 0, false);
  add(k_scale, "Lcl Scaling", 1, false);
  add(k_translate, "ScalingPivot", 0, true);
  return out;
}

void fbx_rest_locals(std::span<const FbxObject* const> models, std::span<const int> parents, std::span<Mat4> locals) {
  ScalePassing passing(models.size());
  const ClipCurves none;
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (models[i] == nullptr) continue;
    const FbxTransform transform = fbx_transform(*models[i], static_cast<int>(i), false);
    locals[i] = passing.local(static_cast<int>(i), parents[i], transform.stack.inheritance,
                              stack_pose(transform.stack, none, 0));
  }
}

}  // namespace ft::inline io
