// A Collada file as XML: elements by id, numbers of sources, and which node of the scene became which node of a
// character that has the same tree.
#pragma once

#include <filesystem>
#include <memory>
#include <pugixml.hpp>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "io/import/character/character.h"

namespace ft::inline io {

/// Numbers or words of a source, in rows.
struct ColladaRows {
  std::size_t width = 0;  ///< numbers or words in a row, without those that have no name
  std::vector<double> numbers;
  std::vector<std::string> words;
  std::size_t count() const { return width == 0 ? 0 : std::max(numbers.size(), words.size()) / width; }
};

class ColladaFile {
 public:
  static Result<ColladaFile> open(const std::filesystem::path& path);

  pugi::xml_node root() const { return document_->document_element(); }
  /// The element of a reference ("#id"); an empty one when there is none.
  pugi::xml_node find(const std::string& reference) const;
  /// An error when its accessor does not fit its array.
  Result<ColladaRows> source(const std::string& reference) const;
  /// The <visual_scene> that is shown.
  pugi::xml_node scene() const;
  /// Metres in a unit of the file.
  double unit() const;

 private:
  std::unique_ptr<pugi::xml_document> document_;
  std::unordered_map<std::string, pugi::xml_node> by_id_;
};

using ColladaNode = std::pair<pugi::xml_node, int>;  ///< <node> and a node of the character

/// Every use of a <node> in the scene with its node in the character, parents first; empty when the trees differ.
std::vector<ColladaNode> match_collada_nodes(const ColladaFile& file, const Character& character);

/// The file's text with an identity in place of each <bind_shape_matrix> that a skin does without (it may; assimp 5.2.5
/// then takes what the memory holds); empty when no skin does.
std::string with_bind_shape_matrices(const ColladaFile& file);

/// The next element of a walk through all below `top`, parents first; an empty one at the end.
pugi::xml_node next_element(pugi::xml_node element, const pugi::xml_node& top);

/// Values of a row under the name of one <param>: a matrix or a vector has several.
std::size_t collada_columns(const pugi::xml_node& param);

/// Numbers of a text, separated by white space; what is no number ends them.
std::vector<double> collada_numbers(const char* text);
std::vector<std::string> collada_words(const char* text);

}  // namespace ft::inline io
