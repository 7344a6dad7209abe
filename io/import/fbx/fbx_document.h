// The objects of an FBX file by id, and how they are connected. Still nothing is interpreted: a "Model" is a node of
// the scene, a "Geometry" a mesh, a "Deformer" a skin, and so on, as the FBX SDK names them. Two objects may share a
// name; they are told apart by their id alone.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "baker/core/types.h"
#include "io/import/fbx/fbx_tree.h"

namespace ft::inline io {

struct FbxObject {
  std::int64_t id = 0;
  std::string kind;     ///< "Model", "Geometry", "Deformer", "AnimationCurve", ...
  std::string name;     ///< without its kind
  std::string subkind;  ///< "Mesh", "LimbNode", "Skin", "Cluster", ...
  const FbxNode* node = nullptr;
  const FbxNode* properties = nullptr;  ///< its own Properties70; null when it has none
  const FbxNode* defaults = nullptr;    ///< Properties70 of the file's Definitions; null when there are none

  /// The entry `P: name, type, label, flags, values...`: the object's own, else the default, else null. Of several of
  /// one name the last counts.
  const FbxNode* property(std::string_view property_name) const;
  bool has_own(std::string_view property_name) const;
  double number(std::string_view property_name, double otherwise) const;
  std::int64_t integer(std::string_view property_name, std::int64_t otherwise) const;
  /// All three numbers, or `otherwise`.
  Vec3 vector(std::string_view property_name, const Vec3& otherwise) const;
  std::string text(std::string_view property_name) const;
};

/// `source` belongs to `destination`, or to a property of it. The scene itself is 0.
struct FbxConnection {
  std::int64_t source = 0, destination = 0;
  std::string source_property, destination_property;  ///< empty: the object itself
};

class FbxDocument {
 public:
  /// As read_fbx_tree(); a file without objects is refused.
  static Result<FbxDocument> read(std::span<const std::byte> data);

  FbxDocument(FbxDocument&&) = default;
  FbxDocument& operator=(FbxDocument&&) = default;
  FbxDocument(const FbxDocument&) = delete;
  FbxDocument& operator=(const FbxDocument&) = delete;

  int version() const { return tree_->version; }
  const FbxNode& root() const { return tree_->root; }
  std::span<const FbxObject> objects() const { return objects_; }  ///< in the file's order
  /// Null when there is none. Of several objects with one id the first counts.
  const FbxObject* object(std::int64_t id) const;
  /// What is connected to an object, in the file's order.
  std::span<const FbxConnection> into(std::int64_t destination) const;
  /// What an object is connected to, in the file's order.
  std::span<const FbxConnection> out_of(std::int64_t source) const;
  /// Objects of a kind (and subkind, unless that is empty) that are connected to an object itself, each once.
  std::vector<const FbxObject*> members(std::int64_t destination, std::string_view kind,
                                        std::string_view subkind = {}) const;
  /// The same of what is connected to its properties.
  std::vector<const FbxObject*> members_of_properties(std::int64_t destination, std::string_view kind) const;
  /// GlobalSettings: units, axes, frame rate. Without properties when the file has none.
  const FbxObject& settings() const { return settings_; }
  /// Objects whose id an earlier one has; they are left out.
  int duplicate_count() const { return duplicate_count_; }

 private:
  FbxDocument() = default;
  void read_objects();
  void read_connections();

  std::unique_ptr<const FbxTree> tree_;  // pointers into it stay good when the document moves
  std::vector<FbxObject> objects_;
  std::unordered_map<std::int64_t, std::size_t> index_;
  std::vector<FbxConnection> by_destination_, by_source_;
  FbxObject settings_;
  int duplicate_count_ = 0;
};

}  // namespace ft::inline io
