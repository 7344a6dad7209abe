#include "io/import/character/one_root.h"

#include <algorithm>

namespace ft::inline io {

void put_one_root(Character& character) {
  const auto is_root = [](const CharacterNode& node) { return node.parent < 0; };
  if (std::count_if(character.nodes.begin(), character.nodes.end(), is_root) < 2) return;
  CharacterNode root;
  root.name = "RootNode";
  for (CharacterNode& node : character.nodes) ++node.parent;
  character.nodes.insert(character.nodes.begin(), std::move(root));
  for (CharacterMesh& mesh : character.meshes) {
    ++mesh.node;
    for (SkinBone& bone : mesh.bones) ++bone.node;
  }
  for (Clip& clip : character.clips) {
    for (Channel& channel : clip.channels) ++channel.node;
    for (TransformStack& stack : clip.stacks) ++stack.node;
    for (ShapeChannel& shape : clip.shapes) ++shape.node;
  }
}

}  // namespace ft::inline io
