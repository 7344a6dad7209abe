// Judges a garment before it is simulated: for the artist, all faults in one message, with counts and the first places.
// Caution: two vertices at one place start in contact with themselves and are never equal for a solver; so are seams
// that were modelled as separate borders. They are refused rather than joined silently, because joining changes the
// vertex count.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "io/shot/mesh_file.h"

namespace ft::inline io {
namespace {

/// Twice the area of a triangle over its longest edge squared; below it the rest shape cannot be inverted in double
/// precision without losing more than ten digits.
constexpr double k_flat_triangle = 1e-10;
/// Vertices nearer than this fraction of the bounding diagonal are at one place: the sixth decimal of a file in metres.
constexpr double k_same_place = 1e-7;

/// "3 faces (12, 15, 99)", "1 face (12)", "90 faces (1, 2, 3, ...)".
std::string places(std::size_t count, std::string_view singular, std::string_view plural,
                   const std::vector<std::string>& first) {
  std::string out = std::to_string(count) + " " + std::string(count == 1 ? singular : plural) + " (";
  for (std::size_t i = 0; i < first.size(); ++i) out += (i > 0 ? ", " : "") + first[i];
  return out + (count > first.size() ? ", ...)" : ")");
}

/// Counts places of one kind and keeps the first few.
struct Finding {
  std::size_t count = 0;
  std::vector<std::string> first;
  void add(std::string place) {
    if (++count <= 5) first.push_back(std::move(place));
  }
};

struct HalfEdge {
  Edge edge;
  int face = 0;
  bool forward = true;  ///< runs from the smaller to the larger vertex
};

std::vector<HalfEdge> sorted_half_edges(const Mesh& mesh) {
  std::vector<HalfEdge> out;
  out.reserve(mesh.face_vertices.size());
  std::size_t begin = 0;
  for (int f = 0; f < mesh.face_count(); ++f) {
    const std::size_t size = at(mesh.face_sizes[at(f)]);
    for (std::size_t k = 0; k < size; ++k) {
      const int a = mesh.face_vertices[begin + k], b = mesh.face_vertices[begin + (k + 1) % size];
      if (a != b) out.push_back({{std::min(a, b), std::max(a, b)}, f, a < b});
    }
    begin += size;
  }
  std::sort(out.begin(), out.end(),
            [](const HalfEdge& a, const HalfEdge& b) { return a.edge != b.edge ? a.edge < b.edge : a.face < b.face; });
  return out;
}

/// False when sizes or indices do not fit together: nothing else can be judged then.
bool well_formed(const Mesh& mesh) {
  std::size_t corners = 0;
  for (const int size : mesh.face_sizes) {
    if (size < 3) return false;
    corners += at(size);
  }
  return corners == mesh.face_vertices.size() && std::all_of(mesh.face_vertices.begin(), mesh.face_vertices.end(),
                                                             [&](int v) { return v >= 0 && v < mesh.vertex_count(); });
}

bool names_vertices(const Mesh& mesh, const Stitch& s) {
  const auto exists = [&](int v) { return v >= 0 && v < mesh.vertex_count(); };
  return exists(s.vertex) && exists(s.edge[0]) && exists(s.edge[1]) && s.place >= 0 && s.place <= 1;
}

void judge_numbers(const Mesh& mesh, const FileNumbers& in_file, GarmentFindings& out) {
  Finding bad;
  for (int i = 0; i < mesh.vertex_count(); ++i)
    if (!mesh.positions[at(i)].allFinite()) bad.add(std::to_string(in_file.vertex(i)));
  if (bad.count > 0)
    out.faults.push_back(places(bad.count, "vertex is", "vertices are", bad.first) + " not a finite point");
}

void judge_faces(const Mesh& mesh, const FileNumbers& in_file, GarmentFindings& out) {
  Finding repeated, flat;
  std::size_t begin = 0;
  Mesh one;
  one.positions = mesh.positions;
  for (int f = 0; f < mesh.face_count(); ++f) {
    const auto first = mesh.face_vertices.begin() + static_cast<std::ptrdiff_t>(begin);
    std::vector<int> corners(first, first + mesh.face_sizes[at(f)]);
    begin += corners.size();
    one.face_sizes.assign(1, static_cast<int>(corners.size()));
    one.face_vertices = corners;
    std::sort(corners.begin(), corners.end());
    if (std::adjacent_find(corners.begin(), corners.end()) != corners.end()) {
      repeated.add(std::to_string(in_file.face(f)));
      continue;
    }
    for (const Triangle& t : triangulate(one)) {
      const Vec3 &a = mesh.positions[at(t[0])], &b = mesh.positions[at(t[1])], &c = mesh.positions[at(t[2])];
      const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
      if (!(2 * triangle_area(a, b, c) > k_flat_triangle * longest)) {
        flat.add(std::to_string(in_file.face(f)));
        break;
      }
    }
  }
  if (repeated.count > 0)
    out.faults.push_back(places(repeated.count, "face uses", "faces use", repeated.first) + " a vertex twice");
  if (flat.count > 0)
    out.faults.push_back(places(flat.count, "face has", "faces have", flat.first) +
                         " no area, or a corner in line with its neighbours");
}

void judge_edges(const Mesh& mesh, const FileNumbers& in_file, GarmentFindings& out) {
  const auto half_edges = sorted_half_edges(mesh);
  Finding crowded, mixed;
  for (std::size_t i = 0, end = 0; i < half_edges.size(); i = end) {
    end = i + 1;
    while (end < half_edges.size() && half_edges[end].edge == half_edges[i].edge) ++end;
    const std::string name = std::to_string(in_file.vertex(half_edges[i].edge[0])) + "-" +
                             std::to_string(in_file.vertex(half_edges[i].edge[1]));
    if (end - i > 2)
      crowded.add(name);
    else if (end - i == 2 && half_edges[i].forward == half_edges[i + 1].forward)
      mixed.add(name);
  }
  if (crowded.count > 0)
    out.faults.push_back(places(crowded.count, "edge has", "edges have", crowded.first) +
                         " more than two faces (non-manifold)");
  if (mixed.count > 0)
    out.notes.push_back(places(mixed.count, "edge lies", "edges lie", mixed.first) +
                        " between faces of opposite winding; normals point both ways");
}

void judge_vertices(const Mesh& mesh, const FileNumbers& in_file, GarmentFindings& out) {
  std::vector<char> used(mesh.positions.size(), 0);
  for (const int v : mesh.face_vertices) used[at(v)] = 1;
  Finding isolated, coincident;
  std::vector<int> order;
  Box box;
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    if (!used[at(i)]) {
      isolated.add(std::to_string(in_file.vertex(i)));
      continue;
    }
    order.push_back(i);
    box.include(mesh.positions[at(i)]);
  }
  if (isolated.count > 0)
    out.notes.push_back(places(isolated.count, "vertex belongs", "vertices belong", isolated.first) +
                        " to no face; carried along rigidly");

  // Sweep along the longest side of the box; of vertices at one place, each is counted once, against the first.
  const double near = k_same_place * box.size().norm();
  int axis = 0;
  box.size().maxCoeff(&axis);
  const auto& x = mesh.positions;
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return x[at(a)][axis] != x[at(b)][axis] ? x[at(a)][axis] < x[at(b)][axis] : a < b; });
  std::vector<std::pair<int, int>> twins;
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size() && x[at(order[j])][axis] - x[at(order[i])][axis] <= near; ++j)
      if ((x[at(order[j])] - x[at(order[i])]).squaredNorm() <= near * near)
        twins.emplace_back(std::max(order[i], order[j]), std::min(order[i], order[j]));
  std::sort(twins.begin(), twins.end());
  int last = -1;
  for (const auto& [later, earlier] : twins) {
    if (later == last) continue;
    last = later;
    coincident.add(std::to_string(in_file.vertex(later)) + " on " + std::to_string(in_file.vertex(earlier)));
  }
  if (coincident.count > 0)
    out.faults.push_back(
        places(coincident.count, "vertex lies", "vertices lie", coincident.first) +
        " exactly on another (merge them by distance in the modelling tool, or set weld for this cloth)");
}

/// More places than this for one vertex is a broken file: four panels meet in a corner, each sewn to each and both
/// ways.
constexpr int k_most_stitches = 16;

void judge_stitches(const Mesh& mesh, const FileNumbers& in_file, GarmentFindings& out) {
  std::vector<char> used(mesh.positions.size(), 0);
  for (const int v : mesh.face_vertices) used[at(v)] = 1;
  Finding own, loose, crowded;
  const auto name = [&](std::size_t s) { return std::to_string(in_file.stitch(static_cast<int>(s))); };
  std::vector<Stitch> sorted = mesh.stitches;
  for (Stitch& s : sorted) s.seam = 0;
  for (std::size_t s = 0; s < mesh.stitches.size(); ++s) {
    const Stitch& stitch = mesh.stitches[s];
    if (stitch.vertex == stitch.edge[0] || stitch.vertex == stitch.edge[1])
      own.add(name(s));
    else if (!used[at(stitch.vertex)] || !used[at(stitch.edge[0])] || !used[at(stitch.edge[1])])
      loose.add(name(s));
  }
  std::sort(sorted.begin(), sorted.end());
  const std::size_t all = sorted.size();
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  std::vector<int> count(mesh.positions.size(), 0);
  for (const Stitch& stitch : sorted)
    if (++count[at(stitch.vertex)] == k_most_stitches + 1) crowded.add(std::to_string(in_file.vertex(stitch.vertex)));
  if (own.count > 0)
    out.faults.push_back(places(own.count, "stitch sews", "stitches sew", own.first) + " a vertex to itself");
  if (loose.count > 0)
    out.faults.push_back(places(loose.count, "stitch sews", "stitches sew", loose.first) +
                         " a vertex that no face uses");
  if (crowded.count > 0)
    out.faults.push_back(places(crowded.count, "vertex is", "vertices are", crowded.first) + " sewn to more than " +
                         std::to_string(k_most_stitches) + " places");
  if (sorted.size() < all)
    out.notes.push_back(std::to_string(all - sorted.size()) + " stitches are there twice; each counts once");
}

/// Connected pieces of the faces; seams join them or not.
std::ptrdiff_t pieces_of(const Mesh& mesh, bool sewn) {
  std::vector<int> root(mesh.positions.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int v) {
    while (root[at(v)] != v) v = root[at(v)] = root[at(root[at(v)])];
    return v;
  };
  std::size_t begin = 0;
  for (const int size : mesh.face_sizes) {
    for (int k = 1; k < size; ++k) {
      const int a = find(mesh.face_vertices[begin]), b = find(mesh.face_vertices[begin + at(k)]);
      if (a != b) root[at(std::max(a, b))] = std::min(a, b);
    }
    begin += at(size);
  }
  for (const Stitch& stitch : mesh.stitches)
    for (const int e : stitch.edge) {
      const int a = find(stitch.vertex), b = find(e);
      if (sewn && a != b) root[at(std::max(a, b))] = std::min(a, b);
    }
  std::vector<char> is_piece(mesh.positions.size(), 0);
  for (const int v : mesh.face_vertices) is_piece[at(find(v))] = 1;
  return std::count(is_piece.begin(), is_piece.end(), 1);
}

/// A garment that falls apart into several pieces is legal, but good to know of.
void count_pieces(const Mesh& mesh, GarmentFindings& out) {
  const auto pieces = pieces_of(mesh, true);
  if (pieces > 1) out.notes.push_back("falls into " + std::to_string(pieces) + " pieces that are not joined");
}

}  // namespace

int panel_count(const Mesh& mesh) {
  return static_cast<int>(pieces_of(mesh, false));
}

GarmentFindings inspect_garment(const Mesh& mesh, const FileNumbers& in_file) {
  GarmentFindings out;
  if (mesh.positions.empty() || mesh.face_sizes.empty()) {
    out.faults.push_back(mesh.positions.empty() ? "has no vertices" : "has no faces");
    return out;
  }
  if (!well_formed(mesh)) {
    out.faults.push_back("has faces that name vertices which do not exist");
    return out;
  }
  if (!std::all_of(mesh.stitches.begin(), mesh.stitches.end(),
                   [&](const Stitch& s) { return names_vertices(mesh, s); })) {
    out.faults.push_back("has stitches that name vertices which do not exist");
    return out;
  }
  judge_numbers(mesh, in_file, out);
  if (!out.faults.empty()) return out;
  judge_faces(mesh, in_file, out);
  judge_edges(mesh, in_file, out);
  judge_vertices(mesh, in_file, out);
  judge_stitches(mesh, in_file, out);
  count_pieces(mesh, out);
  return out;
}

Status check_garment(const Mesh& mesh, const FileNumbers& in_file) {
  const GarmentFindings findings = inspect_garment(mesh, in_file);
  if (findings.faults.empty()) return {};
  std::string what = "cannot be simulated: ";
  for (std::size_t i = 0; i < findings.faults.size(); ++i) what += (i > 0 ? "; " : "") + findings.faults[i];
  return input_error(what, mesh.name.empty() ? "mesh" : "mesh \"" + mesh.name + "\"");
}

Status check_pattern(const Mesh& mesh, double scale, std::vector<std::string>& notes, const FileNumbers& in_file) {
  const std::string where = mesh.name.empty() ? "mesh" : "mesh \"" + mesh.name + "\"";
  if (mesh.uvs.empty() || mesh.face_uvs.size() != mesh.face_vertices.size())
    return input_error("has no pattern: its faces need texture vertices (vt)", where,
                       "export with uvs, or write rest = \"mesh\"");
  Finding flat;
  double pattern_area = 0, mesh_area = 0;
  std::size_t begin = 0;
  for (int f = 0; f < mesh.face_count(); ++f) {
    const std::size_t size = at(mesh.face_sizes[at(f)]);
    const auto uv = [&](std::size_t k) { return mesh.uvs[at(mesh.face_uvs[begin + k])]; };
    const auto x = [&](std::size_t k) { return mesh.positions[at(mesh.face_vertices[begin + k])]; };
    double twice = 0, longest = 0;
    for (std::size_t k = 0; k < size; ++k) {
      const Vec2 a = uv(k) - uv(0), b = uv((k + 1) % size) - uv(0);
      twice += a.x() * b.y() - b.x() * a.y();
      longest = std::max(longest, (b - a).squaredNorm());
      if (k > 0 && k + 1 < size) mesh_area += triangle_area(x(0), x(k), x(k + 1));
    }
    if (!(std::abs(twice) > k_flat_triangle * longest)) flat.add(std::to_string(in_file.face(f)));
    pattern_area += 0.5 * std::abs(twice) * scale * scale;
    begin += size;
  }
  if (flat.count > 0)
    return input_error("cannot be cut from its pattern: " + places(flat.count, "face has", "faces have", flat.first) +
                           " no area in vt",
                       where);
  const double ratio = std::sqrt(pattern_area / mesh_area);
  if (!(ratio > 0.5 && ratio < 2))
    notes.push_back("its pattern is " + std::to_string(ratio) + " times as long as the mesh: is pattern_scale right?");
  return {};
}

}  // namespace ft::inline io
