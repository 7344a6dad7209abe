// Parts of a skinned surface: body segments that move as one. Each vertex belongs to its heaviest bone; bones whose
// piece is small (fingers, eyes, twist bones) give it to the bone above, so that a part is a hand, a forearm, a thigh.
#include <algorithm>
#include <cctype>
#include <cmath>

#include "io/import/body/skin.h"

namespace ft::inline io {
namespace {

/// A part below this share of the body is no segment of its own. A hand is 0.6 %, a finger 0.07 % (Dempster 1955).
constexpr double k_least_share = 0.002;

bool is_twist(const std::string& name) {
  std::string lower;
  for (const char c : name) lower.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
  return lower.find("twist") != std::string::npos || lower.find("roll") != std::string::npos;
}

/// Volume of each group's piece: tetrahedra from the piece's own centre, so that an open end costs little.
std::vector<double> volumes(std::span<const Vec3> positions, const std::vector<Triangle>& triangles,
                            const std::vector<int>& group, std::size_t groups) {
  std::vector<Vec3> centre(groups, Vec3::Zero());
  std::vector<double> area(groups, 0), volume(groups, 0);
  const auto at = [&](int v) -> const Vec3& { return positions[static_cast<std::size_t>(v)]; };
  const auto group_of = [&](const Triangle& t) {  // of two corners that agree, else the first
    const int a = group[static_cast<std::size_t>(t[0])], b = group[static_cast<std::size_t>(t[1])],
              c = group[static_cast<std::size_t>(t[2])];
    return static_cast<std::size_t>(b == c ? b : a);
  };
  for (const Triangle& t : triangles) {
    const double a = triangle_area(at(t[0]), at(t[1]), at(t[2]));
    area[group_of(t)] += a;
    centre[group_of(t)] += a / 3 * (at(t[0]) + at(t[1]) + at(t[2]));
  }
  for (std::size_t g = 0; g < groups; ++g)
    if (area[g] > 0) centre[g] /= area[g];
  for (const Triangle& t : triangles) {
    const Vec3& c = centre[group_of(t)];
    volume[group_of(t)] += (at(t[0]) - c).dot((at(t[1]) - c).cross(at(t[2]) - c)) / 6;
  }
  for (std::size_t g = 0; g < groups; ++g) volume[g] = std::max(std::abs(volume[g]), 1e-12 + 1e-6 * area[g]);
  return volume;
}

/// The node that really moves each node: itself when a clip moves it or it is a bone, else the next such one above. A
/// rigid shell hung on a bone is a piece of that bone.
std::vector<int> carriers(const Character& character) {
  std::vector<char> moves(character.nodes.size(), 0);
  for (const Clip& clip : character.clips) {
    for (const Channel& channel : clip.channels) moves[static_cast<std::size_t>(channel.node)] = 1;
    for (const TransformStack& stack : clip.stacks) moves[static_cast<std::size_t>(stack.node)] = 1;
  }
  for (const CharacterMesh& mesh : character.meshes)
    for (const SkinBone& bone : mesh.bones) moves[static_cast<std::size_t>(bone.node)] = 1;
  std::vector<int> out;
  for (std::size_t i = 0; i < character.nodes.size(); ++i) {
    const int parent = character.nodes[i].parent;
    out.push_back(moves[i] || parent < 0 ? static_cast<int>(i) : out[static_cast<std::size_t>(parent)]);
  }
  return out;
}

}  // namespace

void assign_parts(const Character& character, std::span<const Vec3> positions, Skin& skin) {
  const std::size_t nodes = character.nodes.size();
  const std::vector<int> carrier = carriers(character);
  std::vector<int> node_of_vertex(skin.base.size());
  for (std::size_t i = 0; i < skin.base.size(); ++i) {
    std::vector<std::pair<double, int>> by_node;  // several bindings may be of one node
    for (int k = skin.start[i]; k < skin.start[i + 1]; ++k) {
      const int node = skin.bindings[static_cast<std::size_t>(skin.binding[static_cast<std::size_t>(k)])].node;
      by_node.push_back({skin.weight[static_cast<std::size_t>(k)], -carrier[static_cast<std::size_t>(node)]});
    }
    node_of_vertex[i] = -std::max_element(by_node.begin(), by_node.end())->second;
  }
  std::vector<double> size = volumes(positions, skin.surface.triangles, node_of_vertex, nodes);
  std::vector<char> used(nodes, 0);
  for (const int n : node_of_vertex) used[static_cast<std::size_t>(n)] = 1;
  double total = 0;
  for (std::size_t n = 0; n < nodes; ++n) total += used[n] ? size[n] : 0;

  // Leaves first: what is too small goes to the nearest part above, if there is one.
  std::vector<int> merged(nodes);
  for (std::size_t n = 0; n < nodes; ++n) merged[n] = static_cast<int>(n);
  const auto part_above = [&](std::size_t n) {
    int p = character.nodes[n].parent;
    while (p >= 0 && !used[static_cast<std::size_t>(p)]) p = character.nodes[static_cast<std::size_t>(p)].parent;
    return p;
  };
  for (std::size_t n = nodes; n-- > 0;) {
    if (!used[n] || (size[n] >= k_least_share * total && !is_twist(character.nodes[n].name))) continue;
    const int above = part_above(n);
    if (above < 0) continue;
    merged[n] = above;
    size[static_cast<std::size_t>(above)] += size[n];
    used[n] = 0;
  }
  // A small part with nothing above it joins its largest neighbour below.
  for (std::size_t n = 0; n < nodes; ++n) {
    if (!used[n] || size[n] >= k_least_share * total) continue;
    int best = -1;
    for (std::size_t c = n + 1; c < nodes; ++c)
      if (used[c] && part_above(c) == static_cast<int>(n) &&
          (best < 0 || size[c] > size[static_cast<std::size_t>(best)]))
        best = static_cast<int>(c);
    if (best < 0) continue;
    merged[n] = best;
    size[static_cast<std::size_t>(best)] += size[n];
    used[n] = 0;
  }

  std::vector<int> part_of_node(nodes, -1);
  Surface& surface = skin.surface;
  surface.parts.clear();
  for (std::size_t n = 0; n < nodes; ++n)
    if (used[n]) {
      part_of_node[n] = static_cast<int>(surface.parts.size());
      surface.parts.push_back({character.nodes[n].name, -1, size[n]});
    }
  for (std::size_t n = 0; n < nodes; ++n)
    if (used[n])
      if (const int above = part_above(n); above >= 0)
        surface.parts[static_cast<std::size_t>(part_of_node[n])].parent = part_of_node[static_cast<std::size_t>(above)];
  surface.part_of_vertex.resize(skin.base.size());
  for (std::size_t i = 0; i < skin.base.size(); ++i) {
    int n = node_of_vertex[i];
    while (merged[static_cast<std::size_t>(n)] != n) n = merged[static_cast<std::size_t>(n)];
    surface.part_of_vertex[i] = part_of_node[static_cast<std::size_t>(n)];
  }
  // Small pieces without a part above (separate rigid shells) stay parts. The heaviest root is everybody's parent of
  // last resort.
  int root = -1;
  for (int p = 0; p < static_cast<int>(surface.parts.size()); ++p)
    if (surface.parts[static_cast<std::size_t>(p)].parent < 0 &&
        (root < 0 ||
         surface.parts[static_cast<std::size_t>(p)].size > surface.parts[static_cast<std::size_t>(root)].size))
      root = p;
  for (int p = 0; p < static_cast<int>(surface.parts.size()); ++p)
    if (p != root && surface.parts[static_cast<std::size_t>(p)].parent < 0)
      surface.parts[static_cast<std::size_t>(p)].parent = root;
}

}  // namespace ft::inline io
