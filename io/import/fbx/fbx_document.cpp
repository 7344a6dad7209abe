#include "io/import/fbx/fbx_document.h"

#include <algorithm>
#include <unordered_set>

namespace ft::inline io {
namespace {

const FbxNode* find_property(const FbxNode* list, std::string_view name) {
  if (list == nullptr) return nullptr;
  for (auto p = list->children.rbegin(); p != list->children.rend(); ++p)
    if (!p->properties.empty() && fbx_text(*p, 0) == name) return &*p;
  return nullptr;
}

/// Bytes of a character of UTF-8 at a place; 0 when there is none.
std::size_t character_length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned char first = byte(at);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xc2 && first < 0xe0   ? 2
                             : first >= 0xe0 && first < 0xf0 ? 3
                             : first < 0xf5                  ? 4
                                                             : 0;
  if (first < 0xc2 || length == 0 || at + length > text.size()) return 0;
  for (std::size_t k = 1; k < length; ++k)
    if ((byte(at + k) & 0xc0) != 0x80) return 0;
  return length;
}

/// The name as text that can be printed: what is no UTF-8, and control characters, become the sign for that.
std::string printable(const std::string& name) {
  std::string out;
  for (std::size_t at = 0; at < name.size();) {
    const std::size_t length = character_length(name, at);
    if (length == 0 || static_cast<unsigned char>(name[at]) < 0x20)
      out += "\xef\xbf\xbd", ++at;
    else
      out.append(name, at, length), at += length;
  }
  return out;
}

/// "Model::hips" in text files, "hips\0\1Model" in binary ones.
std::string name_alone(const std::string& full, bool text) {
  const std::size_t at = full.find(text ? std::string_view("::") : std::string_view("\0\1", 2));
  if (at == std::string::npos) return printable(full);
  return printable(text ? full.substr(at + 2) : full.substr(0, at));
}

/// Properties70 of each kind of object, as Definitions gives them.
std::unordered_map<std::string, const FbxNode*> read_defaults(const FbxNode& root) {
  std::unordered_map<std::string, const FbxNode*> out;
  const FbxNode* definitions = root.child("Definitions");
  if (definitions == nullptr) return out;
  for (const FbxNode& type : definitions->children) {
    if (type.name != "ObjectType") continue;
    if (const FbxNode* first = type.child("PropertyTemplate"); first != nullptr)
      if (const FbxNode* list = first->child("Properties70"); list != nullptr) out.emplace(fbx_text(type, 0), list);
  }
  return out;
}

}  // namespace

const FbxNode* FbxObject::property(std::string_view property_name) const {
  const FbxNode* own = find_property(properties, property_name);
  return own != nullptr ? own : find_property(defaults, property_name);
}

bool FbxObject::has_own(std::string_view property_name) const {
  return find_property(properties, property_name) != nullptr;
}

double FbxObject::number(std::string_view property_name, double otherwise) const {
  const FbxNode* p = property(property_name);
  return p != nullptr ? fbx_number(*p, 4, otherwise) : otherwise;
}

std::int64_t FbxObject::integer(std::string_view property_name, std::int64_t otherwise) const {
  const FbxNode* p = property(property_name);
  return p != nullptr ? fbx_integer(*p, 4, otherwise) : otherwise;
}

Vec3 FbxObject::vector(std::string_view property_name, const Vec3& otherwise) const {
  const FbxNode* p = property(property_name);
  if (p == nullptr || p->properties.size() < 7) return otherwise;
  return {fbx_number(*p, 4, otherwise.x()), fbx_number(*p, 5, otherwise.y()), fbx_number(*p, 6, otherwise.z())};
}

std::string FbxObject::text(std::string_view property_name) const {
  const FbxNode* p = property(property_name);
  return p != nullptr ? fbx_text(*p, 4) : std::string();
}

Result<FbxDocument> FbxDocument::read(std::span<const std::byte> data) {
  auto tree = read_fbx_tree(data);
  if (!tree) return tree.error();
  FbxDocument out;
  out.tree_ = std::make_unique<const FbxTree>(std::move(*tree));
  if (out.root().child("Objects") == nullptr)
    return input_error("is an FBX file without objects", "", "it may be cut: copy or export it again");
  out.read_objects();
  out.read_connections();
  return out;
}

void FbxDocument::read_objects() {
  const auto defaults = read_defaults(root());
  for (const FbxNode& list : root().children) {
    if (list.name == "GlobalSettings" && settings_.node == nullptr) {
      settings_.kind = list.name, settings_.node = &list, settings_.properties = list.child("Properties70");
      if (const auto found = defaults.find(list.name); found != defaults.end()) settings_.defaults = found->second;
    }
    if (list.name != "Objects") continue;
    for (const FbxNode& node : list.children) {
      if (node.properties.empty()) continue;
      FbxObject object;
      object.id = fbx_integer(node, 0);
      object.kind = node.name;
      object.name = name_alone(fbx_text(node, 1), tree_->text);
      object.subkind = fbx_text(node, 2);
      object.node = &node;
      object.properties = node.child("Properties70");
      if (const auto found = defaults.find(node.name); found != defaults.end()) object.defaults = found->second;
      if (object.id == 0 || !index_.emplace(object.id, objects_.size()).second)
        ++duplicate_count_;
      else
        objects_.push_back(std::move(object));
    }
  }
}

void FbxDocument::read_connections() {
  for (const FbxNode& list : root().children) {
    if (list.name != "Connections") continue;
    for (const FbxNode& node : list.children) {
      const std::string& type = fbx_text(node, 0);
      if (type.size() != 2 || node.name != "C") continue;
      FbxConnection c;
      std::size_t next = 1;
      c.source = fbx_integer(node, next++);
      if (type[0] == 'P') c.source_property = fbx_text(node, next++);
      c.destination = fbx_integer(node, next++);
      if (type[1] == 'P') c.destination_property = fbx_text(node, next++);
      if (next <= node.properties.size()) by_destination_.push_back(std::move(c));
    }
  }
  by_source_ = by_destination_;
  std::stable_sort(by_destination_.begin(), by_destination_.end(),
                   [](const auto& a, const auto& b) { return a.destination < b.destination; });
  std::stable_sort(by_source_.begin(), by_source_.end(),
                   [](const auto& a, const auto& b) { return a.source < b.source; });
}

const FbxObject* FbxDocument::object(std::int64_t id) const {
  const auto found = index_.find(id);
  return found != index_.end() ? &objects_[found->second] : nullptr;
}

std::span<const FbxConnection> FbxDocument::into(std::int64_t destination) const {
  const auto first = std::lower_bound(by_destination_.begin(), by_destination_.end(), destination,
                                      [](const FbxConnection& c, std::int64_t id) { return c.destination < id; });
  const auto last = std::upper_bound(first, by_destination_.end(), destination,
                                     [](std::int64_t id, const FbxConnection& c) { return id < c.destination; });
  return {first, last};
}

std::span<const FbxConnection> FbxDocument::out_of(std::int64_t source) const {
  const auto first = std::lower_bound(by_source_.begin(), by_source_.end(), source,
                                      [](const FbxConnection& c, std::int64_t id) { return c.source < id; });
  const auto last = std::upper_bound(first, by_source_.end(), source,
                                     [](std::int64_t id, const FbxConnection& c) { return id < c.source; });
  return {first, last};
}

std::vector<const FbxObject*> FbxDocument::members(std::int64_t destination, std::string_view kind,
                                                   std::string_view subkind) const {
  std::vector<const FbxObject*> out;
  std::unordered_set<const FbxObject*> seen;
  for (const FbxConnection& c : into(destination)) {
    if (!c.destination_property.empty() || !c.source_property.empty()) continue;
    const FbxObject* source = object(c.source);
    if (source == nullptr || source->kind != kind || (!subkind.empty() && source->subkind != subkind)) continue;
    if (seen.insert(source).second) out.push_back(source);
  }
  return out;
}

std::vector<const FbxObject*> FbxDocument::members_of_properties(std::int64_t destination,
                                                                 std::string_view kind) const {
  std::vector<const FbxObject*> out;
  for (const FbxConnection& c : into(destination)) {
    const FbxObject* source = c.destination_property.empty() ? nullptr : object(c.source);
    if (source != nullptr && source->kind == kind) out.push_back(source);
  }
  return out;
}

}  // namespace ft::inline io
