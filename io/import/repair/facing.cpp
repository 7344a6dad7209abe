// A piece is what edges join. It is closed when its edges have a triangle on either side that runs along them the other
// way; characters often lack a few faces (the cut of a neck, the inside of a sleeve), and count as closed up to a
// twentieth of the edges. The sign of the volume about the piece's middle says which way it faces; an open piece's sign
// is only believed when it is nothing like zero.
#include "io/import/repair/facing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "baker/core/mesh.h"

namespace ft::inline io {
namespace {

constexpr double k_most_open = 0.05;  ///< of the edges of a piece that counts as closed
/// Volume over area to the power 3/2: 0.094 of a ball, about 0.03 of a person, 0.014 of a stick 100 times as long as
/// thick. Below it a piece is a sheet, and has no inside.
constexpr double k_flat = 1e-3;

struct HalfEdge {
  Edge edge;
  bool forward;
  int piece;
};

struct Piece {
  double edges = 0, open = 0;
  double volume = 0, area = 0;
  Vec3 middle = Vec3::Zero();
  double corners = 0;
};

/// Counts edges, and those without exactly one triangle each way.
void count_edges(std::span<const Triangle> triangles, std::span<const int> piece_of, std::vector<Piece>& pieces) {
  std::vector<HalfEdge> half;
  half.reserve(3 * triangles.size());
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      if (a == b) continue;
      half.push_back({{std::min(a, b), std::max(a, b)}, a < b, piece_of[at(a)]});
    }
  std::sort(half.begin(), half.end(), [](const HalfEdge& a, const HalfEdge& b) { return a.edge < b.edge; });
  for (std::size_t begin = 0, end = 0; begin < half.size(); begin = end) {
    int forward = 0;
    for (end = begin; end < half.size() && half[end].edge == half[begin].edge; ++end) forward += half[end].forward;
    Piece& piece = pieces[at(half[begin].piece)];
    ++piece.edges;
    if (end - begin != 2 || forward != 1) ++piece.open;
  }
}

}  // namespace

std::string FacingReport::text() const {
  if (turned_count == 0) return {};
  if (piece_count == 1)
    return fmt::format("its surface is inside out (its faces point into the {:.3g} m3 that they enclose): turned",
                       volume);
  return fmt::format(
      "{} of its {} closed pieces {} inside out (faces point into the {:.3g} m3 that they enclose): turned",
      turned_count, piece_count, turned_count == 1 ? "is" : "are", volume);
}

FacingReport turn_outwards(std::span<const Vec3> positions, std::vector<Triangle>& triangles) {
  int count = 0;
  const std::vector<int> piece_of = connected_pieces(static_cast<int>(positions.size()), triangles, count);
  std::vector<Piece> pieces(at(count));
  count_edges(triangles, piece_of, pieces);
  for (const Triangle& t : triangles)
    for (const int v : t) {
      Piece& piece = pieces[at(piece_of[at(v)])];
      piece.middle += positions[at(v)];
      ++piece.corners;
    }
  for (Piece& piece : pieces)
    if (piece.corners > 0) piece.middle /= piece.corners;
  for (const Triangle& t : triangles) {
    Piece& piece = pieces[at(piece_of[at(t[0])])];
    const Vec3 a = positions[at(t[0])] - piece.middle, b = positions[at(t[1])] - piece.middle,
               c = positions[at(t[2])] - piece.middle;
    piece.volume += a.dot(b.cross(c)) / 6;
    piece.area += 0.5 * (b - a).cross(c - a).norm();
  }
  FacingReport out;
  std::vector<char> turn(pieces.size(), 0);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const Piece& piece = pieces[p];
    if (piece.edges == 0 || piece.open > k_most_open * piece.edges) continue;
    if (!(std::abs(piece.volume) > k_flat * std::pow(piece.area, 1.5))) continue;
    ++out.piece_count;
    if (piece.volume > 0) continue;
    turn[p] = 1;
    ++out.turned_count;
    out.volume -= piece.volume;
  }
  if (out.turned_count > 0)
    for (Triangle& t : triangles)
      if (turn[at(piece_of[at(t[0])])]) std::swap(t[1], t[2]);
  return out;
}

}  // namespace ft::inline io
