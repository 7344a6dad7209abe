// Buttons: where they hold and how firmly, that what hangs on them hangs by the balance of forces, and that nothing
// comes from nothing.
#include <cmath>
#include <numbers>

#include "solvers/energies/attachments.h"
#include "tests/solvers/strips.h"

namespace ft {
namespace {

/// The lower right corner of the first strip, which is held above, carries the upper left corner of the second, 4 mm
/// lower.
ClothSetup two_strips() {
  ClothGarment upper = strip("upper", 0, 0), lower = strip("lower", 0.06, -0.184);
  upper.pins.push_back(pin_of({0, 1, 2, 3}));
  lower.pins.push_back(pin_of({0}, 0));
  return in_vacuum({upper, lower});
}

TEST(Attach, A_vertex_holds_to_the_nearest_point_of_the_other_garment) {
  ClothSetup setup = two_strips();
  const auto model = model_of(setup);
  ASSERT_EQ(model->attachments.size(), 1u);
  const AttachPoint& p = model->attachments[0];
  EXPECT_EQ(p.vertex, k_strip);
  EXPECT_LT((cord(p, model->contact.rest) - Vec3(0, -4e-3, 0)).norm(), 1e-12);
  EXPECT_NEAR(p.length, 4e-3, 1e-12);
  const double border = 0.02;  // half of either edge at the corner
  EXPECT_NEAR(p.stiffness, AttachSettings{}.stiffness * border, 1e-6);
  EXPECT_NEAR(p.max_pull, AttachSettings{}.hold * border, 1e-9);
  EXPECT_EQ(model->pins.size(), 4u) << "the body holds only what is pinned to it";
  setup.garments[1].pins[0].weights = {0.25};
  EXPECT_NEAR(model_of(setup)->attachments[0].max_pull, 0.25 * p.max_pull, 1e-12);
  setup.garments[1].pins[0].to = 2;
  EXPECT_FALSE(build_cloth_model(setup));
}

TEST(Attach, A_cord_is_no_shorter_than_the_distance_at_which_the_garments_touch) {
  ClothSetup setup = two_strips();
  for (Vec3& x : setup.garments[1].mesh.positions) x.y() += 3.9e-3;
  setup.garments[1].thickness = 1e-3;  // the thinner one decides how near they come
  const auto model = model_of(setup);
  EXPECT_NEAR(model->attachments[0].length, ContactModel::self_radius(model->contact.radius[k_strip]), 1e-15);
}

/// A strip that was laid into a ring around the y axis, open by 5 mm; its columns run along the axis.
ClothGarment ring() {
  ClothGarment out = strip("ring", 0, 0);
  const double round = 0.185, radius = round / (2 * std::numbers::pi);
  for (Vec3& x : out.mesh.positions) {
    const double angle = -x.y() / round * 2 * std::numbers::pi;
    x = Vec3(radius * std::cos(angle), -x.x(), radius * std::sin(angle));
  }
  return out;
}

TEST(Attach, Within_one_garment_a_vertex_holds_to_the_other_side_of_the_opening) {
  ClothGarment jacket = ring();
  jacket.pins.push_back(pin_of({0, 1, 2, 3}, 0));
  const auto model = model_of(in_vacuum({jacket}));
  ASSERT_EQ(model->attachments.size(), 4u);
  for (const AttachPoint& p : model->attachments) {
    EXPECT_NEAR(p.length, 5e-3, 1e-4);
    EXPECT_LT(cord(p, model->contact.rest).norm(), 5.1e-3);
    for (const int v : p.triangle) EXPECT_GE(v, k_strip - 8) << "the last two rows";
  }
}

TEST(Attach, Where_a_slit_ends_nothing_is_held) {
  // Two panels beside each other, 3 mm apart, that are one below the sixth row.
  ClothGarment dress;
  dress.name = "dress";
  const int cells = 8, rows = 8, slit = 6, row = cells + 2;
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i < row; ++i) points.emplace_back(0.01 * i - (i > cells / 2 ? 0.007 : 0), -0.01 * j, 0);
  const auto column = [&](int i, int j, bool right) {
    if (i == cells / 2 && !right && j >= slit) return i + 1;  // the sides share what is below
    return i + (i > cells / 2 || (i == cells / 2 && right) ? 1 : 0);
  };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < cells; ++i) {
      const bool right = i >= cells / 2;
      const int a = row * j + column(i, j, right), b = row * j + column(i + 1, j, right);
      const int c = row * (j + 1) + column(i, j + 1, right), d = row * (j + 1) + column(i + 1, j + 1, right);
      triangles.push_back({a, c, d});
      triangles.push_back({a, d, b});
    }
  dress.mesh = make_triangle_mesh("dress", points, triangles);
  std::vector<int> left;
  for (int j = 0; j < slit; ++j) left.push_back(row * j + cells / 2);
  ClothPin zip = pin_of(left, 0);
  const ClothGarment garments[] = {dress};
  for (const SurfacePoint& f : anchor_points(garments, 0, zip)) EXPECT_NEAR(f.distance, 3e-3, 1e-12);
  zip.vertices = {row * slit + cells / 2 + 1, row * 3 + 1};  // the end of the slit, and the middle of a panel
  for (const SurfacePoint& f : anchor_points(garments, 0, zip)) EXPECT_EQ(f.triangle[0], -1);
}

TEST(Attach, Two_strips_joined_at_a_corner_hang_by_the_balance_of_forces) {
  ClothSetup setup = two_strips();
  setup.bdf2 = false;
  setup.min_substeps = 2;  // long steps of implicit Euler calm the swing
  for (ClothGarment& g : setup.garments) g.fabric.damping = 0.05, g.self_collision = false;
  setup.garments[1].pins[0].weights = {1e-3};  // soft: it lengthens by some millimetres
  const auto model = model_of(setup);
  const auto states = states_of(setup, 240);
  const auto x = as_points(*states.back().find("x"));
  const AttachPoint& p = model->attachments[0];
  const Vec3 d = cord(p, x);
  double hanging = 0;
  Vec3 centre = Vec3::Zero();
  for (int i = k_strip; i < 2 * k_strip; ++i) hanging += model->mass[at(i)], centre += model->mass[at(i)] * x[at(i)];
  const double expected = hanging * k_gravity / p.stiffness;
  ASSERT_GT(expected, 1e-3);
  EXPECT_NEAR(d.norm() - p.length, expected, 0.01 * expected);
  EXPECT_NEAR(d.normalized().y(), -1, 1e-3) << "plumb";
  EXPECT_NEAR(centre.x() / hanging, x[at(p.vertex)].x(), 2e-3) << "what hangs on a point has its centre below it";
}

TEST(Attach, A_cord_pulls_at_both_ends_alike_and_does_not_turn_them) {
  const auto model = model_of(two_strips());
  ClothTopology topology;
  topology.attachments = model->attachments;
  Attachments energy(topology);
  energy.begin_step({});
  std::vector<Vec3> x = model->own_rest, g(x.size(), Vec3::Zero());
  for (int i = k_strip; i < 2 * k_strip; ++i) x[at(i)] += Vec3(0.01, -0.02, 0.03);
  energy.add_gradient(x, g);
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  for (std::size_t i = 0; i < x.size(); ++i) force += g[i], moment += x[i].cross(g[i]);
  ASSERT_GT(g[k_strip].norm(), 1);
  EXPECT_LT(force.norm(), 1e-14 * g[k_strip].norm());
  EXPECT_LT(moment.norm(), 1e-14 * g[k_strip].norm());
}

TEST(Attach, Garments_that_fly_buttoned_together_keep_their_momentum) {
  // One stands and the other flies off at 0.5 m/s: they are jerked by the button, and it holds.
  ClothSetup setup = accurate_setup({}, plain_fabric(0.15, 500, 1e-4, 0.3), 24, 64);
  setup.linear_tolerance = 1e-7;
  setup.newton_iterations = 20;
  setup.gravity.setZero();
  const Fabric fabric = setup.garments[0].fabric;
  setup.garments = two_strips().garments;
  setup.garments[0].pins.clear();
  for (ClothGarment& g : setup.garments) g.fabric = fabric, g.self_collision = false;
  const auto model = model_of(setup);
  ClothRun run(setup);
  run.set_velocity([](const Vec3& p) { return p.y() < -0.182 ? Vec3(0.3, -0.3, 0.2) : Vec3(0, 0, 0); });
  const auto momentum = [&](std::size_t first, std::size_t end) {
    Vec3 sum = Vec3::Zero();
    const auto v = run.velocities();
    for (std::size_t i = first; i < end; ++i) sum += model->mass[i] * v[i];
    return sum;
  };
  const Vec3 start = momentum(0, 2 * k_strip);
  for (int f = 0; f < 12; ++f) {
    run.advance();
    EXPECT_LT((momentum(0, 2 * k_strip) - start).norm(), 1e-8 * start.norm()) << f;
  }
  EXPECT_GT(momentum(0, k_strip).norm(), 0.1 * start.norm()) << "the first one was drawn along";
  const AttachPoint& p = model->attachments[0];
  EXPECT_LT(cord(p, run.positions()).norm(), p.length + 1e-3);
}

TEST(Attach, Two_buttoned_layers_rest_at_the_contact_distance_and_do_not_slide) {
  // They start 0.5 mm apart, nearer than cloth comes to cloth; the upper one lies loose on a slope, buttoned at a
  // point.
  const double slope = 0.5;
  const auto sheet = [&](const char* name, double height) {
    ClothGarment out;
    out.name = name;
    out.mesh = rectangle_mesh(8, 8, [&](double s, double t) {
      const double along = 0.16 * (s - 0.5);
      return Vec3(std::cos(slope) * along - std::sin(slope) * height,
                  std::sin(slope) * along + std::cos(slope) * height, 0.16 * (t - 0.5));
    });
    out.self_friction = 0;
    return out;
  };
  ClothGarment under = sheet("under", 0), over = sheet("over", 0.5e-3);
  std::vector<int> all(81);
  for (int i = 0; i < 81; ++i) all[at(i)] = i;
  under.pins.push_back(pin_of(all));
  over.pins.push_back(pin_of({40}, 0));
  ClothSetup setup = in_vacuum({under, over});
  const auto model = model_of(setup);
  const auto states = states_of(setup, 48);
  const AttachPoint& p = model->attachments[0];
  EXPECT_EQ(p.length, ContactModel::self_radius(model->contact.radius[0]));
  const Vec3 normal(-std::sin(slope), std::cos(slope), 0);
  for (int f = 12; f <= 48; ++f) {
    const auto x = as_points(*states[at(f)].find("x"));
    const double apart = normal.dot(cord(p, x));
    EXPECT_NEAR(apart, p.length, 0.1 * p.length) << f;
    EXPECT_LT(cord(p, x).norm(), p.length + 0.1e-3) << f;
  }
  setup.garments[1].pins.clear();
  const auto loose = states_of(setup, 12);
  EXPECT_GT((as_points(*loose[12].find("x"))[at(p.vertex)] - as_points(*loose[0].find("x"))[at(p.vertex)]).norm(), 0.05)
      << "without its button it slides off";
}

}  // namespace
}  // namespace ft
