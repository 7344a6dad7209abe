// A group of cloths in words, for --dry-run.
#include <fmt/format.h>

#include <algorithm>

#include "baker/plan/plan_text.h"
#include "baker/systems/cloth/cloth_group.h"
#include "baker/systems/cloth/cloth_maps.h"
#include "io/shot/shot_values.h"
#include "io/shot/words.h"
#include "solvers/cloth/model/attach.h"

namespace ft::inline baker {
namespace {

/// "8 vertices held to "skirt", 2.1 to 7.9 mm from it".
std::string attachment_text(std::span<const ClothGarment> garments, const ClothGarment& own, const ClothPin& pin) {
  double nearest = std::numeric_limits<double>::infinity(), farthest = 0;
  int held = 0;
  for (const SurfacePoint& f : anchor_points(garments, static_cast<std::size_t>(&own - garments.data()), pin)) {
    if (f.triangle[0] < 0) continue;
    nearest = std::min(nearest, f.distance), farthest = std::max(farthest, f.distance);
    ++held;
  }
  return fmt::format("{} vertices held to \"{}\", {:.1f} to {:.1f} mm from it", held,
                     garments[static_cast<std::size_t>(pin.to)].name, 1e3 * nearest, 1e3 * farthest);
}

/// ", open by up to 310 mm, closed 1.2 s after the start".
std::string seam_text(const ClothGarment& garment, const ClothSetup& setup) {
  double widest = 0;
  const auto& x = garment.mesh.positions;
  for (const Stitch& s : garment.mesh.stitches)
    widest = std::max(widest, (x[at(s.vertex)] - (1 - s.place) * x[at(s.edge[0])] - s.place * x[at(s.edge[1])]).norm());
  const double preroll = setup.preroll_frames / setup.fps;
  return fmt::format(", open by up to {:.3g} mm, closed {:.3g} s after the start", 1e3 * widest,
                     garment.sewing_time > 0 ? garment.sewing_time : 0.5 * preroll);
}

/// "map of thickness: 0.001 to 0.004 m, mean 0.0021 m".
std::string map_text(const NamedMap& map, std::span<const double> values) {
  double sum = 0;
  for (const double v : values) sum += v;
  const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
  const MapKind* kind = find_map_kind(map.name);
  std::string unit;
  if (kind && kind->unit != "1") unit.append(1, ' ').append(kind->unit);
  return fmt::format("map of {}: {:.4g} to {:.4g}{}, mean {:.4g}{}", map.name, *lowest, *highest, unit,
                     sum / static_cast<double>(values.size()), unit);
}

const std::string& wearer_of(const BakePlan& plan, const ClothGroup& group, const ClothGarment& garment) {
  const auto index = at(&garment - group.setup.garments.data());
  return plan.primaries[group.outputs[index].primary].name;
}

/// The primaries that a cloth meets, and the cloths that it is solved with.
std::string met_text(const BakePlan& plan, const ClothGroup& group, const ClothGarment& garment) {
  std::vector<std::string> names, cloths;
  for (std::size_t m = 0; m < group.bodies.size(); ++m) {
    std::size_t left_out = 0;
    const int first = group.joint->first_part(m), end = group.joint->first_part(m + 1);
    for (const int part : garment.ignores) left_out += part >= first && part < end;
    if (left_out < at(end - first)) names.push_back(in_quotes(plan.primaries[group.bodies[m]].name));
  }
  if (group.bodies.empty()) names.push_back("\"" + plan.primaries[group.primary].name + "\" alone");
  for (const ClothGarment& other : group.setup.garments)
    if (&other != &garment) cloths.push_back(in_quotes(other.name));
  return joined(names) + (cloths.empty() ? "" : "; together with cloth " + joined(cloths));
}

}  // namespace

std::vector<std::string> ClothGroup::lines(const BakePlan& plan) const {
  std::vector<std::string> out;
  for (const ClothGarment& garment : setup.garments) {
    std::size_t pinned = 0;
    for (const ClothPin& pin : garment.pins) pinned += pin.to < 0 ? pin.vertices.size() : 0;
    out.push_back(fmt::format("cloth \"{}\" on \"{}\": {} vertices, {} faces, {} pinned, {}, {} at {:g} kg/m2",
                              garment.name, wearer_of(plan, *this, garment), garment.mesh.vertex_count(),
                              garment.mesh.face_count(), pinned, box_text(bounds(garment.mesh.positions)),
                              garment.fabric.name, garment.fabric.mass_per_area));
    if (plan.primaries.size() > 1) out.push_back("  meets " + met_text(plan, *this, garment));
    for (const NamedMap& map : k_vertex_maps)
      if (!(garment.maps.*map.values).empty()) out.push_back("  " + map_text(map, garment.maps.*map.values));
    for (const ClothPin& pin : garment.pins)
      if (pin.to >= 0) out.push_back("  " + attachment_text(setup.garments, garment, pin));
    if (!garment.mesh.stitches.empty()) out.push_back("  " + sewing_text(garment.mesh) + seam_text(garment, setup));
    if (garment.pattern_scale > 0)
      out.push_back(fmt::format("  cut from its pattern at {:g} m per unit of vt", garment.pattern_scale));
  }
  return out;
}

}  // namespace ft::inline baker
