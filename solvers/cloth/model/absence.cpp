#include "solvers/cloth/model/absence.h"

#include <algorithm>

#include "baker/core/parallel.h"
#include "collision/check/penetration.h"
#include "solvers/cloth/model/absence_nearest.h"
#include "solvers/cloth/model/cloth_model.h"

namespace ft::inline solvers {

using namespace absent;

namespace {

/// A garment wears a part that is the nearest in the bind pose to this share of its vertices [1].
constexpr double k_worn_share = 0.02;
/// What is let go of a part that is not worn around a place where it blocks cloth [m].
constexpr double k_limb_reach = 0.08;
/// What is let go next to a hole, of the hole's vertices at least [1].
constexpr double k_growth = 0.5;
/// Cloth nearer than this [m] is pressed by what comes back.
constexpr double k_touching = 5e-4;
}  // namespace

Absence::Absence(const ClothModel& model) : body_count_(at(model.collider->vertex_count())) {
  const ClothSetup& setup = model.setup;
  const auto parts = model.collider->part_of_vertex();
  const auto triangles = model.collider->triangles();
  for (const SurfacePart& part : model.collider->trajectory().surface().parts) {
    parents_.push_back(part.parent);
    stays_.push_back(part.fixed || part.sheet ? 1 : 0);
    sheet_.push_back(part.sheet ? 1 : 0);
  }
  neighbours_ = vertex_neighbours(body_count_, unique_edges(triangles));
  std::vector<Vec3> bind(body_count_);
  model.collider->refined_bind(bind);
  tree_ = TriangleTree(bind, triangles);
  std::vector<int> nearest_part(model.contact.rest.size(), -1);
  anchors_.resize(nearest_part.size());
  std::vector<TriangleTree> wearers(setup.garments.size());  // of a garment's wearer alone, where there are others
  for (std::size_t g = 0; g < wearers.size(); ++g)
    if (const auto& wearer = setup.garments[g].wearer)
      wearers[g] = tree_of(bind, triangles, [&](const Triangle& t) { return wearer->has(parts[at(t[0])]); });
  parallel_for(nearest_part.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      TriangleTree::Hit hit;
      const Vec3& p = model.contact.rest[i];
      const TriangleTree& worn_on = wearers[at(model.garment_of(static_cast<int>(i)))];
      (worn_on.empty() ? tree_ : worn_on).closest(p, bind, triangles, hit);
      if (hit.triangle < 0) continue;
      const Triangle& t = triangles[at(hit.triangle)];
      nearest_part[i] = parts[at(t[0])];
      const Vec3 e = bind[at(t[1])] - bind[at(t[0])], f = bind[at(t[2])] - bind[at(t[0])], n = e.cross(f);
      const Vec3 s = hit.closest.point - bind[at(t[0])];
      const double area = n.squaredNorm(), height = std::sqrt(hit.closest.squared_distance);
      if (height > k_on_skin || !(area > 0)) continue;
      const double u = s.cross(f).dot(n) / area, w = e.cross(s).dot(n) / area;
      const bool other_side = sheet_[at(parts[at(t[0])])] != 0 && n.dot(p - hit.closest.point) < 0;
      anchors_[i] = {t,
                     {static_cast<float>(1 - u - w), static_cast<float>(u), static_cast<float>(w)},
                     static_cast<float>((other_side ? -1 : 1) * std::max(height, model.contact.radius[i]))};
    }
  });
  for (std::size_t g = 0; g < setup.garments.size(); ++g) {
    const ClothGarment& garment = setup.garments[g];
    for (const int part : parts)
      ignored_.push_back(std::find(garment.ignores.begin(), garment.ignores.end(), part) != garment.ignores.end());
    std::vector<int> count(parents_.size(), 0);
    const int first = model.first_vertex[g], end = model.first_vertex[g + 1];
    for (int i = first; i < end; ++i)
      if (nearest_part[at(i)] >= 0) ++count[at(nearest_part[at(i)])];
    std::vector<char> worn;
    for (const int c : count) worn.push_back(c >= k_worn_share * (end - first));
    for (int i = first; i < end; ++i)
      if (nearest_part[at(i)] >= 0 && worn[at(nearest_part[at(i)])] == 0) anchors_[at(i)].triangle[0] = -1;
    worn_.push_back(std::move(worn));
  }
}

/// Of what has an inside; none: all of the collider has.
std::optional<TriangleTree> Absence::tree_of_solids(const ClothModel& model, std::span<const Vec3> body) const {
  if (!model.collider->has_sheets()) return std::nullopt;
  const auto parts = model.collider->part_of_vertex();
  return tree_of(body, model.collider->triangles(),
                 [&](const Triangle& t) { return sheet_[at(parts[at(t[0])])] == 0; });
}

Vec3 Absence::place_on_skin(int vertex, std::span<const Vec3> body) const {
  const Anchor& anchor = anchors_[at(vertex)];
  const Vec3 &a = body[at(anchor.triangle[0])], &b = body[at(anchor.triangle[1])], &c = body[at(anchor.triangle[2])];
  return anchor.weight[0] * a + anchor.weight[1] * b + anchor.weight[2] * c +
         anchor.height * (b - a).cross(c - a).normalized();
}

std::vector<char> Absence::at_start(std::span<const char> deep) const {
  std::vector<char> out = ignored_;
  take_out(deep, deep, out);
  return out;
}

void Absence::take_out(std::span<const char> deep_t0, std::span<const char> deep_t1, std::vector<char>& absent) const {
  for (std::size_t first = 0; first < absent.size(); first += body_count_)
    for (std::size_t b = 0; b < body_count_; ++b)
      absent[first + b] = static_cast<char>(absent[first + b] | deep_t0[b] | deep_t1[b]);
}

/// Marks what is within `reach` [m] of what is marked, along the surface, in parts that are no larger than least_rank.
void Absence::grow(const ClothModel& model, std::span<const Vec3> body, double reach, int least_rank,
                   std::vector<char>& marked) const {
  const auto parts = model.collider->part_of_vertex();
  std::vector<std::pair<int, int>> queue;  // vertex, where it came from
  for (int b = 0; b < static_cast<int>(marked.size()); ++b)
    if (marked[at(b)] != 0) queue.emplace_back(b, b);
  for (std::size_t k = 0; k < queue.size(); ++k) {
    const auto [v, from] = queue[k];
    for (const int w : neighbours_.row(v)) {
      if (marked[at(w)] != 0 || model.part_rank[at(parts[at(w)])] < least_rank) continue;
      if ((body[at(w)] - body[at(from)]).squaredNorm() > reach * reach) continue;
      marked[at(w)] = 1;
      queue.emplace_back(w, from);
    }
  }
}

/// Marks more around what is marked, in the same parts, where it borders on what is let go: k_growth of that at least.
void Absence::widen(int garment, std::span<const int> parts, std::span<const char> deep, std::span<const char> absent,
                    std::vector<char>& marked) const {
  const auto let_go = [&](int b) { return absent[place(garment, b)] != 0 && !planned(garment, b, deep); };
  std::vector<int> rim, hole;
  std::vector<char> in_hole(body_count_, 0);
  int added = 0;
  for (int b = 0; b < static_cast<int>(body_count_); ++b) {
    if (marked[at(b)] == 0) continue;
    rim.push_back(b);
    if (let_go(b))
      in_hole[at(b)] = 1, hole.push_back(b);
    else
      ++added;
  }
  for (std::size_t k = 0; k < hole.size(); ++k)
    for (const int w : neighbours_.row(hole[k]))
      if (in_hole[at(w)] == 0 && parts[at(w)] == parts[at(hole[k])] && let_go(w)) in_hole[at(w)] = 1, hole.push_back(w);
  for (std::size_t k = 0; k < rim.size() && added < k_growth * static_cast<double>(hole.size()); ++k)
    for (const int w : neighbours_.row(rim[k])) {
      if (marked[at(w)] != 0 || parts[at(w)] != parts[at(rim[k])] || absent[place(garment, w)] != 0) continue;
      marked[at(w)] = 1;
      rim.push_back(w);
      ++added;
    }
}

int Absence::let_go(const ClothModel& model, int garment, std::span<const int> body_vertices,
                    std::span<const Vec3> body, std::span<const char> deep, std::vector<char>& absent) const {
  const auto parts = model.collider->part_of_vertex();
  std::vector<char> marked(body_count_, 0);
  int rank = std::numeric_limits<int>::max();
  for (const int v : body_vertices) {
    if (!goes_whole(garment, parts[at(v)])) continue;
    marked[at(v)] = 1;
    rank = std::min(rank, model.part_rank[at(parts[at(v)])]);
  }
  grow(model, body, k_limb_reach, rank, marked);
  for (const int v : body_vertices) {
    marked[at(v)] = 1;
    for (const int w : neighbours_.row(v)) marked[at(w)] = 1;
  }
  widen(garment, parts, deep, absent, marked);
  int added = 0;
  for (std::size_t b = 0; b < body_count_; ++b)
    if (char& is = absent[place(garment, static_cast<int>(b))]; marked[b] != 0 && is == 0) is = 1, ++added;
  return added;
}

int Absence::let_go_of_all(int garment, std::vector<char>& absent) const {
  const std::span<char> all = std::span(absent).subspan(place(garment, 0), body_count_);
  const auto met = std::count(all.begin(), all.end(), char{0});
  std::fill(all.begin(), all.end(), char{1});
  return static_cast<int>(met);
}

bool Absence::is_absent(const ClothModel& model, const Crossing& c, std::span<const char> absent) const {
  return c.edge_of_first ? is_absent(absent, model.garment_of(c.edge[0]), c.triangle)
                         : is_absent(absent, model.garment_of(c.triangle[0]), c.edge);
}

Absence::LetGo Absence::let_go_now(int garment, std::span<const char> deep, std::span<const char> absent) const {
  LetGo out;
  for (int b = 0; b < static_cast<int>(body_count_); ++b)
    if (absent[place(garment, b)] != 0 && !planned(garment, b, deep)) ++out.count, out.vertex = b;
  return out;
}

void Absence::bring_back(const ClothModel& model, std::span<const Crossing> crossings, const CheckedSurface& collider,
                         std::span<const char> deep, ClothMotion& motion) const {
  const auto parts = model.collider->part_of_vertex();
  const std::span<const Vec3> body = collider.positions();
  const auto triangles = collider.triangles();
  for (int g = 0; g < static_cast<int>(worn_.size()); ++g) {
    std::vector<char> returning(body_count_, 0), stays(body_count_, 0), gone(parents_.size(), 0);
    Box box;
    for (int b = 0; b < static_cast<int>(body_count_); ++b)
      if (motion.absent[place(g, b)] != 0 && !planned(g, b, deep)) returning[at(b)] = 1, box.include(body[at(b)]);
    const auto is_returning = [&](const auto& element) {
      return std::any_of(element.begin(), element.end(), [&](int b) { return returning[at(b)] != 0; });
    };
    /// Cloth has to get out where it lay.
    const auto open_skin = [&](std::span<const int> cloth) {
      for (const int v : cloth)
        for (const int b : anchors_[at(v)].triangle)
          if (anchors_[at(v)].triangle[0] >= 0) stays[at(b)] = 1;
    };
    const auto keep = [&](const auto& element, bool is_through) {
      for (const int b : element) {
        if (deep[at(b)] != 0) continue;
        stays[at(b)] = 1;
        if (is_through && goes_whole(g, parts[at(b)])) gone[at(parts[at(b)])] = 1;
      }
    };
    for (const Crossing& c : crossings) {
      const int garment = model.garment_of(c.edge_of_first ? c.edge[0] : c.triangle[0]);
      if (garment != g) continue;
      // What crosses where it is planned that it may says nothing of the rest of the limb.
      if (!(c.edge_of_first ? is_returning(c.triangle) : is_returning(c.edge))) continue;
      if (c.edge_of_first) {
        keep(c.triangle, true);
        open_skin(c.edge);
      } else {
        keep(c.edge, true);
        open_skin(c.triangle);
      }
    }
    if (box.lo.x() <= box.hi.x()) {
      box.inflate(k_margin);
      std::vector<int> near;
      for (int i = model.first_vertex[at(g)]; i < model.first_vertex[at(g + 1)]; ++i) {
        const Vec3& p = motion.x[at(i)];
        if ((p.array() >= box.lo.array()).all() && (p.array() <= box.hi.array()).all()) near.push_back(i);
      }
      struct Held {
        int triangle = -1;
        bool inside = false;
      };
      const TriangleTree returning_tree = tree_of(body, triangles, is_returning);
      const std::optional<TriangleTree> solid_tree = tree_of_solids(model, body);
      const TriangleTree& solid = solid_tree ? *solid_tree : collider.tree();
      std::vector<Held> held(near.size());
      parallel_for(near.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
          const Vec3& p = motion.x[at(near[k])];
          // Where parts overlap, what is nearest may be the front of one, and the cloth yet inside of what returns.
          Nearest n = nearest(p, body, triangles, returning_tree, k_deepest);
          if (n.triangle < 0) continue;
          const bool touches = n.distance < k_touching;
          if (!n.behind && !touches) n = nearest(p, body, triangles, solid, k_deepest);
          const bool inside = n.behind && rays_say_inside(p, solid, body, triangles);
          if (inside || touches) held[k] = {n.triangle, inside};
        }
      });
      for (std::size_t k = 0; k < held.size(); ++k) {
        if (held[k].triangle < 0) continue;
        keep(triangles[at(held[k].triangle)], held[k].inside);
        if (held[k].inside) open_skin(std::span(&near[k], 1));
      }
    }
    add_descendants(gone);
    grow(model, body, k_margin, 0, stays);
    for (int b = 0; b < static_cast<int>(body_count_); ++b) {
      char& is = motion.absent[place(g, b)];
      const bool limb = gone[at(parts[at(b)])] != 0;
      is = static_cast<char>(planned(g, b, deep) || limb || stays[at(b)] != 0);
    }
  }
}

}  // namespace ft::inline solvers
