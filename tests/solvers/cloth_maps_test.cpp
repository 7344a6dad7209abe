// Cloth that varies over its surface: maps of one value are no maps, two values are two cloths, and thickness reaches
// the contact.
#include <gtest/gtest.h>

#include "solvers/cloth/cloth_solver.h"
#include "solvers/cloth/model/contact_potential.h"
#include "tests/support/numbered_pairs.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

std::shared_ptr<ScriptedBody> still_ball() {
  Surface surface;
  std::vector<Vec3> points;
  make_sphere(0.2, 12, 18, points, surface.triangles);
  return std::make_shared<ScriptedBody>(surface, points, 0.0, [](double, std::span<Vec3>) {});
}

/// A box of 1 m whose lid is y = 0.
std::shared_ptr<ScriptedBody> floor_body() {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.emplace_back((i & 1) - 0.5, (i >> 1 & 1) - 1.0, (i >> 2 & 1) - 0.5);
  Surface surface;
  surface.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                       {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return std::make_shared<ScriptedBody>(surface, corners, 0.0, [](double, std::span<Vec3>) {});
}

ClothSetup one_garment(ClothGarment garment, std::shared_ptr<const Trajectory> body = nullptr) {
  ClothSetup setup;
  setup.primary = std::move(body);
  setup.preroll_frames = 0;
  setup.air_density = 0;
  garment.name = "cloth";
  setup.garments.push_back(std::move(garment));
  return setup;
}

State after(const ClothSetup& setup, int frames) {
  auto solver = make_cloth_solver(setup);
  EXPECT_TRUE(solver) << (solver ? "" : solver.error().text());
  State state = (*solver)->initial_state();
  for (int f = 0; f < frames; ++f) (*solver)->advance_frame(state);
  return state;
}

std::vector<Vec3> positions_of(const State& state) {
  const auto x = as_points(*state.find("x"));
  return {x.begin(), x.end()};
}

TEST(ClothMaps, A_map_of_one_value_is_the_scalar_key_bit_for_bit) {
  ClothGarment plain;
  plain.mesh = make_sheet(0.5, 16, 0.206);
  ClothGarment mapped = plain, without = plain;
  plain.thickness = 4.1e-3;
  plain.fabric.mass_per_area = 0.23;
  // Powers of two: the products are the same bits then.
  plain.fabric.stretch_warp *= 2, plain.fabric.stretch_weft *= 2, plain.fabric.shear *= 2;
  plain.fabric.bend_warp *= 4, plain.fabric.bend_weft *= 4;
  const std::size_t n = plain.mesh.positions.size();
  mapped.maps.thickness.assign(n, 4.1e-3);
  mapped.maps.mass_per_area.assign(n, 0.23);
  mapped.maps.stretch.assign(n, 2);
  mapped.maps.bend.assign(n, 4);
  const Hash128 expected = hash(after(one_garment(plain, still_ball()), 8));
  EXPECT_EQ(hash(after(one_garment(mapped, still_ball()), 8)), expected);
  EXPECT_NE(hash(after(one_garment(without, still_ball()), 8)), expected);
}

/// Elongation of a strip under its own weight from row to row: E (s^2 - 1) s / 2 = tension per width, where s is the
/// stretch.
double stretch_under(double tension_per_width, double stiffness) {
  double s = 1;
  for (int i = 0; i < 50; ++i)
    s -= (0.5 * stiffness * (s * s - 1) * s - tension_per_width) / (0.5 * stiffness * (3 * s * s - 1));
  return s;
}

TEST(ClothMaps, A_strip_of_two_stiffnesses_and_weights_hangs_by_the_closed_form_of_each_half) {
  const int columns = 4, rows = 40;
  const double width = 0.04, length = 0.4;
  std::vector<Vec3> x;
  std::vector<Triangle> triangles;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) x.emplace_back(width * i / columns, -length * j / rows, 0);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int a = j * (columns + 1) + i, b = a + 1, c = a + columns + 1, d = c + 1;
      if ((i + j) % 2 == 0)
        triangles.insert(triangles.end(), {{a, c, d}, {a, d, b}});
      else
        triangles.insert(triangles.end(), {{a, c, b}, {b, c, d}});
    }
  ClothGarment strip;
  strip.mesh = make_triangle_mesh("strip", x, triangles);
  strip.self_collision = false;
  Fabric& f = strip.fabric;
  f.stretch_warp = f.stretch_weft = 10, f.shear = 5, f.poisson = 0, f.damping = 0.05;
  const double density[2] = {0.1, 0.3}, factor[2] = {1, 4};
  const auto half_of = [&](int row) { return row <= rows / 2 ? 0 : 1; };
  ClothPin pin;
  pin.stiffness = 1e9, pin.max_pull = 1e9;
  for (int i = 0; i <= columns; ++i) pin.vertices.push_back(i);
  strip.pins.push_back(pin);
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      strip.maps.stretch.push_back(factor[half_of(j)]);
      strip.maps.mass_per_area.push_back(density[half_of(j)]);
    }
  ClothSetup setup = one_garment(strip);
  setup.bdf2 = false;
  setup.linear_tolerance = 1e-4;
  const auto hung = positions_of(after(setup, 72));
  const auto mean_y = [&](int row) {
    double sum = 0;
    for (int i = 0; i <= columns; ++i) sum += hung[at(row * (columns + 1) + i)].y();
    return sum / (columns + 1);
  };
  // Below the middle of row j hangs the lumped mass of the rows after it: whole rows, and half a one at the end.
  const double cell = length / rows;
  const auto closed_form = [&](int from, int to) {
    double sum = 0;
    for (int j = from; j < to; ++j) {
      double mass = 0;  // per width
      for (int k = j + 1; k <= rows; ++k) mass += density[half_of(k)] * cell * (k == rows ? 0.5 : 1);
      sum += cell * stretch_under(mass * k_gravity, f.stretch_warp * factor[half_of(j + 1)]);
    }
    return sum;
  };
  // Away from the pins, which hold the width, and from the row in which the halves meet.
  for (const auto& [from, to] : {std::pair{5, 16}, {25, 38}}) {
    const double measured = mean_y(from) - mean_y(to), expected = closed_form(from, to), rest = cell * (to - from);
    EXPECT_NEAR(measured - rest, expected - rest, 5e-3 * (expected - rest)) << from;
  }
  EXPECT_GT((mean_y(5) - mean_y(16)) / (11 * cell), 1 + 3 * ((mean_y(25) - mean_y(38)) / (13 * cell) - 1))
      << "the halves differ";
}

TEST(ClothMaps, Cloth_rests_at_its_own_thickness_everywhere) {
  ClothGarment sheet;
  sheet.mesh = make_sheet(0.4, 20, 6.2e-3);
  for (const Vec3& p : sheet.mesh.positions) sheet.maps.thickness.push_back(p.x() < 0 ? 2e-3 : 6e-3);
  const auto x = positions_of(after(one_garment(sheet, floor_body()), 30));
  double highest_thin = 0, lowest_thick = 1;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double place = sheet.mesh.positions[i].x();
    if (std::abs(place) > 0.1) {
      EXPECT_NEAR(x[i].y(), place < 0 ? 2e-3 : 6e-3, 3e-5) << place;
    }
    if (place < -0.1) highest_thin = std::max(highest_thin, x[i].y());
    if (place > 0.1) lowest_thick = std::min(lowest_thick, x[i].y());
  }
  EXPECT_LT(highest_thin + 3.5e-3, lowest_thick);
}

TEST(ClothMaps, The_radius_of_a_contact_runs_linearly_over_a_triangle_and_is_exact_where_it_is_constant) {
  ContactModel model;
  model.cloth_vertex_count = 3;
  const std::vector<Vec3> rest = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, -1)};
  model.rest = rest;
  model.area.assign(3, 1.0);
  model.radius = {2e-3, 4e-3, 8e-3};
  model.friction = model.self_friction = {0.0};
  model.garment.assign(3, 0);
  ContactPairs pairs;
  pairs.vertex_face.push_back({{3, 0, 1, 2}});  // a point of the body over a triangle of cloth
  const test::NumberedPairs numbered(pairs);
  const auto radius_at = [&](double u, double v) {
    std::vector<Vec3> x = rest;
    x.push_back(Vec3(u, 1e-3, -v));
    ContactPotential contact(model);
    contact.begin(numbered.list, x, 0.01);
    contact.update(x);
    EXPECT_EQ(contact.contacts().size(), 1u);
    return contact.contacts().empty() ? 0 : contact.contacts()[0].radius;
  };
  EXPECT_NEAR(radius_at(0.25, 0.5), 0.25 * 2e-3 + 0.25 * 4e-3 + 0.5 * 8e-3, 1e-15);
  EXPECT_NEAR(radius_at(0.9, 0.05), 0.05 * 2e-3 + 0.9 * 4e-3 + 0.05 * 8e-3, 1e-15);
  model.radius.assign(3, 3.3e-3);
  EXPECT_EQ(radius_at(0.3, 0.37), 3.3e-3);
}

TEST(ClothMaps, A_pin_of_weight_0_holds_nothing_and_half_the_weight_sags_twice_as_far) {
  ClothGarment free;
  free.mesh = make_sheet(0.2, 6, 1);
  free.self_collision = false;
  ClothGarment unheld = free;
  ClothPin pin;
  pin.stiffness = 1e4;
  for (int i = 0; i < free.mesh.vertex_count(); ++i) pin.vertices.push_back(i), pin.weights.push_back(0);
  unheld.pins.push_back(pin);
  EXPECT_EQ(hash(after(one_garment(unheld), 6)), hash(after(one_garment(free), 6)));
  const auto sag = [&](double weight) {
    ClothGarment held = unheld;
    held.pins[0].weights.assign(pin.vertices.size(), weight);
    ClothSetup setup = one_garment(held);
    setup.bdf2 = false;
    return 1 - positions_of(after(setup, 48))[24].y();
  };
  const double expected = free.fabric.mass_per_area * k_gravity / pin.stiffness;  // per area
  EXPECT_NEAR(sag(1), expected, 1e-3 * expected);
  EXPECT_NEAR(sag(0.5), 2 * expected, 2e-3 * expected);
}

TEST(ClothMaps, A_map_that_cannot_be_is_refused_by_name) {
  ClothGarment sheet;
  sheet.mesh = make_sheet(0.2, 2, 0);
  for (const double bad :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    ClothGarment spoilt = sheet;
    spoilt.maps.stretch.assign(9, 1);
    spoilt.maps.stretch[4] = bad;
    const auto refused = make_cloth_solver(one_garment(spoilt));
    ASSERT_FALSE(refused) << bad;
    EXPECT_NE(refused.error().text().find("map of stretch"), std::string::npos) << refused.error().text();
    EXPECT_NE(refused.error().text().find("vertex 4"), std::string::npos) << refused.error().text();
  }
  ClothGarment short_one = sheet;
  short_one.maps.bend.assign(8, 1);
  const auto refused = make_cloth_solver(one_garment(short_one));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("map of bend has 8 values for 9 vertices"), std::string::npos)
      << refused.error().text();
  ClothGarment folds_freely = sheet;
  folds_freely.maps.bend.assign(9, 0);
  EXPECT_TRUE(make_cloth_solver(one_garment(folds_freely)));
}

}  // namespace
}  // namespace ft
