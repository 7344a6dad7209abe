// Hair that grows: on a ball, where all is known, and on the head of a real figure.
#include "baker/systems/hair/growth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "baker/core/parallel.h"
#include "baker/core/shapes.h"
#include "baker/systems/hair/roots.h"
#include "collision/geometry/nearest_point.h"
#include "collision/geometry/winding_number.h"
#include "io/hair/resample.h"
#include "io/shot/mesh_file.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

/// A head of 0.1 m radius, painted above its equator or as a function of the vertex says.
struct Head {
  TriangleSurface surface = sphere_surface(0.1, 4);
  std::vector<double> weight;

  explicit Head(const std::function<double(const Vec3&)>& paint = [](const Vec3& p) { return p.y() > 0 ? 1.0 : 0.0; }) {
    for (const Vec3& p : surface.positions) weight.push_back(paint(p));
  }
  std::vector<GrownStrand> grow(const Growth& growth) const {
    auto out = grown(growth, surface.positions, surface.triangles, {surface.positions, surface.triangles, weight});
    EXPECT_TRUE(out) << out.error().text();
    return out ? std::move(*out) : std::vector<GrownStrand>{};
  }
  double area() const {
    double out = 0;
    for (const double a : painted_areas(surface.positions, surface.triangles, weight)) out += a;
    return out;
  }
};

Growth sparse() {
  Growth g;
  g.density = 3000;  // of 0.06 m2 some 190
  g.length = 0.2;
  return g;
}

TEST(GrownHair, Is_as_many_strands_as_the_painted_area_says) {
  const Head head;
  const auto strands = head.grow(sparse());
  EXPECT_EQ(static_cast<double>(strands.size()), std::round(3000 * head.area()));
  for (const GrownStrand& s : strands) EXPECT_EQ(s.line.size(), 24u);
}

TEST(GrownHair, Roots_are_on_painted_triangles) {
  const Head head;
  for (const GrownStrand& s : head.grow(sparse())) {
    const Triangle& t = head.surface.triangles[at(s.triangle)];
    Vec3 place = Vec3::Zero();
    double painted = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_TRUE(s.weight[k] >= 0 && s.weight[k] <= 1);
      place += s.weight[k] * head.surface.positions[at(t[k])];
      painted += s.weight[k] * head.weight[at(t[k])];
    }
    EXPECT_LT((place - s.line.front()).norm(), 1e-12);
    EXPECT_GT(painted, 0);
  }
}

TEST(GrownHair, Roots_keep_apart) {
  const auto strands = Head().grow(sparse());
  double least = 1;
  for (std::size_t i = 0; i < strands.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      least = std::min(least, (strands[i].line.front() - strands[j].line.front()).norm());
  EXPECT_GT(least, 0.4 / std::sqrt(3000.0));  // of roots by lot alone the nearest pair is some 0.02 of it apart
}

TEST(GrownHair, Is_dense_where_much_is_painted) {
  const Head head([](const Vec3& p) { return p.x() > 0 ? 0.8 : 0.2; });
  int right = 0, left = 0;
  for (const GrownStrand& s : head.grow(sparse())) ++(s.line.front().x() > 0 ? right : left);
  EXPECT_NEAR(static_cast<double>(right) / left, 4, 0.6);
}

/// Where something is in a body or too near to it; by looking at all triangles.
void expect_outside(std::span<const GrownStrand> strands, std::span<const Vec3> x, std::span<const Triangle> triangles,
                    std::size_t each = 1) {
  for (std::size_t i = 0; i < strands.size(); i += each)
    for (std::size_t v = 1; v < strands[i].line.size(); ++v) {
      const Vec3& p = strands[i].line[v];
      EXPECT_LT(std::abs(winding_number(p, x, triangles)), 0.5) << "strand " << i << ", vertex " << v;
      EXPECT_GT(nearest_point(p, x, triangles).distance, 0.99 * k_strand_gap) << "strand " << i << ", vertex " << v;
    }
}

TEST(GrownHair, Is_outside_of_the_body) {
  const Head head;
  Growth g = sparse();
  for (const double lift : {0.0, 0.4, 1.0})
    for (const double curl : {0.0, 0.01}) {
      g.lift = lift, g.curl_radius = curl, g.clump_size = 2 * curl;
      expect_outside(head.grow(g), head.surface.positions, head.surface.triangles, 7);
    }
}

TEST(GrownHair, Lengths_vary_as_wanted) {
  Growth g = sparse();
  g.length_variation = 0.3;
  double least = 1, most = 0;
  for (const GrownStrand& s : Head().grow(g)) {
    const double length = length_of(s.line);
    least = std::min(least, length), most = std::max(most, length);
  }
  // What chords lose on the way round a ball of 0.1 m, and a last push gains.
  EXPECT_NEAR(least, 0.14, 0.004);
  EXPECT_NEAR(most, 0.26, 0.004);
  g.length_variation = 0, g.curl_radius = 0.01, g.vertices = 200;
  for (const GrownStrand& s : Head().grow(g)) EXPECT_NEAR(length_of(s.line), 0.2, 0.01);  // along the curl
}

TEST(GrownHair, Same_seed_is_the_same_bits_for_any_number_of_threads) {
  const Head head;
  Growth g = sparse();
  g.curl_radius = 0.005, g.clump_size = 0.02, g.part = Parting{{0, 0.1, 0}, Vec3::UnitZ()};
  const auto first = head.grow(g);
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    const auto again = head.grow(g);
    ASSERT_EQ(again.size(), first.size());
    for (std::size_t i = 0; i < first.size(); ++i) ASSERT_EQ(again[i].line, first[i].line);
  }
  g.seed = 2;
  const auto other = head.grow(g);
  int same = 0;
  for (std::size_t i = 0; i < first.size(); ++i) same += other[i].line == first[i].line ? 1 : 0;
  EXPECT_EQ(same, 0);
}

TEST(GrownHair, Leaves_along_the_normal_by_its_lift) {
  Growth g = sparse();
  g.volume = 0;
  double before = -1;
  for (const double lift : {0.0, 0.5, 1.0}) {
    g.lift = lift;
    double mean = 0;
    const auto strands = Head().grow(g);
    for (const GrownStrand& s : strands)
      mean += s.line.front().normalized().dot((s.line[1] - s.line[0]).normalized()) / double(strands.size());
    EXPECT_GT(mean, before + 0.1);
    before = mean;
  }
  EXPECT_GT(before, 0.9);
}

TEST(GrownHair, Hangs_where_the_comb_points) {
  Growth g = sparse();
  g.length = 0.5;
  for (const GrownStrand& s : Head().grow(g)) {
    EXPECT_LT(s.line.back().y(), -0.15);
    EXPECT_GT((s.line[22] - s.line[23]).normalized().y(), 0.95);
  }
  g.comb = Vec3(0, 1, 0), g.bend = 0.05;  // on end
  for (const GrownStrand& s : Head().grow(g)) EXPECT_GT(s.line.back().y(), 0.4);
}

TEST(GrownHair, Lies_to_the_side_of_its_parting) {
  Growth g = sparse();
  g.lift = 0.2;
  const auto crossings = [&] {
    int out = 0;
    for (const GrownStrand& s : Head().grow(g)) out += s.line.front().x() * s.line.back().x() < 0 ? 1 : 0;
    return out;
  };
  const auto sideways = [&] {  // of roots near the line: how far tips are to the side
    double sum = 0;
    int count = 0;
    for (const GrownStrand& s : Head().grow(g))
      if (std::abs(s.line.front().x()) < 0.02) sum += std::abs(s.line.back().x()), ++count;
    return sum / count;
  };
  const double without = sideways();
  g.part = Parting{{0, 0.1, 0}, {0, 0, -3}};
  EXPECT_GT(sideways(), 1.3 * without);
  EXPECT_EQ(crossings(), 0);
}

TEST(GrownHair, Locks_draw_together_and_curls_wind) {
  Growth g = sparse();
  g.density = 20000;
  /// Mean distance of a strand's tip to the nearest other one [m].
  const auto tip_distance = [&] {
    const auto strands = Head().grow(g);
    double sum = 0;
    for (const auto& a : strands) {
      double least = 1;
      for (const auto& b : strands)
        if (&a != &b) least = std::min(least, (a.line.back() - b.line.back()).norm());
      sum += least / double(strands.size());
    }
    return sum;
  };
  const double loose = tip_distance();
  g.clump_size = 0.03, g.length_variation = 0;
  EXPECT_LT(tip_distance(), 0.8 * loose);
  // A curled strand is as much shorter from end to end as a helix is: pitch / sqrt(pitch^2 + (2 pi radius)^2).
  g = sparse();
  g.comb = Vec3::UnitY(), g.lift = 1, g.length_variation = 0, g.vertices = 300, g.length = 0.4;
  g.curl_radius = 0.01, g.curl_pitch = 0.05;
  const Head top([](const Vec3& p) { return p.y() > 0.09 ? 1.0 : 0.0; });
  const double helix = 0.05 / std::hypot(0.05, 2 * 3.14159265358979 * 0.01);
  for (const GrownStrand& s : top.grow(g))
    EXPECT_NEAR((s.line.back() - s.line.front()).norm() / 0.4, helix, 0.12);  // it begins straight; pitches vary
}

TEST(GrownHair, What_makes_no_sense_is_refused) {
  const Head head;
  const auto refused = [&](const std::function<void(Growth&)>& spoil, const char* word) {
    Growth g = sparse();
    spoil(g);
    const auto out = grown(g, head.surface.positions, head.surface.triangles,
                           {head.surface.positions, head.surface.triangles, head.weight});
    ASSERT_FALSE(out) << word;
    EXPECT_EQ(out.error().kind, ErrorKind::k_usage);
    EXPECT_NE(out.error().text().find(word), std::string::npos) << out.error().text();
  };
  const double nan = std::nan("");
  refused([](Growth& g) { g.density = 0; }, "density");
  refused([&](Growth& g) { g.density = nan; }, "density");
  refused([](Growth& g) { g.density = 1e9; }, "500000 are the most");
  refused([](Growth& g) { g.density = 1; }, "no strand");
  refused([&](Growth& g) { g.length = nan; }, "length has");
  refused([](Growth& g) { g.length_variation = 1; }, "length_variation");
  refused([](Growth& g) { g.curl_radius = -1; }, "curl_radius");
  refused([](Growth& g) { g.curl_radius = 0.01, g.curl_pitch = 0; }, "curl_pitch");
  refused([&](Growth& g) { g.clump_size = nan; }, "clump_size");
  refused([](Growth& g) { g.lift = 1.1; }, "lift");
  refused([](Growth& g) { g.bend = 0; }, "bend");
  refused([](Growth& g) { g.volume = -0.1; }, "volume");
  refused([](Growth& g) { g.comb = Vec3::Zero(); }, "comb");
  refused([](Growth& g) { g.part = Parting{Vec3::Zero(), Vec3::Zero()}; }, "part");
  refused([](Growth& g) { g.vertices = 1; }, "vertices");
  const std::vector<double> none(head.weight.size(), 0.0), much(head.weight.size(), 1.5);
  EXPECT_FALSE(grown(sparse(), head.surface.positions, head.surface.triangles,
                     {head.surface.positions, head.surface.triangles, none}));
  EXPECT_FALSE(grown(sparse(), head.surface.positions, head.surface.triangles,
                     {head.surface.positions, head.surface.triangles, much}));
  EXPECT_FALSE(grown(sparse(), head.surface.positions, head.surface.triangles,
                     {head.surface.positions, head.surface.triangles, std::span(none).first(3)}));
  EXPECT_FALSE(grown(sparse(), {}, {}, PaintedRegion()));
}

TEST(GrownHair, Is_outside_of_a_real_figure) {
  const auto path = test::assets_root() / "garments/cipc_mannequin_rumba/body_frame0_yup.obj";
  FT_REQUIRE_FILE(path);
  const auto mesh = read_obj(path);
  ASSERT_TRUE(mesh) << mesh.error().text();
  const auto triangles = triangulate(*mesh);
  const double top = bounds(mesh->positions).hi.y();
  std::vector<double> weight;
  for (const Vec3& p : mesh->positions) weight.push_back(p.y() > top - 0.09 ? 1.0 : 0.0);
  Growth g;
  g.density = 4000, g.length = 0.45, g.clump_size = 0.02, g.curl_radius = 0.006;
  const auto strands = grown(g, mesh->positions, triangles, {mesh->positions, triangles, weight});
  ASSERT_TRUE(strands) << strands.error().text();
  EXPECT_GT(strands->size(), 50u);
  // Its hair is modelled in layers that leave folds narrower than two gaps.
  int near = 0, count = 0;
  for (std::size_t i = 0; i < strands->size(); i += 9)
    for (std::size_t v = 1; v < (*strands)[i].line.size(); ++v, ++count) {
      const Vec3& p = (*strands)[i].line[v];
      EXPECT_LT(std::abs(winding_number(p, mesh->positions, triangles)), 0.5) << "strand " << i << ", vertex " << v;
      near += nearest_point(p, mesh->positions, triangles).distance < 0.99 * k_strand_gap ? 1 : 0;
    }
  EXPECT_LT(near, count / 50);
  double lowest = top;
  for (const GrownStrand& s : *strands) lowest = std::min(lowest, s.line.back().y());
  EXPECT_LT(lowest, top - 0.3);
}

}  // namespace
}  // namespace ft
