#include "io/import/fbx/fbx_scene.h"

#include <algorithm>

#include "io/import/fbx/fbx_transform.h"

namespace ft::inline io {
int FbxScene::node_of(const FbxObject* model) const {
  const auto found = model != nullptr ? node_of_model.find(model->id) : node_of_model.end();
  return found != node_of_model.end() ? found->second : -1;
}

namespace {

/// A handle of a control rig, which moves joints in its own program only.
bool is_effector(const FbxObject& model) {
  return model.subkind == "FKEffector" || model.subkind == "IKEffector";
}

/// Models that are no handle of a control rig, and all above them.
std::vector<char> models_to_keep(const std::vector<const FbxObject*>& models, const std::vector<std::size_t>& parent,
                                 std::size_t none) {
  std::vector<char> kept(models.size(), 0);
  for (std::size_t m = 0; m < models.size(); ++m) {
    if (is_effector(*models[m])) continue;
    for (std::size_t up = m; up != none && !kept[up]; up = parent[up]) kept[up] = 1;
  }
  return kept;
}

}  // namespace

Result<FbxScene> read_fbx_nodes(const FbxDocument& document, Character& out) {
  FbxScene scene;
  std::vector<const FbxObject*> models;
  std::unordered_map<std::int64_t, std::size_t> index;
  for (const FbxObject& object : document.objects())
    if (object.kind == "Model") index.emplace(object.id, models.size()), models.push_back(&object);
  if (models.size() > k_max_character_nodes) return input_error("has more than 200,000 nodes");

  // Each model below one other; of several the last in the file, which is how other readers draw it.
  constexpr std::size_t k_none = static_cast<std::size_t>(-1);
  std::vector<std::size_t> parent(models.size(), k_none);
  std::vector<std::vector<std::size_t>> children(models.size());
  std::vector<std::size_t> roots;
  std::string several;
  for (std::size_t m = 0; m < models.size(); ++m) {
    bool more = false;
    for (const FbxConnection& c : document.out_of(models[m]->id)) {
      const auto found =
          c.destination_property.empty() && c.source_property.empty() ? index.find(c.destination) : index.end();
      if (found == index.end()) continue;
      more = more || (parent[m] != k_none && parent[m] != found->second);
      if (parent[m] == k_none || found->second > parent[m]) parent[m] = found->second;
    }
    if (more) several += (several.empty() ? "\"" : ", \"") + models[m]->name + "\"";
    if (parent[m] == k_none) roots.push_back(m);
  }
  std::vector<char> listed(models.size(), 0);
  for (std::size_t m = 0; m < models.size(); ++m)
    for (const FbxConnection& c : document.into(models[m]->id)) {
      const auto found = index.find(c.source);
      if (found == index.end() || parent[found->second] != m || listed[found->second]) continue;
      listed[found->second] = 1;
      children[m].push_back(found->second);
    }
  if (!several.empty()) out.notes.push_back("nodes stand below several others, and were put below one: " + several);

  const std::vector<char> kept = models_to_keep(models, parent, k_none);
  const auto left_out = static_cast<std::size_t>(std::count(kept.begin(), kept.end(), 0));
  if (left_out > 0)
    out.contents.push_back({"handles of a control rig", static_cast<std::int64_t>(left_out),
                            "not used: only keys on joints move the body"});

  struct Visit {
    std::size_t model;
    int parent;
  };
  std::vector<Visit> stack;
  for (auto r = roots.rbegin(); r != roots.rend(); ++r) stack.push_back({*r, -1});
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    if (!kept[visit.model]) continue;
    const int node = static_cast<int>(out.nodes.size());
    out.nodes.push_back({models[visit.model]->name, visit.parent, Mat4::Identity(), {}});
    scene.models.push_back(models[visit.model]);
    scene.node_of_model.emplace(models[visit.model]->id, node);
    const auto& below = children[visit.model];
    for (auto c = below.rbegin(); c != below.rend(); ++c) stack.push_back({*c, node});
  }
  if (out.nodes.size() + left_out < models.size()) {
    for (std::size_t m = 0; m < models.size(); ++m)
      if (kept[m] && scene.node_of(models[m]) < 0)
        return input_error("is damaged: node \"" + models[m]->name + "\" stands below itself", "",
                           "open the file in its program and export it again");
  }
  std::vector<int> parents(out.nodes.size());
  std::vector<Mat4> locals(out.nodes.size(), Mat4::Identity());
  for (std::size_t i = 0; i < parents.size(); ++i) parents[i] = out.nodes[i].parent;
  fbx_rest_locals(scene.models, parents, locals);
  for (std::size_t i = 0; i < parents.size(); ++i) out.nodes[i].local = locals[i];
  if (out.nodes.empty()) return input_error("has no nodes: there is nothing in its scene");
  return scene;
}

}  // namespace ft::inline io
