#include "baker/systems/cloth/pins.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "baker/core/parallel.h"
#include "collision/geometry/pair_geometry.h"
#include "io/shot/vertex_values.h"
#include "solvers/cloth/model/attach.h"

namespace ft::inline baker {
namespace {

constexpr std::size_t k_bundle = 32;  // triangles per box: neighbours in the file are neighbours in space, mostly

double distance_to_box(const Vec3& p, const Box& box) {
  return (box.lo - p).cwiseMax(p - box.hi).cwiseMax(Vec3::Zero()).norm();
}

std::string group_list(const Mesh& garment) {
  if (garment.groups.empty()) return "the mesh has no groups; use within or vertices";
  std::string out = "there are: ";
  for (std::size_t i = 0; i < garment.groups.size(); ++i) out += (i ? ", " : "") + garment.groups[i].name;
  return out;
}

}  // namespace

std::vector<double> distances_to_surface(std::span<const Vec3> points, std::span<const Vec3> body,
                                         std::span<const Triangle> triangles) {
  std::vector<Box> boxes(block_count(triangles.size(), k_bundle));
  const auto corner = [&](const Triangle& t, std::size_t k) -> const Vec3& {
    return body[static_cast<std::size_t>(t[k])];
  };
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) boxes[i / k_bundle].include(corner(triangles[i], k));
  std::vector<double> out(points.size(), std::numeric_limits<double>::infinity());
  parallel_for(points.size(), 64, [&](std::size_t begin, std::size_t end) {
    std::size_t hint = 0;  // bundle of the last answer: a good first bound for the next point
    for (std::size_t i = begin; i < end; ++i) {
      double best = std::numeric_limits<double>::infinity();
      std::size_t best_bundle = hint;
      const auto visit = [&](std::size_t b) {
        if (distance_to_box(points[i], boxes[b]) >= best) return;
        for (std::size_t t = b * k_bundle; t < std::min(triangles.size(), (b + 1) * k_bundle); ++t) {
          const double d =
              vertex_face_geometry(points[i], corner(triangles[t], 0), corner(triangles[t], 1), corner(triangles[t], 2))
                  .distance;
          if (d < best) best = d, best_bundle = b;
        }
      };
      if (!boxes.empty()) visit(hint);
      for (std::size_t b = 0; b < boxes.size(); ++b)
        if (b != hint) visit(b);
      out[i] = best;
      hint = best_bundle;
    }
  });
  return out;
}

Result<ClothPin> resolve_pin(const PinSpec& spec, const Mesh& garment, std::span<const Vec3> body,
                             std::span<const Triangle> triangles) {
  ClothPin pin;
  static_cast<ClothPinSettings&>(pin) = spec;
  switch (spec.select) {
    case PinSpec::Select::k_group: {
      const auto group = std::find_if(garment.groups.begin(), garment.groups.end(),
                                      [&](const VertexGroup& g) { return g.name == spec.group; });
      if (group == garment.groups.end())
        return usage_error("pin group \"" + spec.group + "\" does not exist", {}, group_list(garment));
      for (std::size_t i = 0; i < group->vertices.size(); ++i) {
        const double weight = i < group->weights.size() ? group->weights[i] : 1.0;
        if (!(weight > 0)) continue;
        pin.vertices.push_back(group->vertices[i]);
        pin.weights.push_back(std::min(weight, 1.0));
      }
      if (pin.vertices.empty())
        return usage_error("pin group \"" + spec.group + "\" has no vertex with a weight above 0", {},
                           group_list(garment));
      break;
    }
    case PinSpec::Select::k_within: {
      const auto distance = distances_to_surface(garment.positions, body, triangles);
      double smallest = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < distance.size(); ++i) {
        smallest = std::min(smallest, distance[i]);
        if (distance[i] <= spec.within) pin.vertices.push_back(static_cast<int>(i));
      }
      if (pin.vertices.empty())
        return usage_error(
            fmt::format("pin within = {} m selects nothing: the nearest vertex is {:.4g} m from {}", spec.within,
                        smallest, spec.to.empty() ? "the body" : "cloth \"" + spec.to + "\""),
            {}, "unit_scale, up and offset place the mesh");
      break;
    }
    case PinSpec::Select::k_file: {
      auto weights = vertex_column(spec.file, spec.column, garment.vertex_count(), 0, 1, "1");
      if (!weights) return weights.error();
      for (std::size_t i = 0; i < weights->size(); ++i)
        if ((*weights)[i] > 0) pin.vertices.push_back(static_cast<int>(i)), pin.weights.push_back((*weights)[i]);
      if (pin.vertices.empty())
        return usage_error("has no weight above 0: this pin holds nothing", spec.file.filename().string());
      break;
    }
    case PinSpec::Select::k_vertices:
      for (const int v : spec.vertices)
        if (v < 0 || v >= garment.vertex_count())
          return usage_error(
              fmt::format("pin vertex {} does not exist: the mesh has vertices 0-{}", v, garment.vertex_count() - 1));
      if (spec.vertices.empty()) return usage_error("pin vertices = [] selects nothing");
      pin.vertices = spec.vertices;
      break;
  }
  return pin;
}

Status check_anchor_points(std::span<const ClothGarment> garments, std::size_t own, const ClothPin& pin,
                           std::vector<std::string>& notes) {
  const ClothGarment& target = garments[static_cast<std::size_t>(pin.to)];
  for (const ClothGarment* garment : {&garments[own], &target})
    if (!garment->mesh.stitches.empty())
      return usage_error(
          fmt::format("a pin holds to cloth \"{}\", but the panels of \"{}\" are apart until they are sewn",
                      target.name, garment->name),
          {}, "bake the sewing by itself, and give what comes out of it as the mesh");
  const auto found = anchor_points(garments, own, pin);
  const auto missing =
      std::count_if(found.begin(), found.end(), [](const SurfacePoint& f) { return f.triangle[0] < 0; });
  const std::string none =
      fmt::format("no other side of cloth \"{}\" is found for {} of the {} vertices that a pin holds to it",
                  target.name, missing, found.size());
  if (missing == std::ssize(found)) return usage_error(none, {}, "within one cloth a pin holds what an opening parts");
  if (missing > 0) notes.push_back(none + ": not held");
  return {};
}

}  // namespace ft::inline baker
