// The node tree of an FBX file, version 7: names, properties and children as they stand in the file, binary (32-bit and
// 64-bit offsets, zlib arrays) or text. Nothing is interpreted here. The binary layout follows the public description
// of the Blender developers; text files carry the same tree. A count, an offset or a decompressed size is checked
// against the bytes that are there before anything is allocated.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "baker/core/bytes.h"
#include "baker/core/result.h"

namespace ft::inline io {

/// A value of a node. Text files have whole numbers (int64) and fractions (double) only, singly or in arrays; `string`
/// also holds raw bytes.
using FbxProperty =
    std::variant<std::int64_t, double, std::string, std::vector<std::uint8_t>, std::vector<std::int32_t>,
                 std::vector<std::int64_t>, std::vector<float>, std::vector<double>>;

struct FbxNode {
  std::string name;
  std::vector<FbxProperty> properties;
  std::vector<FbxNode> children;

  /// The first child of that name; null when there is none.
  const FbxNode* child(std::string_view child_name) const;
};

struct FbxTree {
  int version = 0;  ///< 7400 is FBX 7.4
  bool text = false;
  FbxNode root;  ///< without a name; its children are the top nodes of the file
};

/// Nodes below each other; deeper files are refused.
inline constexpr int k_max_fbx_depth = 64;
/// All arrays of one file together [bytes].
inline constexpr std::uint64_t k_max_fbx_array_bytes = std::uint64_t{2} << 30;

/// Bytes at the start of a file that is_fbx() looks at.
inline constexpr std::size_t k_fbx_head = 4096;

/// Whether the bytes are an FBX file of any version, by their content.
bool is_fbx(std::span<const std::byte> data);

/// Versions below 7 and big-endian files are refused by name. Nodes that are about looks alone (layers of normals,
/// colours and texture coordinates, embedded pictures) are left out.
Result<FbxTree> read_fbx_tree(std::span<const std::byte> data);

// Values of a property, or of a whole node: its array, or its single values in turn.

std::int64_t fbx_integer(const FbxNode& node, std::size_t index, std::int64_t otherwise = 0);
double fbx_number(const FbxNode& node, std::size_t index, double otherwise = 0);
/// Empty when the property is not there or is no text.
const std::string& fbx_text(const FbxNode& node, std::size_t index);
/// Of a null node: empty.
std::vector<double> fbx_numbers(const FbxNode* node);
std::vector<float> fbx_floats(const FbxNode* node);
std::vector<std::int64_t> fbx_integers(const FbxNode* node);
std::vector<std::int32_t> fbx_indices(const FbxNode* node);

// For the two parsers.

Result<FbxTree> read_fbx_binary(std::span<const std::byte> data);
Result<FbxTree> read_fbx_text(std::string_view text);
/// A node that nothing here needs.
bool is_fbx_decoration(std::string_view name);
/// The refusal of a version below 7.
Error old_fbx_error(int version);

}  // namespace ft::inline io
