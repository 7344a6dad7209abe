#include "io/import/fbx/fbx_contents.h"

#include <algorithm>

namespace ft::inline io {
namespace {

struct Kind {
  const char* what;     ///< plural
  const char* kind;     ///< of the objects
  const char* subkind;  ///< "": any
  const char* use;      ///< "used", or the reason
  bool noted;           ///< a body or its motion may be wrong without it
};

// The first row that fits an object counts it.
constexpr Kind k_kinds[] = {
    {"meshes", "Geometry", "Mesh", "used", false},
    {"blend shapes", "Geometry", "Shape", "used", false},
    {"lines", "Geometry", "Line", "not used: no surface", false},
    {"NURBS curves", "Geometry", "NurbsCurve", "not used: no surface", false},
    {"NURBS surfaces", "Geometry", "NurbsSurface", "not used: convert them to polygons", true},
    {"NURBS surfaces", "Geometry", "TrimNurbsSurface", "not used: convert them to polygons", true},
    {"NURBS boundaries", "Geometry", "Boundary", "not used: part of trimmed surfaces", false},
    {"patches", "Geometry", "Patch", "not used: convert them to polygons", true},
    {"other geometries", "Geometry", "", "not used: of a kind that is not read", true},
    {"skins", "Deformer", "Skin", "used", false},
    {"clusters of skins", "Deformer", "Cluster", "used", false},
    {"blend shape deformers", "Deformer", "BlendShape", "used", false},
    {"blend shape channels", "Deformer", "BlendShapeChannel", "used", false},
    {"vertex caches", "Deformer", "VertexCacheDeformer",
     "not used: bake them to a geometry cache (.abc, .mdd, .pc2) and give that as file", true},
    {"other deformers", "Deformer", "", "not used: of a kind that is not read", true},
    {"character rigs (HumanIK)", "Constraint", "Character", "not used: only keys on joints move the body; bake them",
     true},
    {"IK constraints", "Constraint", "Single Chain IK", "not used: bake the animation to the joints", true},
    {"constraints", "Constraint", "", "not used: bake the animation to the joints", true},
    {"level-of-detail groups", "NodeAttribute", "LodGroup",
     "all levels are taken together: choose one with meshes = [...]", true},
    {"level-of-detail groups", "NodeAttribute", "LODGroup",
     "all levels are taken together: choose one with meshes = [...]", true},
    {"bind poses", "Pose", "BindPose", "used where a skin has no bind matrices of its own", false},
    {"materials", "Material", "", "not used", false},
    {"textures", "Texture", "", "not used", false},
    {"cameras", "NodeAttribute", "Camera", "not used", false},
    {"lights", "NodeAttribute", "Light", "not used", false},
};
constexpr std::size_t k_most_names = 5;

struct Found {
  std::int64_t count = 0;
  std::vector<std::string> names;
};

/// Of the object itself, or of the first model it is connected to where it has none.
std::string name_of(const FbxDocument& document, const FbxObject& object) {
  for (const FbxConnection& c : document.out_of(object.id))
    if (const FbxObject* model = document.object(c.destination); model != nullptr && model->kind == "Model")
      return model->name;
  return object.name;
}

std::string listed(const Found& found) {
  std::string out;
  for (const std::string& name : found.names) out += (out.empty() ? "\"" : ", \"") + name + "\"";
  if (static_cast<std::size_t>(found.count) > found.names.size()) out += ", ...";
  return out;
}

}  // namespace

void list_fbx_contents(const FbxDocument& document, Character& out) {
  std::vector<Found> found(std::size(k_kinds));
  for (const FbxObject& object : document.objects())
    for (std::size_t k = 0; k < found.size(); ++k) {
      if (object.kind != k_kinds[k].kind || (*k_kinds[k].subkind != 0 && object.subkind != k_kinds[k].subkind))
        continue;
      ++found[k].count;
      if (k_kinds[k].noted && found[k].names.size() < k_most_names) found[k].names.push_back(name_of(document, object));
      break;
    }
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (found[k].count == 0) continue;
    const Kind& kind = k_kinds[k];
    out.contents.push_back({kind.what, found[k].count, kind.use});
    if (kind.noted)
      out.notes.push_back(std::to_string(found[k].count) + " " + kind.what + " (" + listed(found[k]) +
                          "): " + kind.use);
  }
  if (document.duplicate_count() > 0)
    out.notes.push_back(std::to_string(document.duplicate_count()) +
                        " objects have no id, or that of another; they were left out");
}

}  // namespace ft::inline io
