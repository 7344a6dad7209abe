// See fcl_validator.h. FCL computes in millimetres here: its triangle test has absolute tolerances that are too coarse
// for metres at centimetre edges.
#include "collision/check/fcl_validator.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>

#include <limits>
#include <memory>
#include <vector>

namespace ft::inline collision {
namespace {

using Model = fcl::BVHModel<fcl::OBBRSS<double>>;

std::shared_ptr<Model> model_of(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                const Vec3& origin) {
  std::vector<fcl::Vector3<double>> vertices;
  for (const Vec3& p : positions) vertices.push_back(1000.0 * (p - origin));
  std::vector<fcl::Triangle> faces;
  for (const Triangle& t : triangles)
    faces.emplace_back(static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]), static_cast<std::size_t>(t[2]));
  auto model = std::make_shared<Model>();
  model->beginModel(static_cast<int>(faces.size()), static_cast<int>(vertices.size()));
  model->addSubModel(vertices, faces);
  model->endModel();
  return model;
}

}  // namespace

std::size_t fcl_intersecting_pairs(std::span<const Vec3> positions_a, std::span<const Triangle> triangles_a,
                                   std::span<const Vec3> positions_b, std::span<const Triangle> triangles_b) {
  if (triangles_a.empty() || triangles_b.empty()) return 0;
  const Vec3 origin = positions_a[static_cast<std::size_t>(triangles_a[0][0])];
  const auto a = model_of(positions_a, triangles_a, origin), b = model_of(positions_b, triangles_b, origin);
  fcl::CollisionRequest<double> request(std::numeric_limits<std::size_t>::max() / 2, false);
  fcl::CollisionResult<double> result;
  fcl::collide<double>(a.get(), fcl::Transform3<double>::Identity(), b.get(), fcl::Transform3<double>::Identity(),
                       request, result);
  return result.numContacts();
}

}  // namespace ft::inline collision
