#include "baker/core/placed_instances.h"

namespace ft {

PlacedInstances instances_as_mesh(std::span<const Mesh> prototypes, std::span<const int> which) {
  std::vector<std::vector<Triangle>> triangles;
  for (const Mesh& prototype : prototypes) triangles.push_back(triangulate(prototype));
  PlacedInstances out;
  for (std::size_t i = 0; i < which.size(); ++i) {
    const int first = static_cast<int>(out.instance_of_vertex.size());
    for (const Triangle& t : triangles[at(which[i])])
      out.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    out.instance_of_vertex.insert(out.instance_of_vertex.end(), prototypes[at(which[i])].positions.size(),
                                  static_cast<int>(i));
  }
  return out;
}

std::vector<Vec3> placed(std::span<const Mesh> prototypes, std::span<const int> which, const FrameData& frame) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < which.size(); ++i) {
    const Mat3 turn = frame.orientations[i].cast<double>().normalized().toRotationMatrix();
    const Vec3 scale = frame.scales.empty() ? Vec3::Ones() : Vec3(frame.scales[i].cast<double>());
    for (const Vec3& p : prototypes[at(which[i])].positions)
      out.emplace_back(frame.positions[i].cast<double>() + turn * p.cwiseProduct(scale));
  }
  return out;
}

}  // namespace ft
