#include "io/hair/hair_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "io/hair/long_way.h"
#include "io/hair/resample.h"
#include "io/hair/slices.h"

namespace ft::inline io {
namespace {

constexpr double k_least_ratio = 3;            ///< length by breadth of what is a strand; real cards have 6 and more
constexpr std::size_t k_fewest_triangles = 3;  ///< of what can bend
constexpr double k_least_single_share = 0.8;   ///< of its slices
constexpr double k_least_side = 0.2, k_least_fall = 0.2;  ///< of a ribbon over a head, by its length
constexpr double k_way_counts = 0.1;                      ///< of a vertex's place, beside how near the line is [1]
constexpr int k_fewest_slices = 8, k_most_slices = 64;
constexpr std::size_t k_shown_pieces = 5;  ///< named in full; the rest is counted

/// A piece with vertices of its own.
struct Piece {
  std::vector<int> vertices;  ///< of the mesh, ascending
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
};

std::vector<Piece> pieces_of(const Mesh& mesh) {
  const auto triangles = triangulate(mesh);
  int count = 0;
  const auto piece_of = connected_pieces(mesh.vertex_count(), triangles, count);
  std::vector<Piece> out(at(count));
  std::vector<bool> used(mesh.positions.size(), false);
  for (const Triangle& t : triangles)
    for (const int v : t) used[at(v)] = true;
  std::vector<int> local(mesh.positions.size(), -1);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (!used[at(v)]) continue;
    Piece& piece = out[at(piece_of[at(v)])];
    local[at(v)] = static_cast<int>(piece.vertices.size());
    piece.vertices.push_back(v);
    piece.positions.push_back(mesh.positions[at(v)]);
  }
  for (const Triangle& t : triangles)
    out[at(piece_of[at(t[0])])].triangles.push_back({local[at(t[0])], local[at(t[1])], local[at(t[2])]});
  std::erase_if(out, [](const Piece& p) { return p.triangles.empty(); });
  return out;
}

double nearest(const Vec3& place, std::span<const Vec3> points) {
  double out = std::numeric_limits<double>::infinity();
  for (const Vec3& p : points) out = std::min(out, (p - place).squaredNorm());
  return out;
}

bool root_is_last(const std::vector<Vec3>& line, std::span<const Vec3> scalp) {
  if (scalp.empty()) return line.back().y() > line.front().y();
  return nearest(line.back(), scalp) < nearest(line.front(), scalp);
}

/// Where a line hangs down on both sides, as a ribbon over a head does: the highest vertex; else none.
std::optional<std::size_t> crest_of(std::span<const Vec3> line) {
  const auto top =
      static_cast<std::size_t>(std::ranges::max_element(line, {}, [](const Vec3& p) { return p.y(); }) - line.begin());
  const double whole = length_of(line), before = length_of(line.first(top + 1));
  const double fall = line[top].y() - std::max(line.front().y(), line.back().y());
  const bool inside = std::min(before, whole - before) > k_least_side * whole;
  return inside && fall > k_least_fall * whole ? std::optional(top) : std::nullopt;
}

/// Where along a line [m] a vertex is: near to it, and about where its way says. A way alone would not do, for it is
/// late to reach the corners of an end and the shorter ones of frayed tips.
double place_of(const Vec3& vertex, double way, const MiddleLine& middle, std::span<const double> places) {
  const auto next = std::ranges::upper_bound(middle.ways, way) - middle.ways.begin();
  const auto k = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(next, 1, static_cast<std::ptrdiff_t>(middle.ways.size()) - 1));
  const double share = (way - middle.ways[k - 1]) / (middle.ways[k] - middle.ways[k - 1]);
  const double by_way = (1 - share) * places[k - 1] + share * places[k];
  // Least |vertex - point|^2 + k_way_counts (place - by_way)^2 of all points of the line.
  double least = std::numeric_limits<double>::infinity(), out = by_way;
  for (std::size_t i = 1; i < places.size(); ++i) {
    const Vec3 to_vertex = vertex - middle.line[i - 1], step = middle.line[i] - middle.line[i - 1];
    const double length = places[i] - places[i - 1], wanted = by_way - places[i - 1];
    if (!(length > 0)) continue;
    const double best = (to_vertex.dot(step) / length + k_way_counts * wanted) / (1 + k_way_counts);
    const double along = std::clamp(best, 0.0, length);
    const double off = along - wanted;
    const double cost = (to_vertex - along / length * step).squaredNorm() + k_way_counts * off * off;
    if (cost < least) least = cost, out = places[i - 1] + along;
  }
  return out;
}

/// The strands out of a piece and the riders of its vertices; how many.
int add_strands(const Piece& piece, std::span<const Vec3> scalp, MiddleLines& out) {
  if (piece.triangles.size() < k_fewest_triangles) return 0;
  const auto ways = long_way(piece.positions, piece.triangles);
  if (ways.empty()) return 0;
  const int slices = std::clamp(static_cast<int>(piece.vertices.size()) / 2, k_fewest_slices, k_most_slices);
  const MiddleLine middle = middle_line(piece.positions, piece.triangles, ways, slices);
  if (middle.line.empty() || middle.single_share < k_least_single_share) return 0;
  const double length = length_of(middle.line);
  const auto crest = crest_of(middle.line);
  if (length / (crest ? 2 : 1) < k_least_ratio * middle.breadth) return 0;
  std::vector<double> places{0};  // along the whole line [m]
  for (std::size_t i = 1; i < middle.line.size(); ++i)
    places.push_back(places.back() + (middle.line[i] - middle.line[i - 1]).norm());
  // One part, or two that begin at the crest.
  struct Part {
    double root, tip;  ///< places
  };
  std::vector<Part> parts{{0, places.back()}};
  if (crest)
    parts = {{places[*crest], 0}, {places[*crest], places.back()}};
  else if (root_is_last(middle.line, scalp))
    parts = {{places.back(), 0}};
  const int first = static_cast<int>(out.strands.size());
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const double place = place_of(piece.positions[i], ways[i], middle, places);
    const int which = crest && place > places[*crest] ? 1 : 0;
    const Part& part = parts[at(which)];
    const double along = std::clamp((place - part.root) / (part.tip - part.root), 0.0, 1.0);
    out.riders[at(piece.vertices[i])] = {first + which, along, true};
  }
  for (const Part& part : parts) {
    auto& strand = out.strands.emplace_back();
    for (std::size_t i = 0; i < places.size(); ++i)
      if (places[i] >= std::min(part.root, part.tip) && places[i] <= std::max(part.root, part.tip))
        strand.push_back(middle.line[i]);
    if (part.tip < part.root) std::ranges::reverse(strand);
  }
  return static_cast<int>(parts.size());
}

/// Points along strands by cells of the size of the reach.
class NearStrands {
 public:
  explicit NearStrands(std::span<const std::vector<Vec3>> strands) {
    for (std::size_t s = 0; s < strands.size(); ++s) {
      const int count = std::max(2, static_cast<int>(length_of(strands[s]) / (k_rider_reach / 8)));
      const auto line = resampled(strands[s], count);
      for (std::size_t i = 0; i < line.size(); ++i)
        cells_[cell(line[i])].push_back({line[i], static_cast<int>(s), static_cast<double>(i) / (count - 1)});
    }
  }
  Rider at_place(const Vec3& place) const {
    Rider out{-1, 0, false};
    double least = k_rider_reach * k_rider_reach;
    const Cell middle = cell(place);
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const auto found = cells_.find({middle[0] + x, middle[1] + y, middle[2] + z});
          if (found == cells_.end()) continue;
          for (const Point& p : found->second)
            if (const double d = (p.place - place).squaredNorm(); d < least)
              least = d, out.strand = p.strand, out.along = p.along;
        }
    return out;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Point {
    Vec3 place;
    int strand;
    double along;
  };
  static Cell cell(const Vec3& p) {
    Cell out;
    for (int k = 0; k < 3; ++k) out[at(k)] = static_cast<std::int64_t>(std::floor(p[k] / k_rider_reach));
    return out;
  }
  std::map<Cell, std::vector<Point>> cells_;
};

std::string note_of(const Piece& piece) {
  const Vec3 size = bounds(piece.positions).size();
  return fmt::format("{} triangles from vertex {} on, {:.3g} x {:.3g} x {:.3g} m", piece.triangles.size(),
                     piece.vertices.front() + 1, size.x(), size.y(), size.z());
}

}  // namespace

MiddleLines middle_lines(const Mesh& mesh, std::span<const Vec3> scalp) {
  MiddleLines out;
  out.riders.resize(mesh.positions.size());
  std::vector<std::string> left_out;
  std::vector<const Piece*> others;
  int strips = 0, ribbons = 0;
  const auto pieces = pieces_of(mesh);
  for (const Piece& piece : pieces) {
    const int added = add_strands(piece, scalp, out);
    strips += added > 0 ? 1 : 0, ribbons += added == 2 ? 1 : 0;
    if (added > 0) continue;
    others.push_back(&piece);
    left_out.push_back(note_of(piece));
  }
  if (!others.empty() && !out.strands.empty()) {
    const NearStrands near(out.strands);
    for (const Piece* piece : others)
      for (std::size_t i = 0; i < piece->vertices.size(); ++i)
        out.riders[at(piece->vertices[i])] = near.at_place(piece->positions[i]);
  }
  for (std::size_t i = 0; i < std::min(left_out.size(), k_shown_pieces); ++i)
    out.notes.push_back("a piece is no strip and gets no strand: " + left_out[i] + " (vertices count from 1)");
  if (left_out.size() > k_shown_pieces)
    out.notes.push_back(fmt::format("and {} more such pieces", left_out.size() - k_shown_pieces));
  if (strips > 0)
    out.notes.push_back(fmt::format("{} of {} pieces are strips or tubes; their roots are the ends that are {}", strips,
                                    pieces.size(), scalp.empty() ? "higher" : "nearer to the scalp"));
  if (ribbons > 0)
    out.notes.push_back(
        fmt::format("{} of them hang down on both sides and are two strands each, with roots where they "
                    "are highest",
                    ribbons));
  return out;
}

}  // namespace ft::inline io
