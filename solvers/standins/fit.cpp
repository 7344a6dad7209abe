#include "solvers/standins/fit.h"

#include <fmt/format.h>

#include <algorithm>

namespace ft::inline solvers {

StandInFit fit_stand_in(std::span<const ForceSample> samples) {
  StandInFit out;
  out.samples = static_cast<int>(samples.size());
  double vv = 0, dd = 0, vd = 0, fv = 0, fd = 0, ff = 0;
  for (const ForceSample& s : samples) {
    vv += s.velocity.squaredNorm(), dd += s.displacement.squaredNorm(), vd += s.velocity.dot(s.displacement);
    fv -= s.force.dot(s.velocity), fd -= s.force.dot(s.displacement), ff += s.force.squaredNorm();
  }
  if (!(ff > 0)) return out;
  // What c and k take off the squared force. Both, or the better of one alone where the other would be negative or
  // the two cannot be told apart.
  const auto explained = [&](double c, double k) {
    return 2 * (c * fv + k * fd) - c * c * vv - k * k * dd - 2 * c * k * vd;
  };
  const auto take = [&](double c, double k) {
    const double r2 = explained(c, k) / ff;
    if (!(c >= 0 && k >= 0 && r2 > out.r2)) return;
    out.damping = c, out.stiffness = k, out.r2 = std::min(r2, 1.0);
  };
  if (vv > 0) take(fv / vv, 0);
  if (dd > 0) take(0, fd / dd);
  const double determinant = vv * dd - vd * vd;
  if (determinant > 1e-9 * vv * dd) take((dd * fv - vd * fd) / determinant, (vv * fd - vd * fv) / determinant);
  return out;
}

std::string StandInFit::text() const {
  std::string law;
  if (damping > 0) law = fmt::format("c = {:.3g} kg/s", damping);
  if (stiffness > 0) law += fmt::format("{}k = {:.3g} N/m", law.empty() ? "" : " and ", stiffness);
  if (law.empty()) return fmt::format("neither damping nor a recoil explains the force ({} samples)", samples);
  return fmt::format("{} {} {:.0f} % of the force (R2 {:.3f}, {} samples)", law,
                     damping > 0 && stiffness > 0 ? "explain" : "explains", 100 * r2, r2, samples);
}

}  // namespace ft::inline solvers
