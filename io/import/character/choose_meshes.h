// Which meshes of a character make the collider.
#pragma once

#include <string>
#include <vector>

#include "io/import/character/character.h"

namespace ft::inline io {

/// Each name once: of the node that has the mesh, else of the mesh.
std::vector<std::string> mesh_names(const Character& character);

/// Indices of the meshes that the file shows; names of those with triangles that it hides are added to `hidden`.
std::vector<int> visible_meshes(const Character& character, std::vector<std::string>& hidden);
/// One sentence; empty where nothing is hidden.
std::string hidden_note(const std::vector<std::string>& hidden);

/// Indices of the meshes with triangles that have one of the names, their own or that of their node; without names all
/// that the file shows, and a note names what it hides. An unknown name is an error that lists those that exist; so is
/// nothing left.
Result<std::vector<int>> choose_meshes(const Character& character, const std::vector<std::string>& names,
                                       const std::string& file, std::vector<std::string>& notes);

}  // namespace ft::inline io
