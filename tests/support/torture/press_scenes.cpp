// Torture scenes in which things close on cloth: plates, the crease of an elbow, crossing legs.
#include <numbers>

#include "tests/support/torture/scene_functions.h"
#include "tests/support/torture/shapes.h"

namespace ft::torture {
namespace {

constexpr double k_pi = std::numbers::pi;

/// A tube of cloth between two plates that close to `nearest` (negative: they pass into each other) and open again.
ClothSetup pressed_tube(double nearest, bool carve) {
  constexpr double k_radius = 0.05, k_open = 0.12, k_plate = 0.02;
  const auto plate_motion = [=](double side) {
    return [=](double t) {
      const double shut = ease(t, 0.1, 1.0) - ease(t, 1.4, 2.0), gap = k_open + (nearest - k_open) * shut;
      return shift({0, side * 0.5 * (gap + k_plate), 0});
    };
  };
  RigidParts body;
  body.add("lower", box({0.26, k_plate, 0.26}), plate_motion(-1));
  body.add("upper", box({0.26, k_plate, 0.26}), plate_motion(1));
  ClothGarment tube;
  tube.name = "tube";
  tube.mesh = grid("tube", 40, 25, true, [&](double s, double t) {
    return Vec3(k_radius * std::cos(2 * k_pi * s), k_radius * std::sin(2 * k_pi * s), 0.2 * (t - 0.5));
  });
  ClothSetup setup;
  setup.primary = body.build();
  setup.preroll_frames = 0;
  setup.garments.push_back(std::move(tube));
  setup.feasible.carve = carve;
  return setup;
}

/// An arm along x, one skin with two parts, whose elbow at the origin bends to `degrees` and back. Around the elbow the
/// middle line is an arc of 10 cm, so the inner side of the skin folds into itself.
std::shared_ptr<ScriptedBody> bending_arm(double degrees) {
  constexpr double k_radius = 0.045, k_half_arc = 0.05;
  const Shape arm = capsule(0.34, -0.34, k_radius, 64, 32);
  std::vector<Vec3> bind;
  Surface surface;
  surface.triangles = arm.triangles;
  surface.parts = {{"upper arm", -1, 1.0}, {"forearm", 0, 0.8}};
  for (const Vec3& p : arm.points) {
    bind.push_back({p.y(), -p.x(), p.z()});
    surface.part_of_vertex.push_back(p.y() < 0 ? 0 : 1);
  }
  const auto motion = [bind, degrees](double time, std::span<Vec3> out) {
    const double angle = degrees * k_pi / 180 * (ease(time, 0.1, 1.0) - ease(time, 1.4, 2.3));
    const double curvature = angle / (2 * k_half_arc);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double along = bind[i].x(), into = std::clamp(along + k_half_arc, 0.0, 2 * k_half_arc);
      const double turned = curvature * into, beyond = std::max(0.0, along - k_half_arc);
      Vec3 middle(std::min(along, -k_half_arc), 0, 0);
      if (curvature > 1e-9)
        middle += Vec3(std::sin(turned), 1 - std::cos(turned), 0) / curvature;
      else
        middle += Vec3(into, 0, 0);
      const Vec3 forward(std::cos(turned), std::sin(turned), 0), up(-std::sin(turned), std::cos(turned), 0);
      out[i] = middle + beyond * forward + bind[i].y() * up + Vec3(0, 0, bind[i].z());
    }
  };
  return std::make_shared<ScriptedBody>(std::move(surface), bind, 0, motion);
}

}  // namespace

ClothSetup plates() {
  return pressed_tube(1e-3, true);
}
ClothSetup plates_no_room() {
  return pressed_tube(-2e-3, false);
}

ClothSetup elbow() {
  constexpr int k_around = 40, k_along = 44;
  ClothGarment sleeve;
  sleeve.name = "sleeve";
  sleeve.mesh = grid("sleeve", k_around, k_along, true, [](double s, double t) {
    return Vec3(-0.24 + 0.44 * t, 0.056 * std::cos(2 * k_pi * s), 0.056 * std::sin(2 * k_pi * s));
  });
  ClothPin shoulder;
  for (int i = 0; i < k_around; ++i) shoulder.vertices.push_back(i);
  sleeve.pins.push_back(shoulder);
  ClothSetup setup;
  setup.primary = bending_arm(150);
  setup.preroll_frames = 0;
  setup.garments.push_back(std::move(sleeve));
  return setup;
}

ClothSetup legs() {
  constexpr double k_half_step = 0.055, k_hip = 0.11;
  const auto swing = [=](double side) {
    return [=](double t) {
      const double across = ease(t, 0.1, 0.9) - ease(t, 1.2, 2.0);
      return turn({side * k_hip, 0, 0}, Vec3::UnitZ(), -side * 24 * k_pi / 180 * across);
    };
  };
  RigidParts body;
  const Shape leg = capsule(0, -0.8, 0.07, 32, 24);
  body.add("left leg", moved(leg, {k_hip, 0, k_half_step}), swing(1));
  body.add("right leg", moved(leg, {-k_hip, 0, -k_half_step}), swing(-1));
  body.add("hip", moved(box({0.02, 0.02, 0.36}), {0, 0.1, 0}), [](double) { return Pose::Identity(); });
  constexpr int k_columns = 28, k_rows = 52;
  ClothGarment panel;
  panel.name = "panel";
  panel.mesh = grid("panel", k_columns, k_rows, false,
                    [](double s, double t) { return Vec3(0, 0.085 - 0.65 * t, 0.35 * (s - 0.5)); });
  ClothPin top;
  for (int i = 0; i <= k_columns; ++i) top.vertices.push_back(i);
  panel.pins.push_back(top);
  ClothSetup setup;
  setup.primary = body.build();
  setup.preroll_frames = 0;
  setup.garments.push_back(std::move(panel));
  return setup;
}

}  // namespace ft::torture
