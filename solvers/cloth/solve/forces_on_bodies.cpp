#include "solvers/cloth/solve/forces_on_bodies.h"

#include <algorithm>

#include "baker/core/volume.h"
#include "solvers/cloth/model/cloth_model.h"

namespace ft::inline solvers {
namespace {

/// Of one body of the primary, or of all of it [m].
Vec3 centre_of(const ClothModel& model, std::size_t body, std::span<const Vec3> collider) {
  if (!model.collider) return Vec3::Zero();
  const auto triangles = model.collider->triangles();
  if (model.setup.bodies.empty()) return volume_centre(collider, triangles);
  std::vector<Triangle> own;
  for (const Triangle& t : triangles)
    if (at(model.body_of_vertex[at(t[0])]) == body) own.push_back(t);
  return volume_centre(collider, own);
}

bool meets(const ClothGarment& garment, const PartRange& body) {
  return std::count_if(garment.ignores.begin(), garment.ignores.end(), [&](int part) { return body.has(part); }) <
         body.part_count;
}

}  // namespace

std::vector<Wrench> share_out(std::span<const Wrench> total, std::span<const Wrench> known,
                              std::span<const int> wearer) {
  const std::size_t bodies = known.size() / std::max<std::size_t>(total.size(), 1);
  std::vector<Wrench> out(known.begin(), known.end());
  for (std::size_t g = 0; g < total.size(); ++g) {
    const auto own = known.subspan(g * bodies, bodies);
    Wrench left = total[g];
    double size = 0;
    for (const Wrench& w : own) left += -1.0 * w, size += w.force.norm();
    for (std::size_t b = 0; b < bodies; ++b) {
      const double share = size > 0 ? own[b].force.norm() / size : at(wearer[g]) == b ? 1 : 0;
      if (share > 0) out[g * bodies + b] += share * left;
    }
  }
  return out;
}

std::vector<int> wearer_bodies(const ClothModel& model) {
  std::vector<int> out;
  for (const ClothGarment& garment : model.setup.garments) {
    const auto& bodies = model.setup.bodies;
    const auto own = std::find_if(bodies.begin(), bodies.end(), [&](const PartRange& body) {
      return garment.wearer && body.has(garment.wearer->first_part);
    });
    out.push_back(own == bodies.end() ? 0 : static_cast<int>(own - bodies.begin()));
  }
  return out;
}

void add_forces(const ClothModel& model, std::span<const OnBody> step, double duration, FrameReport& report) {
  const std::size_t bodies = model.body_count();
  report.forces.resize(step.size());
  for (std::size_t row = 0; row < step.size(); ++row) {
    InteractionForce& sum = report.forces[row];
    sum.system = model.setup.garments[row / bodies].name;
    if (!model.setup.bodies.empty()) sum.primary = model.setup.bodies[row % bodies].name;
    sum.mean += (1 / duration) * step[row].impulse;
    sum.peak = std::max(sum.peak, step[row].peak);
    sum.contact_share = std::min(1.0, sum.contact_share + step[row].contact_time / duration);
  }
}

void finish_forces(const ClothModel& model, std::span<const Vec3> collider, FrameReport& report) {
  const std::size_t bodies = model.body_count();
  std::vector<Vec3> centre;
  for (std::size_t b = 0; b < bodies; ++b) centre.push_back(centre_of(model, b, collider));
  std::vector<InteractionForce> met;
  for (std::size_t row = 0; row < report.forces.size(); ++row) {
    if (!model.setup.bodies.empty() && !meets(model.setup.garments[row / bodies], model.setup.bodies[row % bodies]))
      continue;
    met.push_back(std::move(report.forces[row]));
    met.back().mean = met.back().mean.moved(centre[row % bodies]);
  }
  report.forces = std::move(met);
}

}  // namespace ft::inline solvers
