#include "solvers/cloth/certify/frame_incidents.h"

#include <algorithm>
#include <string>

namespace ft::inline solvers {
namespace {

Incident at_vertex(const ClothModel& model, const ClothMotion& motion, int vertex, int frame) {
  const int garment = model.garment_of(vertex);
  Incident out;
  out.frame = frame;
  out.system = model.setup.garments[at(garment)].name;
  out.vertex = vertex - model.first_vertex[at(garment)];
  out.place = motion.x[at(vertex)];
  return out;
}

}  // namespace

Incident torn_incident(const ClothModel& model, const ClothMotion& motion, const TornFrame& frame) {
  const auto first = std::find(frame.torn.begin(), frame.torn.end(), char{1}) - frame.torn.begin();
  const auto count = std::count(frame.torn.begin(), frame.torn.end(), char{1});
  const Vec3& place = frame.body[at(first)];
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < motion.x.size(); ++i)
    if ((motion.x[i] - place).squaredNorm() < (motion.x[nearest] - place).squaredNorm()) nearest = i;
  const auto& parts = model.collider->trajectory().surface().parts;
  Incident out = at_vertex(model, motion, static_cast<int>(nearest), frame.frame);
  out.kind = Incident::Kind::k_released;
  out.text = "the body is torn: the cloth does not meet " + std::to_string(count) +
             " vertices of the collider that leap or span a gap in this frame, at " +
             parts[at(model.collider->part_of_vertex()[at(first)])].name +
             (frame.wrecked ? "; so much that the cloth is only taken along" : "") + " (look at the animation)";
  return out;
}

Incident haste_incident(const ClothModel& model, const ClothMotion& motion, bool hurried, int frame) {
  const RestEdges& rest = model.rest_edges;
  double most = 0;
  int vertex = 0;
  for (std::size_t e = 0; e < rest.edges.size(); ++e) {
    const auto [a, b] = rest.edges[e];
    const double stretch = (motion.x[at(a)] - motion.x[at(b)]).norm() / rest.lengths[e];
    if (stretch > most) most = stretch, vertex = a;
  }
  Incident out = at_vertex(model, motion, vertex, frame);
  out.kind = Incident::Kind::k_cut_short;
  out.text = hurried
                 ? "cut short: the frame took many times as long as frames usually do; what blocks the cloth is let "
                   "go at once (look at the animation there)"
                 : "cut short: cloth was slowed down that is faster than " + std::to_string(model.setup.max_substeps) +
                       " substeps can follow (more of them under [solver] max_substeps)";
  return out;
}

}  // namespace ft::inline solvers
