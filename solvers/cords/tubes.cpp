#include "solvers/cords/tubes.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "baker/core/check.h"
#include "baker/core/parallel.h"
#include "baker/core/rigid.h"

namespace ft::inline solvers {
namespace {

constexpr double k_most_stretch =
    2;  // of a ring where a strand bends, as a mitre: bends sharper than 120 degrees get thin
constexpr double k_straight = 1e-6;  // width of a piece over its length, below which it has no rotation
constexpr std::size_t k_strand_block = 8;

/// `across` (perpendicular to unit `from`) turned with the smallest rotation that brings `from` to unit `to`. Turned
/// back on itself, any rotation is the smallest: `across` stays.
Vec3 carried(const Vec3& across, const Vec3& from, const Vec3& to) {
  const double cosine = from.dot(to);
  Vec3 out = across;
  if (1 + cosine > 1e-9) out -= (from + to) * (to.dot(across) / (1 + cosine));
  return (out - to * to.dot(out)).normalized();  // what rounding left along `to`
}

/// Directions of a strand's cords; where one has no length, that of its neighbour, and `otherwise` where none has any.
std::vector<Vec3> directions(std::span<const int> strand, std::span<const Vec3> points, const Vec3& otherwise) {
  std::vector<Vec3> out(strand.size() - 1, Vec3::Zero());
  std::ptrdiff_t first = -1;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Vec3 way = (points[at(strand[i + 1])] - points[at(strand[i])]).stableNormalized();
    const bool good = way.squaredNorm() > 0.5;
    if (good && first < 0) first = static_cast<std::ptrdiff_t>(i);
    out[i] = good ? way : i > 0 ? out[i - 1] : way;
  }
  const Vec3 start = first < 0 ? otherwise : out[static_cast<std::size_t>(first)];
  std::fill(out.begin(), out.begin() + (first < 0 ? std::ssize(out) : first), start);
  return out;
}

/// Principal lengths of a set of points, squared and descending.
Vec3 spread(std::span<const int> indices, std::span<const Vec3> points) {
  Vec3 mean = Vec3::Zero();
  for (const int i : indices) mean += points[at(i)] / static_cast<double>(indices.size());
  Mat3 sum = Mat3::Zero();
  for (const int i : indices) sum += (points[at(i)] - mean) * (points[at(i)] - mean).transpose();
  return Eigen::JacobiSVD<Mat3>(sum).singularValues();
}

/// Quads of a tube whose rings begin at vertex `first`, and of its two ends; counter-clockwise seen from outside.
void add_faces(Mesh& mesh, int first, int rings) {
  constexpr int n = CordTubes::k_sides;
  const auto quad = [&](int a, int b, int c, int d) {
    mesh.face_sizes.push_back(4);
    mesh.face_vertices.insert(mesh.face_vertices.end(), {a, b, c, d});
  };
  for (int r = 0; r + 1 < rings; ++r)
    for (int k = 0; k < n; ++k) {
      const int here = first + r * n, next = here + n, l = (k + 1) % n;
      quad(here + k, here + l, next + l, next + k);
    }
  const int last = first + (rings - 1) * n;
  for (int k = 1; k + 2 < n; k += 2) {
    quad(first, first + k + 2, first + k + 1, first + k);
    quad(last, last + k, last + k + 1, last + k + 2);
  }
}

}  // namespace

CordTubes::CordTubes(const CordGraph& graph, double radius, std::string name)
    : radius_(radius), rest_(graph.points), strands_(graph.strands), pieces_(find_pieces(graph)) {
  CHECK(radius > 0);
  std::vector<std::size_t> piece_of(graph.points.size());
  for (std::size_t p = 0; p < pieces_.size(); ++p)
    for (const int i : pieces_[p].points) piece_of[at(i)] = p;
  mesh_.name = std::move(name);
  int vertices = 0;
  for (const std::vector<int>& strand : strands_) {
    CHECK(strand.size() >= 2);
    Seed& seed = seeds_.emplace_back();
    seed.piece = piece_of[at(strand.front())];
    seed.tangent = directions(strand, rest_, -Vec3::UnitY()).front();
    // Of what is straight only directions can be told, and no rule gives each a direction across it without a jump
    // somewhere: that is put opposite to where it hangs, or stands.
    if (pieces_[seed.piece].straight) seed.tangent = Vec3(0, seed.tangent.y() > 0.5 ? 1 : -1, 0);
    seed.normal = seed.tangent.unitOrthogonal();
    first_vertex_.push_back(vertices);
    const int rings = static_cast<int>(strand.size());
    add_faces(mesh_, vertices, rings);
    vertices += rings * k_sides;
  }
  mesh_.positions.resize(at(vertices));
  place(rest_, mesh_.positions);
}

std::vector<CordTubes::Piece> CordTubes::find_pieces(const CordGraph& graph) const {
  std::vector<int> root(graph.points.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int i) {
    while (root[at(i)] != i) i = root[at(i)] = root[at(root[at(i)])];
    return i;
  };
  for (const Edge& cord : graph.cords) {
    const int a = find(cord[0]), b = find(cord[1]);
    root[at(std::max(a, b))] = std::min(a, b);
  }
  std::vector<Piece> out;
  std::vector<std::size_t> piece_at(root.size());
  for (int i = 0; i < std::ssize(root); ++i) {
    if (find(i) == i) piece_at[at(i)] = out.size(), out.emplace_back();
    out[piece_at[at(find(i))]].points.push_back(i);
  }
  for (Piece& piece : out) {
    const Vec3 size = spread(piece.points, graph.points);
    piece.straight = !(size[1] > k_straight * k_straight * size[0]);
  }
  return out;
}

Quat CordTubes::rotation(const Piece& piece, std::span<const Vec3> points) const {
  if (piece.straight) return Quat::Identity();
  const double share = 1.0 / static_cast<double>(piece.points.size());
  Vec3 rest_mean = Vec3::Zero(), mean = Vec3::Zero();
  for (const int i : piece.points) rest_mean += rest_[at(i)] * share, mean += points[at(i)] * share;
  Mat3 sum = Mat3::Zero();
  for (const int i : piece.points) sum += (points[at(i)] - mean) * (rest_[at(i)] - rest_mean).transpose();
  return Quat(nearest_rotation(sum));  // Kabsch 1976
}

int CordTubes::vertex_of(int point) const {
  for (std::size_t s = 0; s < strands_.size(); ++s) {
    const auto found = std::find(strands_[s].begin(), strands_[s].end(), point);
    if (found != strands_[s].end()) return first_vertex_[s] + k_sides * static_cast<int>(found - strands_[s].begin());
  }
  return -1;
}

void CordTubes::place(std::span<const Vec3> points, std::span<Vec3> out) const {
  CHECK(points.size() == rest_.size() && out.size() == mesh_.positions.size());
  std::vector<Quat> turns;
  for (const Piece& piece : pieces_) turns.push_back(rotation(piece, points));
  parallel_for(strands_.size(), k_strand_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const std::vector<int>& strand = strands_[s];
      const Quat& turn = turns[seeds_[s].piece];
      Vec3 tangent = turn * seeds_[s].tangent, normal = turn * seeds_[s].normal;
      const std::vector<Vec3> ways = directions(strand, points, tangent);
      Vec3* vertex = out.data() + first_vertex_[s];
      for (std::size_t i = 0; i < strand.size(); ++i) {
        const Vec3 before = ways[i > 0 ? i - 1 : 0], after = ways[std::min(i, ways.size() - 1)];
        // Halfway between both; of a strand that turns back on itself the way it came.
        const double cosine = 0.5 * (before + after).norm();  // of half the bend
        const Vec3 along = cosine > 1e-9 ? Vec3((before + after) / (2 * cosine)) : before;
        normal = carried(normal, tangent, along);
        tangent = along;
        const Vec3 other = along.cross(normal), bend = (after - before).stableNormalized();
        const double stretch = std::min(1 / std::max(cosine, 1e-9), k_most_stretch) - 1;
        for (int k = 0; k < k_sides; ++k) {
          const double angle = 2 * std::numbers::pi * k / k_sides;
          const Vec3 arm = radius_ * (std::cos(angle) * normal + std::sin(angle) * other);
          *vertex++ = points[at(strand[i])] + arm + stretch * arm.dot(bend) * bend;
        }
      }
    }
  });
}

}  // namespace ft::inline solvers
