#include "baker/plan/primary_mass.h"

#include <fmt/format.h>

#include "baker/core/volume.h"

namespace ft::inline baker {
namespace {

constexpr double k_columns = 1.0 / 400;  ///< distance of the columns that measure a volume, of the body's size

}  // namespace

std::string PrimaryMass::text() const {
  if (kilograms <= 0) return "mass unknown: its surface encloses no volume; write [primary] mass";
  if (given) return fmt::format("{:.4g} kg, as given", kilograms);
  return fmt::format("{:.4g} kg, from its volume of {:.4g} dm3", kilograms, 1e3 * volume);
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
  if (spacing > 0) out.volume = enclosed_volume(bind, trajectory.surface().triangles, spacing).value_or(0);
  out.kilograms = k_body_density * out.volume;
  return out;
}

}  // namespace ft::inline baker
