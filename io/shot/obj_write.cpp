// OBJ writer: what read_obj reads back to the same mesh. Numbers in the fewest digits that name the same double.
#include <algorithm>
#include <charconv>
#include <iterator>

#include "baker/core/file.h"
#include "io/shot/mesh_file.h"

namespace ft::inline io {
namespace {

void put(std::string& out, double value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  out.push_back(' ');
  out.append(digits, end);
}

bool is_colour(const VertexGroup& group) {
  return group.name == "red" || group.name == "green" || group.name == "blue";
}

/// Weight of each vertex in the group of that name; empty when there is none.
std::vector<double> channel(const Mesh& mesh, std::string_view name) {
  for (const VertexGroup& group : mesh.groups) {
    if (group.name != name) continue;
    std::vector<double> out(mesh.positions.size(), 0.0);
    for (std::size_t i = 0; i < group.vertices.size(); ++i)
      out[static_cast<std::size_t>(group.vertices[i])] = group.weights[i];
    return out;
  }
  return {};
}

/// membership[v]: indices of the groups that hold vertex v with weight 1.
std::vector<std::vector<int>> memberships(const Mesh& mesh) {
  std::vector<std::vector<int>> out(mesh.positions.size());
  for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
    if (is_colour(mesh.groups[g])) continue;
    for (std::size_t i = 0; i < mesh.groups[g].vertices.size(); ++i)
      if (mesh.groups[g].weights[i] == 1.0)
        out[static_cast<std::size_t>(mesh.groups[g].vertices[i])].push_back(static_cast<int>(g));
  }
  return out;
}

}  // namespace

Status write_obj(const std::filesystem::path& path, const Mesh& mesh) {
  if (!all_finite(mesh.positions)) return output_error("a vertex is not finite, nothing is written", path.string());
  std::string out;
  out.reserve(mesh.positions.size() * 64 + mesh.face_vertices.size() * 16);
  const std::vector<double> red = channel(mesh, "red"), green = channel(mesh, "green"), blue = channel(mesh, "blue");
  const bool coloured = !red.empty() || !green.empty() || !blue.empty();
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    out.push_back('v');
    for (int k = 0; k < 3; ++k) put(out, mesh.positions[i][k]);
    if (coloured)
      for (const auto* c : {&red, &green, &blue}) put(out, c->empty() ? 0.0 : (*c)[i]);
    out.push_back('\n');
  }
  for (const Vec2& uv : mesh.uvs) {
    out += "vt";
    put(out, uv[0]), put(out, uv[1]);
    out.push_back('\n');
  }
  const auto groups_of = memberships(mesh);
  std::vector<int> in_force, shared, next;
  std::size_t corner = 0;
  for (const int size : mesh.face_sizes) {
    const auto first = corner;
    shared = groups_of[static_cast<std::size_t>(mesh.face_vertices[first])];
    for (int k = 1; k < size; ++k) {
      const auto& other = groups_of[static_cast<std::size_t>(mesh.face_vertices[first + static_cast<std::size_t>(k)])];
      next.clear();
      std::set_intersection(shared.begin(), shared.end(), other.begin(), other.end(), std::back_inserter(next));
      shared.swap(next);
    }
    if (shared != in_force) {
      out.push_back('g');
      for (const int g : shared) out.append(1, ' ').append(mesh.groups[static_cast<std::size_t>(g)].name);
      out.push_back('\n');
      in_force = shared;
    }
    out.push_back('f');
    for (int k = 0; k < size; ++k, ++corner) {
      out.append(1, ' ').append(std::to_string(mesh.face_vertices[corner] + 1));
      if (!mesh.face_uvs.empty()) out.append(1, '/').append(std::to_string(mesh.face_uvs[corner] + 1));
    }
    out.push_back('\n');
  }
  for (std::size_t s = 0, end = 0; s < mesh.stitches.size(); s = end) {
    while (end < mesh.stitches.size() && mesh.stitches[end].seam == mesh.stitches[s].seam) ++end;
    out += "seam " + std::to_string(end - s) + "\n";
    for (std::size_t k = s; k < end; ++k) {
      const Stitch& stitch = mesh.stitches[k];
      out += "stitch";
      for (const int v : {stitch.vertex, stitch.edge[0], stitch.edge[1]}) out.append(1, ' ').append(std::to_string(v));
      put(out, stitch.place);
      out.push_back('\n');
    }
  }
  return write_text_durably(path, out);
}

}  // namespace ft::inline io
