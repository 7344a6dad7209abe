#include "solvers/cloth/model/pins.h"

#include <algorithm>

#include "collision/geometry/nearest_point.h"
#include "solvers/cloth/model/attach.h"

namespace ft::inline solvers {

void pin(ClothModel& model) {
  const ClothSetup& setup = model.setup;
  std::vector<Vec3> bind;
  std::vector<Triangle> body;
  if (setup.primary) {
    bind = bind_pose_of(*setup.primary);
    body = setup.primary->surface().triangles;
  }
  const auto worn_by = [&](const ClothGarment& garment) {  // what pins hold to
    std::vector<Triangle> out = body;
    if (garment.wearer && setup.primary)
      std::erase_if(out, [&](const Triangle& t) {
        return !garment.wearer->has(setup.primary->surface().part_of_vertex[at(t[0])]);
      });
    return out;
  };
  for (std::size_t g = 0; g < setup.garments.size(); ++g) {
    const std::vector<Triangle> holder = worn_by(setup.garments[g]);
    for (const ClothPin& pin : setup.garments[g].pins) {
      if (pin.to >= 0) continue;
      const std::vector<HoldSpan> holds = hold_spans(pin, setup.garments[g].mesh.positions);
      for (std::size_t k = 0; k < pin.vertices.size(); ++k) {
        const int v = model.first_vertex[g] + pin.vertices[k];
        const double weight = pin.weights.empty() ? 1.0 : pin.weights[k];
        if (weight <= 0 || model.unused[at(v)]) continue;
        const Vec3& x = model.contact.rest[at(v)];
        PinPoint point = pin.to_world ? bind_pin(v, x, {}, {}) : bind_pin(v, x, bind, holder);
        const double area = model.contact.area[at(v)];
        point.stiffness = weight * pin.stiffness * area;
        point.max_pull = weight * pin.max_pull * area;
        point.hold = holds[k];
        point.to_world = pin.to_world;
        model.pins.push_back(point);
      }
    }
  }
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

bool hold_jumps(const ClothModel& model, double time_t0, double time_t1) {
  const auto jumps = [&](const auto& point) { return point.hold.jumps(time_t0, time_t1); };
  const auto& attachments = model.attachments;
  return std::any_of(model.pins.begin(), model.pins.end(), jumps) ||
         std::any_of(attachments.begin(), attachments.end(), jumps);
}

}  // namespace ft::inline solvers
