#include "io/import/fbx/fbx_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ft::inline io {
namespace {

constexpr std::string_view k_binary_magic = "Kaydara FBX Binary";

std::string_view as_text(std::span<const std::byte> data) {
  return {reinterpret_cast<const char*>(data.data()), data.size()};
}

template <class To, class From>
To convert(From value) {
  if constexpr (std::is_integral_v<To> && std::is_floating_point_v<From>) {
    constexpr double k_limit = sizeof(To) == 8 ? 9.2e18 : 2147483647.0;
    return std::isfinite(value) ? static_cast<To>(std::clamp(static_cast<double>(value), -k_limit, k_limit)) : To{0};
  } else if constexpr (std::is_same_v<To, std::int32_t> && std::is_same_v<From, std::int64_t>) {
    return static_cast<To>(std::clamp<From>(value, std::numeric_limits<To>::min(), std::numeric_limits<To>::max()));
  } else {
    return static_cast<To>(value);
  }
}

/// The node's array, or its single numbers in turn.
template <class To>
std::vector<To> values_of(const FbxNode* node) {
  std::vector<To> out;
  if (node == nullptr) return out;
  for (const FbxProperty& property : node->properties)
    std::visit(
        [&](const auto& value) {
          using Value = std::decay_t<decltype(value)>;
          if constexpr (std::is_arithmetic_v<Value>) {
            out.push_back(convert<To>(value));
          } else if constexpr (!std::is_same_v<Value, std::string>) {
            out.reserve(out.size() + value.size());
            for (const auto v : value) out.push_back(convert<To>(v));
          }
        },
        property);
  return out;
}

}  // namespace

const FbxNode* FbxNode::child(std::string_view child_name) const {
  for (const FbxNode& node : children)
    if (node.name == child_name) return &node;
  return nullptr;
}

bool is_fbx_decoration(std::string_view name) {
  constexpr std::array k_names{"Layer", "Content", "Edges", "Normals", "NormalsW", "Thumbnail", "Media"};
  return name.starts_with("LayerElement") || std::find(k_names.begin(), k_names.end(), name) != k_names.end();
}

Error old_fbx_error(int version) {
  return input_error("is FBX " + std::to_string(version / 1000) + "." + std::to_string(version / 100 % 10) +
                         ", a format that is not read",
                     "", "export it as FBX 7.4 (2014/2015) binary");
}

bool is_fbx(std::span<const std::byte> data) {
  const std::string_view text = as_text(data);
  if (text.starts_with(k_binary_magic)) return true;
  const std::string_view head = text.substr(0, k_fbx_head);
  if (head.find('\0') != std::string_view::npos) return false;
  std::string_view rest = head.starts_with("\xef\xbb\xbf") ? head.substr(3) : head;
  // Comments and blank lines may stand before the first node.
  while (!rest.empty()) {
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r\n"), rest.size()));
    if (!rest.starts_with(";")) break;
    const std::string_view line = rest.substr(0, rest.find('\n'));
    if (line.substr(1, 8).find("FBX") != std::string_view::npos) return true;
    rest.remove_prefix(line.size());
  }
  return rest.starts_with("FBXHeaderExtension");
}

Result<FbxTree> read_fbx_tree(std::span<const std::byte> data) {
  const std::string_view text = as_text(data);
  return text.starts_with(k_binary_magic) ? read_fbx_binary(data) : read_fbx_text(text);
}

std::int64_t fbx_integer(const FbxNode& node, std::size_t index, std::int64_t otherwise) {
  if (index >= node.properties.size()) return otherwise;
  if (const auto* v = std::get_if<std::int64_t>(&node.properties[index])) return *v;
  if (const auto* v = std::get_if<double>(&node.properties[index])) return convert<std::int64_t>(*v);
  return otherwise;
}

double fbx_number(const FbxNode& node, std::size_t index, double otherwise) {
  if (index >= node.properties.size()) return otherwise;
  if (const auto* v = std::get_if<double>(&node.properties[index])) return *v;
  if (const auto* v = std::get_if<std::int64_t>(&node.properties[index])) return static_cast<double>(*v);
  return otherwise;
}

const std::string& fbx_text(const FbxNode& node, std::size_t index) {
  static const std::string k_empty;
  if (index >= node.properties.size()) return k_empty;
  const auto* text = std::get_if<std::string>(&node.properties[index]);
  return text != nullptr ? *text : k_empty;
}

std::vector<double> fbx_numbers(const FbxNode* node) {
  return values_of<double>(node);
}
std::vector<float> fbx_floats(const FbxNode* node) {
  return values_of<float>(node);
}
std::vector<std::int64_t> fbx_integers(const FbxNode* node) {
  return values_of<std::int64_t>(node);
}
std::vector<std::int32_t> fbx_indices(const FbxNode* node) {
  return values_of<std::int32_t>(node);
}

}  // namespace ft::inline io
