#include "baker/systems/leaves/scatter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "baker/core/file.h"
#include "baker/core/random.h"
#include "io/shot/mesh_file.h"
#include "solvers/leaves/leaf_shape.h"

namespace ft::inline baker {
namespace {

using std::numbers::pi;

constexpr double k_above = 0.6e-3, k_layers = 0.6e-3;  ///< what they lie on is so far and up to so much more below [m]
constexpr double k_steepest = 0.5;                     ///< of faces on which leaves lie: the normal's vertical share
constexpr std::uint64_t k_most_bytes = 256 << 20;

/// Numbers for a leaf: its own, whatever comes before it.
class Lot {
 public:
  Lot(const LeavesSpec& spec, std::size_t leaf) : key_{static_cast<std::uint64_t>(spec.seed), 3, 0, leaf} {}
  double operator()() { return random_uniform(key_, draw_++); }

 private:
  RandomKey key_;
  std::uint64_t draw_ = 0;
};

/// Lying on a plane, turned by a heading about its normal; half of them upside down.
Quat lying(const Vec3& normal, double heading, bool upside_down) {
  Quat out = Quat::FromTwoVectors(Vec3::UnitY(), normal) * Quat(Eigen::AngleAxisd(heading, Vec3::UnitY()));
  if (upside_down) out = out * Quat(Eigen::AngleAxisd(pi, Vec3::UnitX()));
  return out.normalized();
}

/// So that its lowest vertex is above a plane.
void put_down(Leaf& leaf, const LeafShape& shape, const Vec3& place, const Vec3& normal, double above) {
  double lowest = 0;
  for (const Vec3& p : shape.positions) lowest = std::min(lowest, normal.dot(leaf.orientation * (leaf.scale * p)));
  leaf.position = place + (above - lowest) * normal;
}

Leaf lying_leaf(const LeavesSpec& spec, const LeafShape& shape, std::size_t i, const Vec3& place, const Vec3& normal,
                Lot& lot) {
  Leaf leaf;
  leaf.id = static_cast<int>(i);
  leaf.scale = 1 + spec.variation * (2 * lot() - 1);
  const double heading = 2 * pi * lot();
  leaf.orientation = lying(normal, heading, lot() < 0.5);
  put_down(leaf, shape, spec.position + place, normal, k_above + k_layers * lot());
  leaf.asleep = true;
  return leaf;
}

/// By which the two sides of a leaf rise from its rib, at z = 0: the slope that fits best of y over |z|. Not below 0.
double fold_of(const Mesh& mesh) {
  double z = 0, y = 0, zz = 0, yz = 0;
  for (const Vec3& p : mesh.positions)
    z += std::abs(p.z()), y += p.y(), zz += p.z() * p.z(), yz += std::abs(p.z()) * p.y();
  const double n = static_cast<double>(mesh.positions.size()), spread = n * zz - z * z;
  return spread > 0 ? std::max(0.0, std::atan((n * yz - z * y) / spread)) : 0;
}

std::vector<Leaf> over_rectangle(const LeavesSpec& spec, const LeafShape& shape) {
  std::vector<Leaf> out;
  for (std::size_t i = 0; i < at(spec.count); ++i) {
    Lot lot(spec, i);
    const Vec3 place((lot() - 0.5) * spec.size.x(), 0, (lot() - 0.5) * spec.size.z());
    Leaf leaf = lying_leaf(spec, shape, i, place, Vec3::UnitY(), lot);
    if (spec.size.y() > 0) {
      leaf.position.y() += lot() * spec.size.y();
      leaf.orientation = Quat(Eigen::AngleAxisd(0.5 * (2 * lot() - 1), Vec3::UnitX())) *
                         Quat(Eigen::AngleAxisd(0.5 * (2 * lot() - 1), Vec3::UnitZ())) * leaf.orientation;
      leaf.asleep = false;
    }
    out.push_back(leaf);
  }
  return out;
}

Result<std::vector<Leaf>> over_mesh(const LeavesSpec& spec, const LeafShape& shape) {
  const auto mesh = read_obj(spec.over);
  if (!mesh) return mesh.error();
  struct Face {
    Triangle corners;
    Vec3 normal;
    double until;  ///< area of the faces up to it [m2]
  };
  std::vector<Face> faces;
  double area = 0;
  const std::vector<Vec3>& x = mesh->positions;
  for (const Triangle& t : triangulate(*mesh)) {
    const Vec3 cross = (x[at(t[1])] - x[at(t[0])]).cross(x[at(t[2])] - x[at(t[0])]);
    if (!(cross.norm() > 0) || cross.normalized().y() < k_steepest) continue;
    area += 0.5 * cross.norm();
    faces.push_back({t, cross.normalized(), area});
  }
  if (faces.empty())
    return input_error("no face of it looks up: there is nothing on which leaves could lie", spec.over.string());
  std::vector<Leaf> out;
  for (std::size_t i = 0; i < at(spec.count); ++i) {
    Lot lot(spec, i);
    const double which = lot() * area;
    const Face& face = *std::lower_bound(faces.begin(), faces.end() - 1, which,
                                         [](const Face& f, double until) { return f.until < until; });
    const double root = std::sqrt(lot()), along = lot();
    const Vec3 place = (1 - root) * x[at(face.corners[0])] + root * (1 - along) * x[at(face.corners[1])] +
                       root * along * x[at(face.corners[2])];
    out.push_back(lying_leaf(spec, shape, i, place, face.normal, lot));
  }
  return out;
}

Result<std::vector<Leaf>> from_file(const LeavesSpec& spec, const LeafShape& shape) {
  auto text = read_text(spec.placed, k_most_bytes);
  if (!text) return text.error();
  std::ranges::replace(*text, ',', ' ');
  std::istringstream lines(*text);
  std::vector<Leaf> out;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    std::string first;
    if (!(words >> first) || first.front() == '#') continue;
    words.seekg(0);
    Vec3 place;
    if (!(words >> place.x() >> place.y() >> place.z()) || !place.allFinite()) {
      if (out.empty() && number == 1) continue;  // names of the columns
      return input_error("is no place: x, y, z in metres", fmt::format("{}:{}", spec.placed.string(), number));
    }
    Lot lot(spec, out.size());
    Leaf leaf = lying_leaf(spec, shape, out.size(), place, Vec3::UnitY(), lot);
    double heading = 0, scale = 1;
    if (words >> heading) leaf.orientation = lying(Vec3::UnitY(), heading * pi / 180, false);
    if (words >> scale) {
      if (!(scale > 0 && scale < 1000))
        return input_error("has a scale that is not above 0", fmt::format("{}:{}", spec.placed.string(), number));
      leaf.scale = scale;
    }
    put_down(leaf, shape, spec.position + place, Vec3::UnitY(), k_above + k_layers * lot());
    out.push_back(leaf);
  }
  if (out.empty()) return input_error("has no place in it", spec.placed.string());
  return out;
}

}  // namespace

Result<std::vector<Leaf>> scatter(const LeavesSpec& spec, const LeafPrototype& prototype) {
  const LeafShape shape = shape_of(prototype);
  if (!spec.placed.empty()) return from_file(spec, shape);
  if (!spec.over.empty()) return over_mesh(spec, shape);
  return over_rectangle(spec, shape);
}

Result<LeafPrototype> leaf_prototype(const LeavesSpec& spec) {
  LeafPrototype out = almond_leaf(spec.name, spec.length, spec.width, spec.fold * pi / 180);
  if (!spec.mesh.empty()) {
    const auto mesh = read_obj(spec.mesh);
    if (!mesh) return mesh.error();
    if (mesh->positions.size() > 64)
      return input_error(fmt::format("has {} vertices, and a leaf at most 64", mesh->positions.size()),
                         spec.mesh.string());
    out.positions = mesh->positions;
    out.triangles = triangulate(*mesh);
    out.fold = fold_of(*mesh);
  }
  out.mass_per_area = spec.mass_per_area;
  out.lying_lift = spec.lift;
  out.adhesion = spec.adhesion;
  return out;
}

}  // namespace ft::inline baker
