#include "solvers/cloth/advance/candidates.h"

#include <algorithm>
#include <cmath>

#include "baker/core/give_back.h"
#include "baker/core/parallel.h"
#include "collision/broad_phase/swept_motion.h"
#include "collision/geometry/ccd_li2021.h"
#include "solvers/cloth/advance/candidates_touching.h"
#include "solvers/cloth/advance/carry_field.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_block = 512;       ///< of a loop over vertices or pairs
constexpr double k_farthest_range = 0.05;  ///< body motion that the search for near surfaces covers at most [m]

// Where the solve may put a vertex: a ball that holds both its carried place and where it would fly with its velocity
// and the acceleration of the last step. Too small a ball holds cloth back (it then asks for more), too large a one
// costs candidates.
constexpr double k_slack_way = 0.5;           ///< of the way between the two: both are in the ball
constexpr double k_slack_acceleration = 0.3;  ///< of what the last step's acceleration makes in this one, on top
constexpr double k_slack_gravity = 0.3;       ///< of h2 g
constexpr double k_most_acceleration =
    2e-3;                              ///< that share is at most this [m]: what hit the cloth once seldom hits it twice
constexpr double k_slack_body = 0.03;  ///< of the body's motion near the cloth: rubbing and the carry's own error
constexpr double k_slack_least = 3e-4;  ///< m
/// All but the share of the way is at most so many typical edges of the garment: pairs of fine cloth in folds grow with
/// the cube of it, and whoever needs more asks for it.
constexpr double k_slack_edges = 0.1;
/// How far pairs are looked for, typically, in contact radii: patches of flat cloth are cut for that.
constexpr double k_patch_reach = 1;

/// Collider triangles in the common numbering.
std::vector<Triangle> shifted_triangles(const ClothModel& model) {
  std::vector<Triangle> out;
  if (!model.collider) return out;
  out.assign(model.collider->triangles().begin(), model.collider->triangles().end());
  for (Triangle& t : out)
    for (int& v : t) v += model.vertex_count();
  return out;
}

double largest(std::span<const double> values) {
  return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

Vec3 mean_of(std::span<const Vec3> values) {
  const Vec3 sum = parallel_sum(values.size(), k_block, Vec3(0, 0, 0), [&](std::size_t begin, std::size_t end) -> Vec3 {
    Vec3 own(0, 0, 0);
    for (std::size_t i = begin; i < end; ++i) own += values[i];
    return own;
  });
  return sum / static_cast<double>(std::max<std::size_t>(values.size(), 1));
}

}  // namespace

Candidates::Candidates(const ClothModel& model)
    : model_(model),
      finder_(model.vertex_count(), model.triangles, model.collider ? model.collider->vertex_count() : 0,
              shifted_triangles(model), model.rest_edges.edges),
      patches_(model.contact.rest, model.triangles,
               k_patch_reach * ContactModel::self_radius(largest(model.contact.radius))) {
  radius_ = std::max(radius_, largest(model.contact.radius));
  self_radius_ = ContactModel::self_radius(largest(model.contact.radius));
  finder_.set_patches(patches_.members());
  for (const double edge : model.typical_edge) most_spare_.push_back(k_slack_edges * edge);
  any_self_ = std::any_of(model.self_collides.begin(), model.self_collides.end(), [](char c) { return c; });
}

/// The collider's part of a pair, -1 for cloth against cloth.
int Candidates::part_of(const Stencil& stencil) const {
  for (const int v : stencil.v)
    if (v >= model_.vertex_count()) return model_.collider->part_of_vertex()[at(v - model_.vertex_count())];
  return -1;
}

bool Candidates::is_gone(const ClothMotion& cloth, std::size_t body_vertex) const {
  for (std::size_t k = body_vertex; k < cloth.absent.size(); k += model_.absence.body_count())
    if (cloth.absent[k] == 0) return false;
  return !cloth.absent.empty();
}

/// A pair counts unless it is cloth against what of the collider is absent for it, cloth that does not collide with
/// itself, what the way out of a tangle leaves open, or what a seam holds together.
bool Candidates::counts(const ClothMotion& cloth, PairKind kind, const Stencil& stencil) const {
  const int part = part_of(stencil);
  const std::size_t split = kind == PairKind::k_vertex_face ? 1 : 2;
  for (std::size_t k = 0; k < 4; ++k) {
    const int v = stencil.v[k];
    if (v >= model_.vertex_count()) continue;
    if (part >= 0) {
      const int garment = model_.garment_of(v);
      for (const int b : stencil.v)
        if (b >= model_.vertex_count() && cloth.absent[model_.absence.place(garment, b - model_.vertex_count())] != 0)
          return false;
      break;
    }
    if (part < 0 && !model_.self_collides[at(v)]) return false;
  }
  if (part < 0 && way_out_ != nullptr && way_out_->is_open(kind, stencil)) return false;
  const std::span<const int> v(stencil.v);
  return part >= 0 || !model_.sewn.together(v.first(split), v.subspan(split));
}

void Candidates::find_near(const ClothMotion& cloth, double h, const PieceMotion& piece) {
  const std::size_t nc = cloth.x.size(), nb = piece.body_motion.size();
  give_back(near_body_.vertex_face);
  finder_.arrange(piece.start);
  fastest_ = 0;
  if (nb == 0) return;
  const Vec3 mean = h * mean_of(cloth.v);
  Box box = bounds(cloth.x);
  for (std::size_t i = 0; i < nc; ++i) box.include((cloth.x[i] + h * cloth.v[i]).eval());
  box.inflate(2 * radius_);
  const auto way_of = [&](std::size_t i) { return is_gone(cloth, i) ? 0.0 : (piece.body_motion[i] - mean).norm(); };
  fastest_ = parallel_max(nb, k_block, 0.0, [&](std::size_t begin, std::size_t end) {
    double fastest = 0;
    for (std::size_t i = begin; i < end; ++i) {
      Box swept;
      swept.include(piece.start[nc + i]);
      swept.include((piece.start[nc + i] + piece.body_motion[i]).eval());
      if (swept.overlaps(box)) fastest = std::max(fastest, way_of(i));
    }
    return fastest;
  });
  range_ = 2 * radius_ + std::min(fastest_, k_farthest_range);
  boxes_.resize(nc + nb);
  box_frame_ = frame_around(cloth.x, {}, range_);
  // A surface matters from as far away as it comes itself; what stands still with the cloth only where it is near.
  parallel_for(nc + nb, k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double way = i < nc ? 0 : std::min(way_of(i - nc), k_farthest_range);
      boxes_[i] = i >= nc && is_gone(cloth, i - nc) ? VertexBox::nowhere()
                                                    : box_frame_.swept(piece.start[i], piece.start[i], radius_ + way);
    }
  });
  // Cloth with the body only, either way round.
  finder_.find_vertex_face(boxes_, false, near_body_,
                           [&](PairKind kind, const Stencil& stencil) { return counts(cloth, kind, stencil); });
}

void Candidates::carry(const ClothMotion& cloth, double h, PieceMotion& piece) {
  zones_.clear(static_cast<int>(cloth.x.size()), model_.clusters);
  inertia_.resize(cloth.x.size());
  for (std::size_t i = 0; i < inertia_.size(); ++i) inertia_[i] = h * cloth.v[i];
  piece.carry = inertia_;
  if (near_body_.vertex_face.empty()) return;
  const Adjacency neighbours = vertex_neighbours(cloth.x.size(), model_.rest_edges.edges);
  CarryInput input;
  input.cloth_vertex_count = static_cast<int>(cloth.x.size());
  input.x = piece.start;
  input.body_motion = piece.body_motion;
  input.inertia = inertia_;
  input.neighbours = &neighbours;
  input.clusters = &model_.clusters;
  input.smooth = &model_.carry_smooth;
  input.pairs = &near_body_;
  input.part_of_body_vertex = model_.collider->part_of_vertex();
  input.range = range_;
  carry_field(input, piece.carry);
  give_back(near_body_.vertex_face);
}

/// Where the solve may put a vertex, and the box of where it is in the meantime.
void Candidates::place(std::size_t i, const ClothMotion& cloth, PieceMotion& piece) {
  // What pulls on the cloth now pulls in this piece too: without this room, swinging cloth is held back and stretches.
  const double gained = cloth.h_previous > 0 ? h_ * h_ / cloth.h_previous : 0;
  Vec3 acceleration = gained * (cloth.v[i] - cloth.v_previous[i]);
  const double pull = acceleration.norm();
  if (pull > k_most_acceleration) acceleration *= k_most_acceleration / pull;
  const Vec3 way = h_ * cloth.v[i] + acceleration - piece.carry[i];
  piece.centre[i] = (piece.carry[i] + 0.5 * way).cast<float>();
  const double spare = k_slack_acceleration * std::min(pull, k_most_acceleration) +
                       k_slack_gravity * h_ * h_ * model_.setup.gravity.norm() +
                       k_slack_body * std::min(fastest_, k_farthest_range) + k_slack_least;
  piece.slack[i] =
      static_cast<float>(k_slack_way * way.norm() + std::min(spare, most_spare_[at(model_.contact.garment[i])]));
  set_box(i, piece);
}

void Candidates::set_box(std::size_t i, const PieceMotion& piece) {
  const Vec3 &start = piece.start[i], centre = start + piece.centre[i].cast<double>() - frame_;
  boxes_[i] = box_frame_.swept(start, start + piece.all[i].cast<double>() - frame_, 0.5 * radius_);
  boxes_[i].include(box_frame_.swept(centre, centre, piece.slack[i] + 0.5 * radius_));
}

/// Which patches of cloth are flat in the whole of what this piece may do, as far as is known.
void Candidates::begin_flat(const PieceMotion& piece) {
  patches_.begin(std::span(piece.start).first(piece.carry.size()));
  lost_.clear();
  std::vector<Vec3> carried(piece.carry.size());
  const auto keep = [&](const auto& way) {
    parallel_for(carried.size(), k_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) carried[i] = piece.start[i] + way[i].template cast<double>();
    });
    patches_.keep(carried, true, lost_);
  };
  keep(piece.all);
  keep(piece.centre);
}

double Candidates::collect(const ClothMotion& cloth, double h, PieceMotion& piece) {
  const std::size_t nc = cloth.x.size(), nb = piece.body_motion.size();
  h_ = h;
  piece.all.resize(nc + nb);
  frame_ = mean_of(piece.carry);
  piece.slack.resize(nc);
  piece.centre.resize(nc + nb);
  boxes_.resize(nc + nb);
  box_frame_ = frame_around(cloth.x, inertia_, radius_);
  give_back(inertia_);
  finder_.set_self_margin(box_frame_.margin(std::max(0.0, radius_ - self_radius_)));
  parallel_for(nc, k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      piece.all[i] = piece.carry[i].cast<float>();
      place(i, cloth, piece);
    }
  });
  parallel_for(nb, k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3& start = piece.start[nc + i];
      piece.all[nc + i] = piece.centre[nc + i] = piece.body_motion[i].cast<float>();
      boxes_[nc + i] = is_gone(cloth, i)
                           ? VertexBox::nowhere()
                           : box_frame_.swept(start, start + piece.body_motion[i] - frame_, 0.5 * radius_);
    }
  });
  if (any_self_) begin_flat(piece);
  give_back(pairs_.vertex_face, pairs_.edge_edge);  // their memory is needed for the search
  Touching touching;
  finder_.find(boxes_, any_self_, pairs_, patches_.flat(), sieve(cloth, piece, &touching));
  runs_vertex_face_.begin();
  runs_edge_edge_.begin();
  touching.sort();
  blocked_ = std::move(touching.pairs);
  return touching.earliest;
}

/// Keeps what can come nearer than the contact radius. With `touching` it finds what touches on its way there, too.
PairSieve Candidates::sieve(const ClothMotion& cloth, const PieceMotion& piece, Touching* touching) const {
  const VertexWays ways{piece.start, piece.all, piece.centre, piece.slack};
  return [this, &cloth, ways, touching](PairKind kind, const Stencil& pair) {
    const bool self = pair.v[0] < model_.vertex_count() && pair.v[3] < model_.vertex_count();
    const SweptMotion way(kind, pair, ways, self ? self_radius_ : radius_, k_clear);
    auto verdict = SweptMotion::Verdict::k_open;
    const auto is_apart = [&](const Vec3& normal) {
      verdict = std::max(verdict, way.judge(normal));
      return verdict == SweptMotion::Verdict::k_apart;
    };
    if (is_apart(way.between_centres()) || is_apart(way.flat()) || is_apart(way.between_last_centres()) ||
        !counts(cloth, kind, pair))
      return false;
    const std::array<Vec3, 4> x = gather(ways.x, pair), d = gather(ways.d, pair);
    std::array<Vec3, 4> carried;
    for (std::size_t k = 0; k < 4; ++k) carried[k] = x[k] + d[k];
    if (is_apart(pair_geometry(kind, carried).normal)) return false;
    if (touching != nullptr && verdict == SweptMotion::Verdict::k_open)
      touching->take(kind, pair, ccd_time(kind, x, d));
    return true;
  };
}

bool Candidates::cloth_blocks_cloth() const {
  const auto any = [&](const std::vector<Stencil>& blocked) {
    return std::any_of(blocked.begin(), blocked.end(), [&](const Stencil& s) { return part_of(s) < 0; });
  };
  return any(blocked_.vertex_face) || any(blocked_.edge_edge);
}

bool Candidates::is_blocked(PairKind kind, PairKey key) const {
  const auto& blocked = kind == PairKind::k_vertex_face ? blocked_.vertex_face : blocked_.edge_edge;
  return !blocked.empty() && std::binary_search(blocked.begin(), blocked.end(), pairs_.features.stencil(kind, key));
}

void Candidates::drop_blocked() {
  runs_vertex_face_.erase_if(pairs_.vertex_face, [&](PairKey key) { return is_blocked(PairKind::k_vertex_face, key); });
  runs_edge_edge_.erase_if(pairs_.edge_edge, [&](PairKey key) { return is_blocked(PairKind::k_edge_edge, key); });
}

}  // namespace ft::inline solvers
