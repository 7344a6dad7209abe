// The pairs of one piece of a substep: complete for all that the solve may do, also after it got more room; what was
// let pass stays out.
#include "solvers/cloth/advance/candidates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "baker/core/random.h"
#include "tests/support/numbered_pairs.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

constexpr double k_step = 0.01;
constexpr std::uint64_t k_seed = 5;

/// Two sheets of cells x cells, 10 mm above each other; the upper one moves at `speed` along y.
struct TwoSheets {
  std::unique_ptr<ClothModel> model;
  ClothMotion cloth;
  PieceMotion piece;

  explicit TwoSheets(double speed, int cells = 8) {
    ClothSetup setup;
    setup.preroll_frames = 0;
    for (const double height : {0.0, 0.01}) {
      ClothGarment sheet;
      sheet.name = height > 0 ? "upper" : "lower";
      sheet.mesh = make_sheet(0.2, cells, height);
      setup.garments.push_back(std::move(sheet));
    }
    auto built = build_cloth_model(std::move(setup));
    EXPECT_TRUE(built);
    model = std::move(*built);
    const std::size_t n = model->start.size();
    cloth.x = cloth.x_previous = cloth.x_older = piece.start = model->start;
    cloth.v.assign(n, Vec3::Zero());
    for (std::size_t i = n / 2; i < n; ++i) cloth.v[i].y() = speed;
    cloth.v_previous = cloth.v_older = cloth.v;
    cloth.h_previous = k_step;
    cloth.tangled.assign(n, 0);
  }
  double collect(Candidates& candidates) {
    candidates.find_near(cloth, k_step, piece);
    candidates.carry(cloth, k_step, piece);
    return candidates.collect(cloth, k_step, piece);
  }
};

std::vector<Vec3> somewhere_in_reach(const TwoSheets& s, std::uint64_t draw) {
  std::vector<Vec3> out(s.cloth.x.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    Vec3 d;
    for (int k = 0; k < 3; ++k) d[k] = 2 * random_uniform({k_seed, 0, draw, i}, static_cast<std::uint64_t>(k)) - 1;
    out[i] = s.cloth.x[i] + s.piece.centre[i].cast<double>() + s.piece.slack[i] / std::max(1.0, d.norm()) * d;
  }
  return out;
}

ContactPairs pairs_of(const Candidates& candidates) {
  return test::stencils_of(candidates.pairs());
}

std::vector<Stencil> sorted(std::vector<Stencil> pairs) {
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

ContactPairs sorted(const ContactPairs& pairs) {
  return {sorted(pairs.vertex_face), sorted(pairs.edge_edge)};
}

bool contains(const std::vector<Stencil>& sorted, const Stencil& s) {
  return std::binary_search(sorted.begin(), sorted.end(), s);
}

/// What solves have found out about the pairs of before stays true, and none is worked out twice.
void expect_all_new_behind(const ContactPairs& before, const ContactPairs& now) {
  for (const auto list : {&ContactPairs::vertex_face, &ContactPairs::edge_edge}) {
    const std::vector<Stencil>&a = before.*list, &b = now.*list;
    ASSERT_GT(a.size(), 100u);
    ASSERT_LT(a.size() + 100, b.size());
    EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin()));
    const std::vector<Stencil> all = sorted(b);
    EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end()) << "twice";
  }
}

/// Pairs of vertices with faces, and of edges, that touch at some of the places where the solve may put them.
ContactPairs touching(const TwoSheets& s) {
  ContactPairs out;
  const double radius = ContactModel::self_radius(s.model->contact.radius.front());
  const auto edges = unique_edges(s.model->triangles);
  for (std::uint64_t draw = 0; draw < 6; ++draw) {
    const auto x = somewhere_in_reach(s, draw);
    for (int v = 0; v < s.model->vertex_count(); ++v)
      for (const Triangle& t : s.model->triangles)
        if (v != t[0] && v != t[1] && v != t[2] &&
            vertex_face_geometry(x[at(v)], x[at(t[0])], x[at(t[1])], x[at(t[2])]).distance < radius)
          out.vertex_face.push_back({{v, t[0], t[1], t[2]}});
    for (std::size_t a = 0; a < edges.size(); ++a)
      for (std::size_t b = a + 1; b < edges.size(); ++b) {
        const Edge &p = edges[a], &q = edges[b];
        if (p[0] == q[0] || p[0] == q[1] || p[1] == q[0] || p[1] == q[1]) continue;
        if (edge_edge_geometry(x[at(p[0])], x[at(p[1])], x[at(q[0])], x[at(q[1])]).distance < radius)
          out.edge_edge.push_back({{p[0], p[1], q[0], q[1]}});
      }
  }
  return out;
}

int missing_in(const ContactPairs& pairs, const ContactPairs& needed) {
  const ContactPairs list = sorted(pairs);
  int out = 0;
  for (const Stencil& s : needed.vertex_face) out += !contains(list.vertex_face, s);
  for (const Stencil& s : needed.edge_edge) out += !contains(list.edge_edge, s);
  return out;
}

TEST(Candidates, lists_neighbours_only_where_the_cloth_is_about_to_bend) {
  TwoSheets s(0, 60);  // edges of 3.3 mm: neighbours are in reach of each other
  Candidates candidates(*s.model);
  EXPECT_EQ(s.collect(candidates), 1);
  const int half = s.model->vertex_count() / 2;
  const auto of_one_sheet = [&](const std::vector<Stencil>& pairs) {
    return std::count_if(pairs.begin(), pairs.end(),
                         [&](const Stencil& p) { return (p.v[0] < half) == (p.v[3] < half); });
  };
  EXPECT_EQ(of_one_sheet(pairs_of(candidates).edge_edge) + of_one_sheet(pairs_of(candidates).vertex_face), 0);
  std::vector<Vec3> x = s.cloth.x;
  for (Vec3& p : x) p.y() += 1e-4 * std::sin(300 * p.x());
  EXPECT_TRUE(candidates.keep_flat(s.cloth, x, s.piece));

  for (int i = half; i < 2 * half; ++i) {  // a pleat of the upper sheet
    Vec3& p = x[at(i)];
    if (p.x() > 0.02) p.x() = p.x() < 0.04 ? 0.04 - p.x() : p.x() - 0.04;
  }
  EXPECT_FALSE(candidates.keep_flat(s.cloth, x, s.piece));
  EXPECT_TRUE(candidates.keep_flat(s.cloth, x, s.piece));
  EXPECT_GT(of_one_sheet(pairs_of(candidates).edge_edge), 1000);
  EXPECT_GT(of_one_sheet(pairs_of(candidates).vertex_face), 300);
  const ContactPairs pairs = pairs_of(candidates);
  for (const Stencil& p : pairs.edge_edge) {
    const bool near_the_pleat = std::abs(s.cloth.x[at(p.v[0])].x() - 0.03) < 0.05;
    EXPECT_TRUE(near_the_pleat || p.v[0] < half || p.v[3] < half);
  }
}

TEST(Candidates, are_complete_before_and_after_vertices_get_other_room) {
  TwoSheets s(0);
  Candidates candidates(*s.model);
  EXPECT_EQ(s.collect(candidates), 1);
  EXPECT_EQ(missing_in(pairs_of(candidates), touching(s)), 0);
  const ContactPairs before = pairs_of(candidates);
  // Every third vertex wants to leave its ball, then every third but one, and some of these twice; none comes near
  // others of its sheet.
  const auto ask = [&](std::uint64_t round, auto&& asks) {
    const std::vector<Vec3> from = somewhere_in_reach(s, 100 + round);
    std::vector<RoomRequest> requests;
    for (std::size_t i = 0; i < from.size(); ++i) {
      if (!asks(i)) continue;
      Vec3 way;
      for (int k = 0; k < 3; ++k) way[k] = 2 * random_uniform({k_seed, 1, round, i}, static_cast<std::uint64_t>(k)) - 1;
      requests.push_back({static_cast<int>(i), from[i], from[i] + Vec3(0.006, 0.015, 0.006).cwiseProduct(way), 1e-3});
    }
    candidates.give_room(s.cloth, requests, s.piece);
    for (const RoomRequest& r : requests)
      for (const Vec3& p : {r.from, r.to})
        EXPECT_LE((s.cloth.x[at(r.vertex)] + s.piece.centre[at(r.vertex)].cast<double>() - p).norm(),
                  s.piece.slack[at(r.vertex)]);
  };
  ask(0, [](std::size_t i) { return i % 3 == 0; });
  const ContactPairs needed = touching(s);
  EXPECT_EQ(missing_in(pairs_of(candidates), needed), 0);
  EXPECT_GT(missing_in(before, needed), 100) << "the list of before would have done";

  const ContactPairs some = pairs_of(candidates);
  ask(1, [](std::size_t i) { return i % 3 == 1 || i % 9 == 0; });
  EXPECT_EQ(missing_in(pairs_of(candidates), touching(s)), 0);
  expect_all_new_behind(some, pairs_of(candidates));
}

TEST(Candidates, are_complete_when_what_would_meet_is_carried_as_one) {
  TwoSheets s(-2);  // 20 mm in a step: through the lower sheet
  Candidates candidates(*s.model);
  ASSERT_LT(s.collect(candidates), 1);
  double t = 0;
  for (int round = 0; t < 1 && round < 4; ++round) t = candidates.join_blocked(s.cloth, s.piece);
  EXPECT_EQ(t, 1);
  EXPECT_EQ(missing_in(pairs_of(candidates), touching(s)), 0);
}

TEST(Candidates, are_complete_when_what_would_meet_is_kept_apart) {
  TwoSheets s(-2);
  for (std::size_t i = s.cloth.v.size() / 2; i < s.cloth.v.size(); ++i) s.cloth.v[i].x() = 0.3;
  Candidates candidates(*s.model);
  ASSERT_LT(s.collect(candidates), 1);
  const std::vector<Vec3> wanted = s.piece.carry;
  double t = 0;
  int rounds = 0;
  for (; t < 1 && rounds < 8; ++rounds) t = candidates.part_blocked(s.cloth, s.piece);
  EXPECT_EQ(t, 1);
  EXPECT_EQ(missing_in(pairs_of(candidates), touching(s)), 0);
  for (std::size_t i = 0; i < wanted.size(); ++i)
    EXPECT_NEAR(s.piece.carry[i].x(), wanted[i].x(), 1e-4) << "only what they approach by is taken";
}

TEST(Candidates, that_were_let_pass_stay_out_when_vertices_get_other_room) {
  TwoSheets s(-2);
  Candidates candidates(*s.model);
  ASSERT_LT(s.collect(candidates), 1);
  const ContactPairs all = sorted(pairs_of(candidates));
  EXPECT_EQ(candidates.release_blocked(s.cloth, s.piece, {}), 0) << "there is no body to be let through";
  const ContactPairs left = sorted(pairs_of(candidates));
  ASSERT_LT(left.vertex_face.size(), all.vertex_face.size());
  ASSERT_LT(left.edge_edge.size(), all.edge_edge.size());
  std::vector<RoomRequest> requests;
  for (std::size_t i = 0; i < s.cloth.x.size(); ++i) {
    const Vec3 carried = s.cloth.x[i] + s.piece.carry[i];
    requests.push_back({static_cast<int>(i), carried, carried + Vec3(0, -1e-3, 0), 1e-3});
  }
  candidates.give_room(s.cloth, requests, s.piece);
  const ContactPairs grown = sorted(pairs_of(candidates));
  const auto back = [](const std::vector<Stencil>& before, const std::vector<Stencil>& without,
                       const std::vector<Stencil>& now) {
    return std::count_if(before.begin(), before.end(),
                         [&](const Stencil& p) { return !contains(without, p) && contains(now, p); });
  };
  EXPECT_EQ(back(all.vertex_face, left.vertex_face, grown.vertex_face), 0);
  EXPECT_EQ(back(all.edge_edge, left.edge_edge, grown.edge_edge), 0);
}

}  // namespace
}  // namespace ft
