#include "io/import/collada/collada_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <sstream>

namespace ft::inline io {
namespace {

constexpr int k_max_depth = 1000;
constexpr const char* k_spaces = " \t\r\n";

/// Name without a prefix ("collada:node").
std::string kind_of(const pugi::xml_node& element) {
  const std::string name = element.name();
  const auto colon = name.find(':');
  return colon == std::string::npos ? name : name.substr(colon + 1);
}

/// <node> elements directly below one, then those that are instanced there: the order in which assimp has them.
std::vector<pugi::xml_node> nodes_below(const ColladaFile& file, const pugi::xml_node& element) {
  std::vector<pugi::xml_node> out, instances;
  for (const pugi::xml_node child : element.children()) {
    if (kind_of(child) == "node") out.push_back(child);
    if (kind_of(child) == "instance_node")
      if (const pugi::xml_node shown = file.find(child.attribute("url").value())) instances.push_back(shown);
  }
  out.insert(out.end(), instances.begin(), instances.end());
  return out;
}

}  // namespace

std::vector<std::string> collada_words(const char* text) {
  std::vector<std::string> out;
  for (const char* p = text + std::strspn(text, k_spaces); *p != '\0'; p += std::strspn(p, k_spaces)) {
    const std::size_t length = std::strcspn(p, k_spaces);
    out.emplace_back(p, length);
    p += length;
  }
  return out;
}

std::vector<double> collada_numbers(const char* text) {
  std::vector<double> out;
  const char* end = text + std::strlen(text);
  for (const char* p = text + std::strspn(text, k_spaces); p != end; p += std::strspn(p, k_spaces)) {
    if (*p == '+') ++p;
    double value = 0;
    const auto [after, error] = std::from_chars(p, end, value);
    if (error != std::errc() || after == p) break;
    out.push_back(value);
    p = after;
  }
  return out;
}

pugi::xml_node next_element(pugi::xml_node element, const pugi::xml_node& top) {
  if (element.first_child()) return element.first_child();
  while (element && element != top && !element.next_sibling()) element = element.parent();
  return element == top ? pugi::xml_node() : element.next_sibling();
}

std::size_t collada_columns(const pugi::xml_node& param) {
  const std::string type = param.attribute("type").value();
  return type == "float4x4"   ? 16
         : type == "float3x3" ? 9
         : type == "float4"   ? 4
         : type == "float3"   ? 3
         : type == "float2"   ? 2
                              : 1;
}

Result<ColladaFile> ColladaFile::open(const std::filesystem::path& path) {
  ColladaFile file;
  file.document_ = std::make_unique<pugi::xml_document>();
  const pugi::xml_parse_result read = file.document_->load_file(path.c_str());
  if (!read) return input_error(std::string("is no XML that can be read (") + read.description() + ")");
  for (pugi::xml_node n = file.root(); n; n = next_element(n, file.root()))
    if (const pugi::xml_attribute id = n.attribute("id")) file.by_id_.emplace(id.value(), n);
  return file;
}

pugi::xml_node ColladaFile::find(const std::string& reference) const {
  const auto found = by_id_.find(reference.starts_with('#') ? reference.substr(1) : reference);
  return found == by_id_.end() ? pugi::xml_node() : found->second;
}

Result<ColladaRows> ColladaFile::source(const std::string& reference) const {
  const pugi::xml_node source = find(reference);
  const pugi::xml_node accessor = source.child("technique_common").child("accessor");
  const pugi::xml_node array = find(accessor.attribute("source").value());
  if (!source || !accessor || !array) return input_error("source \"" + reference + "\" is not there");
  std::vector<std::string> words;
  std::vector<double> numbers;
  const bool is_text = kind_of(array) == "Name_array" || kind_of(array) == "IDREF_array";
  if (is_text)
    words = collada_words(array.child_value());
  else
    numbers = collada_numbers(array.child_value());
  const std::size_t total = is_text ? words.size() : numbers.size();
  const std::size_t stride = accessor.attribute("stride").as_ullong(1),
                    offset = accessor.attribute("offset").as_ullong();
  const std::size_t count = accessor.attribute("count").as_ullong();
  const auto too_few = [&] {
    return input_error("source \"" + reference + "\" has fewer values than its accessor says", "",
                       "copy or export the file again");
  };
  if (stride == 0 || stride > total || count > total || offset > total) return too_few();
  std::vector<std::size_t> columns;
  std::size_t column = 0;
  bool named = false;
  for (const pugi::xml_node param : accessor.children("param")) named = named || param.attribute("name");
  for (const pugi::xml_node param : accessor.children("param")) {
    const std::size_t wide = collada_columns(param);
    for (std::size_t k = 0; k < wide; ++k, ++column)
      if (!named || param.attribute("name")) columns.push_back(column);
  }
  if (columns.empty())
    for (std::size_t k = 0; k < stride; ++k) columns.push_back(k);
  if (columns.back() >= stride || (count > 0 && (count - 1) * stride + columns.back() + offset >= total))
    return too_few();
  ColladaRows rows;
  rows.width = columns.size();
  for (std::size_t row = 0; row < count; ++row)
    for (const std::size_t c : columns) {
      const std::size_t index = offset + row * stride + c;
      if (is_text)
        rows.words.push_back(words[index]);
      else
        rows.numbers.push_back(numbers[index]);
    }
  return rows;
}

pugi::xml_node ColladaFile::scene() const {
  const pugi::xml_node shown = root().child("scene").child("instance_visual_scene");
  if (const pugi::xml_node scene = find(shown.attribute("url").value())) return scene;
  return root().child("library_visual_scenes").child("visual_scene");
}

double ColladaFile::unit() const {
  const double metres = root().child("asset").child("unit").attribute("meter").as_double(1);
  return std::isfinite(metres) && metres > 0 ? metres : 1;
}

std::string with_bind_shape_matrices(const ColladaFile& file) {
  bool changed = false;
  for (const pugi::xml_node library : file.root().children("library_controllers"))
    for (const pugi::xml_node controller : library.children("controller"))
      for (pugi::xml_node skin : controller.children("skin")) {
        if (skin.child("bind_shape_matrix")) continue;
        skin.prepend_child("bind_shape_matrix").text().set("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
        changed = true;
      }
  if (!changed) return {};
  std::ostringstream out;
  file.root().print(out, "", pugi::format_raw);
  return out.str();
}

std::vector<ColladaNode> match_collada_nodes(const ColladaFile& file, const Character& character) {
  std::vector<std::vector<int>> children(character.nodes.size());
  for (std::size_t i = 1; i < character.nodes.size(); ++i)
    if (const int parent = character.nodes[i].parent; parent >= 0)
      children[static_cast<std::size_t>(parent)].push_back(static_cast<int>(i));
  std::vector<ColladaNode> out;
  if (character.nodes.empty() || !file.scene()) return out;
  struct Pair {
    pugi::xml_node element;
    int node;
    int depth;
  };
  std::vector<Pair> stack{{file.scene(), 0, 0}};
  while (!stack.empty()) {
    const Pair top = stack.back();
    stack.pop_back();
    const auto below = nodes_below(file, top.element);
    const auto& nodes = children[static_cast<std::size_t>(top.node)];
    if (below.size() != nodes.size() || top.depth > k_max_depth) return {};
    for (std::size_t k = below.size(); k-- > 0;) {
      const std::string id = below[k].attribute("id").value(), sid = below[k].attribute("sid").value();
      const std::string& name = character.nodes[static_cast<std::size_t>(nodes[k])].name;
      if ((!id.empty() && id != name) || (id.empty() && !sid.empty() && sid != name)) return {};
      stack.push_back({below[k], nodes[k], top.depth + 1});
    }
    if (top.depth > 0) out.emplace_back(top.element, top.node);
  }
  return out;
}

}  // namespace ft::inline io
