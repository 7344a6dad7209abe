#include "io/import/gltf/gltf_contents.h"

#include <algorithm>
#include <map>

#include "io/import/gltf/gltf_extensions.h"

namespace ft::inline io::gltf {
namespace {

std::vector<std::string> extension_names(const Json& list) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < size_of_array(list); ++i)
    if (std::string name = text(list[i]); !name.empty() && std::find(out.begin(), out.end(), name) == out.end())
      out.push_back(std::move(name));
  return out;
}

/// Where extensions are used: how often, and by which node first.
struct Uses {
  std::int64_t count = 0, first_node = -1;
};

/// All objects below a value, without recursion.
void count_uses(const Json& top, std::int64_t node, std::map<std::string, Uses>& uses) {
  std::vector<const Json*> stack{&top};
  while (!stack.empty()) {
    const Json& value = *stack.back();
    stack.pop_back();
    if (!value.is_structured()) continue;
    if (const Json& extensions = member(value, "extensions"); extensions.is_object())
      for (const auto& [name, content] : extensions.items()) {
        Uses& of = uses[name];
        ++of.count;
        if (of.first_node < 0) of.first_node = node;
      }
    for (const auto& child : value) stack.push_back(&child);
  }
}

std::map<std::string, Uses> all_uses(const Json& json) {
  std::map<std::string, Uses> uses;
  for (const auto& [key, value] : json.items()) {
    if (key == "nodes")
      for (std::size_t n = 0; n < size_of_array(value); ++n) count_uses(value[n], static_cast<std::int64_t>(n), uses);
    else if (key == "extensions")
      for (const auto& [name, content] : value.items()) ++uses[name].count;
    else
      count_uses(value, -1, uses);
  }
  return uses;
}

struct Counts {
  std::int64_t primitives = 0, targets = 0, joints = 0, sparse = 0, channels = 0;
};

Counts count_parts(const Json& json) {
  Counts out;
  const auto each = [](const Json& list, const auto& visit) {
    for (std::size_t i = 0; i < size_of_array(list); ++i) visit(list[i]);
  };
  each(member(json, "meshes"), [&](const Json& mesh) {
    std::size_t most = 0;
    each(member(mesh, "primitives"), [&](const Json& primitive) {
      ++out.primitives;
      most = std::max(most, size_of_array(member(primitive, "targets")));
    });
    out.targets += static_cast<std::int64_t>(most);
  });
  each(member(json, "skins"),
       [&](const Json& skin) { out.joints += static_cast<std::int64_t>(size_of_array(member(skin, "joints"))); });
  each(member(json, "accessors"), [&](const Json& accessor) { out.sparse += accessor.contains("sparse"); });
  each(member(json, "animations"), [&](const Json& animation) {
    out.channels += static_cast<std::int64_t>(size_of_array(member(animation, "channels")));
  });
  return out;
}

}  // namespace

Status check_required(const Json& json) {
  for (const std::string& name : extension_names(member(json, "extensionsRequired"))) {
    const ExtensionUse use = extension_use(name);
    if (use == ExtensionUse::k_not_used || use == ExtensionUse::k_unknown)
      return input_error("the file requires the extension " + name +
                         ", which is not read (extensionsRequired); export it without");
  }
  return {};
}

void describe_contents(const Json& json, const std::vector<int>& node_of, Character& out) {
  const auto add = [&](const char* what, std::int64_t count, std::string use) {
    if (count > 0) out.contents.push_back({what, count, std::move(use)});
  };
  const auto size = [&](const char* list) { return static_cast<std::int64_t>(size_of_array(member(json, list))); };
  const Counts counts = count_parts(json);
  add("scenes", size("scenes"), size("scenes") > 1 ? "the default scene is used" : "used");
  const auto in_scene = std::count_if(node_of.begin(), node_of.end(), [](int n) { return n >= 0; });
  add("nodes", size("nodes"),
      in_scene == size("nodes") ? "used" : "used: " + std::to_string(in_scene) + ", the others are in no scene read");
  add("meshes", size("meshes"), "used: " + std::to_string(out.meshes.size()) + " pieces at nodes of the scene");
  add("primitives", counts.primitives, "used: those of triangles");
  add("skins", size("skins"), "used");
  add("joints", counts.joints, "used");
  add("morph targets", counts.targets, "used: positions; normals and tangents are not");
  add("animations", size("animations"), "used");
  add("animation channels", counts.channels, "used: those of nodes of the scene");
  add("sparse accessors", counts.sparse, "used");
  add("cameras", size("cameras"), "not used: they are no body");
  add("materials", size("materials"), "not used: a body has no looks");
  add("images", size("images"), "not used: a body has no looks");

  std::map<std::string, Uses> uses = all_uses(json);
  for (const std::string& name : extension_names(member(json, "extensionsUsed"))) uses[name];
  for (const auto& [name, of] : uses) {
    const ExtensionUse use = extension_use(name);
    const bool is_read = use == ExtensionUse::k_read, looks = use == ExtensionUse::k_appearance;
    const std::int64_t count = std::max<std::int64_t>(of.count, 1);
    out.contents.push_back({"extension " + name, count,
                            is_read                           ? "used"
                            : looks                           ? "not used: it does not change shapes or motion"
                            : use == ExtensionUse::k_not_used ? "not used: it is not evaluated"
                                                              : "not used: it is not known"});
    if (is_read || looks || of.count == 0) continue;
    std::string note = use == ExtensionUse::k_not_used
                           ? name + " is not evaluated; shapes or motion that it makes are missing"
                           : "the extension " + name + " is not known; if it makes shapes or motion, they are missing";
    note += " (used " + std::to_string(of.count) + " times";
    if (of.first_node >= 0) note += ", the first node is " + named(json, "nodes", of.first_node);
    out.notes.push_back(note + ")");
  }
}

}  // namespace ft::inline io::gltf
