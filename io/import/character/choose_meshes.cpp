#include "io/import/character/choose_meshes.h"

#include <algorithm>
#include <unordered_set>

#include "io/import/character/clips.h"

namespace ft::inline io {
namespace {

const std::string& name_of(const CharacterMesh& mesh, const Character& character) {
  const std::string& node = character.nodes[at(mesh.node)].name;
  return node.empty() ? mesh.name : node;
}

bool named(const CharacterMesh& mesh, const Character& character, const std::vector<std::string>& names,
           std::vector<char>& seen) {
  bool found = false;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (mesh.name == names[i] || character.nodes[at(mesh.node)].name == names[i]) seen[i] = 1, found = true;
  return found;
}

std::string quoted(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "\"" : ", \"") + name + "\"";
  return out;
}

}  // namespace

std::vector<std::string> mesh_names(const Character& character) {
  std::vector<std::string> out;
  std::unordered_set<std::string> seen;
  for (const CharacterMesh& mesh : character.meshes)
    if (const std::string& name = name_of(mesh, character); seen.insert(name).second) out.push_back(name);
  return out;
}

std::vector<int> visible_meshes(const Character& character, std::vector<std::string>& hidden) {
  std::vector<int> out;
  std::unordered_set<std::string> seen;
  for (std::size_t m = 0; m < character.meshes.size(); ++m) {
    const CharacterMesh& mesh = character.meshes[m];
    if (mesh.visible)
      out.push_back(static_cast<int>(m));
    else if (!mesh.triangles.empty() && seen.insert(name_of(mesh, character)).second)
      hidden.push_back(name_of(mesh, character));
  }
  return out;
}

std::string hidden_note(const std::vector<std::string>& hidden) {
  if (hidden.empty()) return {};
  return "the file hides " + quoted(hidden) + ": left out of the collider; to take it in, name it: meshes = [\"" +
         hidden.front() + "\", ...]";
}

Result<std::vector<int>> choose_meshes(const Character& character, const std::vector<std::string>& names,
                                       const std::string& file, std::vector<std::string>& notes) {
  std::vector<int> out;
  std::vector<char> seen(names.size(), 0);
  std::vector<std::string> hidden;
  if (names.empty()) {
    out = visible_meshes(character, hidden);
  } else {
    for (std::size_t m = 0; m < character.meshes.size(); ++m)
      if (named(character.meshes[m], character, names, seen)) out.push_back(static_cast<int>(m));
  }
  std::erase_if(out, [&](int m) { return character.meshes[at(m)].triangles.empty(); });
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (seen[i]) continue;
    const auto existing = mesh_names(character);
    std::string hint;
    for (const std::string& name : existing) hint += (hint.empty() ? "there are: " : ", ") + name;
    if (const std::string guess = nearest_name(names[i], existing); !guess.empty())
      hint = "did you mean \"" + guess + "\"? " + hint;
    return usage_error("mesh \"" + names[i] + "\" does not exist", file, hint);
  }
  if (out.empty() && !hidden.empty())
    return input_error("hides all of its meshes with triangles", file,
                       "name those that make the body: meshes = [" + quoted(hidden) + "]");
  if (out.empty())
    return input_error("has no mesh with triangles", file,
                       "if it holds only the animation, give the character as file = and this as animation =");
  if (std::string note = hidden_note(hidden); !note.empty()) notes.push_back(std::move(note));
  return out;
}

}  // namespace ft::inline io
