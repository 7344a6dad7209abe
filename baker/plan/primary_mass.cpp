#include "baker/plan/primary_mass.h"

#include <fmt/format.h>

#include "baker/core/lids.h"
#include "baker/core/volume.h"

namespace ft::inline baker {
namespace {

constexpr double k_told_lids = 1e-3;     ///< lids below this share of the area are not worth a word
constexpr double k_columns = 1.0 / 400;  ///< distance of the columns that measure a volume, of the body's size

}  // namespace

std::string PrimaryMass::text() const {
  if (kilograms <= 0) return "mass unknown: its surface encloses no volume; write [primary] mass";
  if (given) return fmt::format("{:.4g} kg, as given", kilograms);
  return fmt::format("{:.4g} kg, from its volume of {:.4g} dm3", kilograms, 1e3 * volume);
}

std::string PrimaryMass::note() const {
  if (given || kilograms <= 0 || lids < k_told_lids) return {};
  return fmt::format(
      "its surface is open ({:.2g} % of its edges, {:.2g} % of its area): its mass of {:.4g} kg is that of its volume "
      "with a flat lid over each opening; [primary] mass sets it",
      100 * open_edges, 100 * lids, kilograms);
}

PrimaryMass primary_mass(const PrimarySpec& spec, const Trajectory& trajectory) {
  PrimaryMass out;
  if (spec.mass) {
    out.kilograms = *spec.mass;
    out.given = true;
    return out;
  }
  const std::vector<Vec3> bind = bind_pose_of(trajectory);
  const double spacing = k_columns * bounds(bind).size().maxCoeff();
  const Surface& surface = trajectory.surface();
  const std::vector<Triangle> solid = solid_triangles(surface.triangles, surface.part_of_vertex, surface.parts);
  const Lids lids = close_rims(bind, solid);
  if (spacing > 0) out.volume = enclosed_volume(bind, solid, lids, spacing).value_or(0);
  out.lids = lids.share();
  out.open_edges = lids.edges > 0 ? lids.open_edges / lids.edges : 0;
  out.kilograms = k_body_density * out.volume;
  return out;
}

}  // namespace ft::inline baker
