// Torture scenes in which cloth is pulled: twisted, through a ring, through a funnel, into a knot, over an edge.
#include <numbers>

#include "tests/support/torture/scene_functions.h"
#include "tests/support/torture/shapes.h"

namespace ft::torture {
namespace {

constexpr double k_pi = std::numbers::pi;

/// Holds against any pull that these scenes make, and is still no stiffer than the cloth.
ClothPin firm_pin() {
  ClothPin pin;
  pin.stiffness = 1e7;
  pin.max_pull = 3e5;
  return pin;
}

ClothSetup setup_of(ClothGarment garment, std::shared_ptr<const Trajectory> body) {
  ClothSetup setup;
  setup.primary = std::move(body);
  setup.preroll_frames = 0;
  setup.garments.push_back(std::move(garment));
  return setup;
}

/// A sheet with a ball under its middle that takes it straight down, by `way` in `seconds`, through the opening of
/// `part`.
ClothSetup pulled_down_through(const std::string& part, const Shape& opening, double height, double side, double way,
                               double seconds) {
  constexpr double k_ball = 12e-3;
  Shape ball;
  make_sphere(k_ball, 8, 12, ball.points, ball.triangles);
  RigidParts body;
  body.add(part, opening, [](double) { return Pose::Identity(); });
  body.add("ball", moved(ball, {0, height - k_ball - 3.5e-3, 0}), [=](double t) {
    return shift({0, -way * ease(t, 0.1, 0.1 + seconds), 0});
  });
  ClothGarment sheet;
  sheet.name = "sheet";
  constexpr int k_cells = 32;
  sheet.mesh = grid("sheet", k_cells, k_cells, false,
                    [&](double s, double t) { return Vec3(side * (s - 0.5), height, side * (t - 0.5)); });
  ClothPin pin = firm_pin();
  for (int v = 0; v < sheet.mesh.vertex_count(); ++v)
    if ((sheet.mesh.positions[at(v)] - Vec3(0, height, 0)).norm() < k_ball) pin.vertices.push_back(v);
  sheet.pins.push_back(pin);
  return setup_of(std::move(sheet), body.build());
}

}  // namespace

ClothSetup twist() {
  constexpr double k_length = 0.8, k_width = 0.2, k_turns = 10, k_seconds = 2, k_shortening = 0.16;
  const auto clamp_motion = [](double side) {
    return [side](double t) {
      const double share = ease(t, 0, k_seconds);
      return shift({-side * 0.5 * k_shortening * share, 0, 0}) *
             turn(Vec3::Zero(), Vec3::UnitX(), side * k_pi * k_turns * share);
    };
  };
  RigidParts body;
  const Shape clamp = box({20e-3, 6e-3, k_width});
  body.add("left", moved(clamp, {-0.5 * k_length - 14e-3, 0, 0}), clamp_motion(-1));
  body.add("right", moved(clamp, {0.5 * k_length + 14e-3, 0, 0}), clamp_motion(1));
  ClothGarment sheet;
  sheet.name = "sheet";
  constexpr int k_columns = 66, k_rows = 16;
  sheet.mesh = grid("sheet", k_columns, k_rows, false,
                    [&](double s, double t) { return Vec3(k_length * (s - 0.5), 0, k_width * (0.5 - t)); });
  ClothPin pin = firm_pin();
  for (int j = 0; j <= k_rows; ++j)
    for (const int i : {0, 1, k_columns - 1, k_columns}) pin.vertices.push_back(i + (k_columns + 1) * j);
  sheet.pins.push_back(pin);
  return setup_of(std::move(sheet), body.build());
}

ClothSetup ring() {
  std::vector<Vec2> profile;
  for (int i = 0; i < 12; ++i)
    profile.push_back({0.06 + 0.01 * std::cos(k_pi * i / 6), -0.01 * std::sin(k_pi * i / 6)});
  return pulled_down_through("ring", lathe(profile, true, 48), 0.02, 0.36, 0.45, 1.5);
}

ClothSetup funnel() {
  constexpr double k_wall = 8e-3;
  std::vector<Vec2> profile = {{0.3 + k_wall, 0.2}, {0.05 + k_wall, 0}, {0.05 + k_wall, -0.12},
                               {0.05, -0.12},       {0.05, 0},          {0.3, 0.2}};
  return pulled_down_through("funnel", lathe(profile, true, 64), 0.21, 0.36, 0.6, 1.5);
}

/// The trefoil of Shastri (1992), (t^3 - 3t, t^4 - 4t^2, t^5 - 10t), squeezed along z; the ribbon's width lies along
/// the binormal, so that its middle line is as straight in the ribbon as it can be.
ClothSetup knot() {
  constexpr double k_scale = 0.036, k_squeeze = 0.3, k_end = 2.15, k_width = 12e-3, k_pull = 0.24;
  constexpr int k_columns = 300, k_rows = 4, k_fine = 4000;
  const auto curve = [&](double t) {
    return Vec3(k_scale * Vec3(t * t * t - 3 * t, t * t * t * t - 4 * t * t, k_squeeze * (std::pow(t, 5) - 10 * t)));
  };
  const auto binormal = [&](double t) {
    const Vec3 d1(3 * t * t - 3, 4 * t * t * t - 8 * t, k_squeeze * (5 * t * t * t * t - 10)),
        d2(6 * t, 12 * t * t - 8, k_squeeze * 20 * t * t * t);
    return d1.cross(d2).normalized().eval();
  };
  std::vector<double> length = {0};  // to parameter -k_end + 2 k_end i / k_fine
  const auto parameter = [&](double i) { return k_end * (2 * i / k_fine - 1); };
  for (int i = 0; i < k_fine; ++i)
    length.push_back(length.back() + (curve(parameter(i + 1)) - curve(parameter(i))).norm());
  const auto parameter_at = [&](double share) {
    const auto next = std::upper_bound(length.begin() + 1, length.end() - 1, share * length.back());
    const double i = static_cast<double>(next - length.begin());
    return parameter(i - (*next - share * length.back()) / (*next - *(next - 1)));
  };
  ClothGarment ribbon;
  ribbon.name = "ribbon";
  ribbon.thickness = 1.5e-3;
  ribbon.mesh = grid("ribbon", k_columns, k_rows, false, [&](double s, double t) {
    const double p = parameter_at(s);
    return Vec3(curve(p) + k_width * (t - 0.5) * binormal(p));
  });
  ClothPin pin = firm_pin();
  for (int j = 0; j <= k_rows; ++j)
    for (const int i : {0, 1, k_columns - 1, k_columns}) pin.vertices.push_back(i + (k_columns + 1) * j);
  ribbon.pins.push_back(pin);
  const Vec3 from = curve(-k_end), to = curve(k_end), apart = (to - from).normalized();
  Shape ball;
  make_sphere(8e-3, 8, 12, ball.points, ball.triangles);
  RigidParts body;
  const auto beyond = [&](double t, double sign) {
    return Vec3(curve(t) + 11e-3 * (curve(t) - curve(t - sign * 1e-4)).normalized());
  };
  body.add("first", moved(ball, beyond(-k_end, -1)),
           [apart](double t) { return shift(-k_pull * ease(t, 0, 2) * apart); });
  body.add("last", moved(ball, beyond(k_end, 1)), [apart](double t) { return shift(k_pull * ease(t, 0, 2) * apart); });
  return setup_of(std::move(ribbon), body.build());
}

/// A strip of ripstop, held at both ends, over the edge of a board that rises under it, rocks and shifts along it: some
/// hundred kPa of contact where the strip turns.
ClothSetup taut() {
  constexpr double k_length = 0.4, k_width = 0.1, k_rise = 0.14;
  constexpr int k_columns = 66, k_rows = 16;
  const Vec3 board(4e-3, 0.2, 0.16);
  RigidParts body;
  body.add("board", moved(box(board), {0, -0.5 * board.y() - 4e-3, 0}), [=](double t) {
    const double rise = k_rise * ease(t, 0, 0.8), rock = std::sin(2 * k_pi * std::max(0.0, t - 0.4));
    return shift({0.02 * rock, rise, 0}) * turn({0, -board.y(), 0}, Vec3::UnitZ(), 0.1 * rock);
  });
  for (const double side : {-1.0, 1.0})
    body.add(side < 0 ? "left" : "right", moved(box({20e-3, 6e-3, k_width}), {side * (0.5 * k_length + 14e-3), 0, 0}),
             [](double) { return Pose::Identity(); });
  ClothGarment strip;
  strip.name = "strip";
  strip.fabric = *find_fabric("ripstop");
  strip.thickness = 2e-3;
  strip.mesh = grid("strip", k_columns, k_rows, false,
                    [&](double s, double t) { return Vec3(k_length * (s - 0.5), 0, k_width * (0.5 - t)); });
  ClothPin pin = firm_pin();
  for (int j = 0; j <= k_rows; ++j)
    for (const int i : {0, k_columns}) pin.vertices.push_back(i + (k_columns + 1) * j);
  pin.max_pull = 3e7;
  strip.pins.push_back(pin);
  return setup_of(std::move(strip), body.build());
}

}  // namespace ft::torture
