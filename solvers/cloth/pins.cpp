// Pins: where they are on the body, and where the body takes them.
#include "collision/nearest_point.h"
#include "solvers/cloth/cloth_model.h"

namespace ft {

Mat3 triangle_frame(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 e = b - a, n = e.cross(c - a);
  if (e.norm() < 1e-12 || n.norm() < 1e-18) return Mat3::Identity();
  Mat3 frame;
  frame.col(0) = e.normalized();
  frame.col(2) = n.normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

PinPoint bind_pin(int vertex, const Vec3& place, std::span<const Vec3> body, std::span<const Triangle> triangles) {
  PinPoint pin;
  pin.vertex = vertex;
  pin.offset = place;
  const SurfacePoint nearest = nearest_point(place, body, triangles);
  pin.triangle = nearest.triangle;
  pin.weight = nearest.weight;
  if (pin.triangle[0] >= 0) {
    const Vec3 &a = body[at(pin.triangle[0])], &b = body[at(pin.triangle[1])], &c = body[at(pin.triangle[2])];
    const Vec3 foot = pin.weight[0] * a + pin.weight[1] * b + pin.weight[2] * c;
    pin.offset = triangle_frame(a, b, c).transpose() * (place - foot);
  }
  return pin;
}

void pin_targets(const ClothModel& model, std::span<const Vec3> drawn, std::span<Vec3> targets) {
  for (std::size_t p = 0; p < model.pins.size(); ++p) {
    const PinPoint& pin = model.pins[p];
    if (pin.triangle[0] < 0) {
      targets[p] = pin.offset;
      continue;
    }
    const Vec3 &a = drawn[at(pin.triangle[0])], &b = drawn[at(pin.triangle[1])], &c = drawn[at(pin.triangle[2])];
    targets[p] = pin.weight[0] * a + pin.weight[1] * b + pin.weight[2] * c + triangle_frame(a, b, c) * pin.offset;
  }
}

}  // namespace ft
