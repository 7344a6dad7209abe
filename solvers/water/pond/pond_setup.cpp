#include "solvers/water/pond/pond_setup.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

#include "solvers/water/pond/float_contact.h"

namespace ft::inline solvers {
namespace {

constexpr int k_least_cells = 8, k_most_cells = 4096;
constexpr double k_most_bytes = 2e9;  ///< of waves, kernels and scratch

bool is_closed(std::span<const Triangle> triangles) {
  std::map<std::pair<int, int>, int> edges;
  for (const Triangle& t : triangles)
    for (std::size_t c = 0; c < 3; ++c) {
      const int a = t[c], b = t[(c + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  return std::all_of(edges.begin(), edges.end(), [](const auto& e) { return e.second == 0; });
}

void check_body(const PondSetup& s, const PondFloat& f, std::vector<std::string>& faults) {
  const FloatingBody& b = f.body;
  const auto fault = [&](std::string text) { faults.push_back(fmt::format("body \"{}\": {}", b.name, text)); };
  if (b.positions.empty() || b.triangles.empty()) return fault("has no surface");
  for (const Triangle& t : b.triangles)
    for (const int v : t)
      if (v < 0 || at(v) >= b.positions.size())
        return fault(fmt::format("a triangle names vertex {} of {}", v, b.positions.size()));
  if (!all_finite(b.positions)) return fault("a vertex is no number");
  if (!is_closed(b.triangles)) return fault("its surface is open; what floats has to be closed");
  if (!(b.mass.mass > 0)) return fault(fmt::format("mass = {} kg has to be above 0", b.mass.mass));
  const Vec3 principal = b.mass.inertia.selfadjointView<Eigen::Lower>().eigenvalues();
  if (!(principal.minCoeff() > 0)) return fault("its inertia has a moment that is not above 0");
  if (!(b.drag >= 0)) return fault(fmt::format("drag = {} has to be 0 or more", b.drag));
  double volume = 0;
  for (const Triangle& t : b.triangles)
    volume += b.positions[at(t[0])].dot(b.positions[at(t[1])].cross(b.positions[at(t[2])])) / 6;
  if (!(volume > 0)) return fault(fmt::format("encloses {} m3; its triangles may face inwards", volume));
  Box box;
  for (const Vec3& p : b.positions) box.include(f.start.pose * p);
  const Vec3 size = box.size();
  if (size.x() > s.size_x || size.z() > s.size_z)
    return fault(
        fmt::format("is {:.4g} x {:.4g} m and the pond {:.4g} x {:.4g} m", size.x(), size.z(), s.size_x, s.size_z));
  const Vec3 lo = box.lo - s.corner, hi = box.hi - s.corner;
  if (lo.x() < 0 || lo.z() < 0 || hi.x() > s.size_x || hi.z() > s.size_z)
    return fault(
        fmt::format("starts outside the pond: x {:.4g} to {:.4g} of 0 to {:.4g} m, z {:.4g} to {:.4g} of 0 to "
                    "{:.4g} m",
                    lo.x(), hi.x(), s.size_x, lo.z(), hi.z(), s.size_z));
  if (lo.y() < -s.depth) return fault(fmt::format("starts {:.4g} m below the floor", -s.depth - lo.y()));
}

void check_overlaps(const PondSetup& s, std::vector<std::string>& faults) {
  std::vector<FloatShape> shapes;
  for (const PondFloat& f : s.floats) shapes.push_back(float_shape(f, s.density));
  for (std::size_t a = 0; a < shapes.size(); ++a)
    for (std::size_t b = a + 1; b < shapes.size(); ++b) {
      const double depth = overlap(shapes[a], s.floats[a].start.pose, shapes[b], s.floats[b].start.pose);
      if (depth > 1e-9)
        faults.push_back(fmt::format("bodies \"{}\" and \"{}\" overlap by {:.4g} m at the start", s.floats[a].body.name,
                                     s.floats[b].body.name, depth));
    }
}

}  // namespace

Status check_pond(const PondSetup& s) {
  std::vector<std::string> faults;
  const auto within = [&](const char* name, double value, double lo, double hi, const char* unit) {
    if (!(value >= lo && value <= hi))
      faults.push_back(fmt::format("{} = {} is outside [{}, {}] {}", name, value, lo, hi, unit));
  };
  if (!(s.depth > 0)) faults.push_back(fmt::format("depth = {} m: the pond is dry", s.depth));
  within("size_x", s.size_x, 0.05, 1e4, "m");
  within("size_z", s.size_z, 0.05, 1e4, "m");
  for (const auto& [name, n] : {std::pair{"nx", s.nx}, {"nz", s.nz}}) {
    if (n < k_least_cells || n > k_most_cells)
      faults.push_back(fmt::format("{} = {} is outside [{}, {}] cells", name, n, k_least_cells, k_most_cells));
    else if (n % 2 != 0)
      faults.push_back(fmt::format("{} = {} has to be even", name, n));
  }
  const double bytes = static_cast<double>(s.nx) * s.nz * (12.0 * 8 + 8.0 * static_cast<double>(s.floats.size()));
  if (bytes > k_most_bytes)
    faults.push_back(fmt::format("{} x {} cells with {} bodies need {:.3g} GB; the limit is {:.3g} GB", s.nx, s.nz,
                                 s.floats.size(), bytes * 1e-9, k_most_bytes * 1e-9));
  within("gravity", s.gravity, 0.01, 1000, "m/s2");
  within("density", s.density, 1, 20000, "kg/m3");
  within("tension", s.tension, 0, 1, "N/m");
  within("wind", s.wind.norm(), 0, 20, "m/s");
  within("steps_per_second", s.steps_per_second, 30, 100000, "1/s");
  if (s.edges == PondEdge::k_open) within("rim", s.rim, 0, 0.45 * std::min(s.size_x, s.size_z), "m");
  const SplashSettings& p = s.splash;
  within("splash.energy_share", p.energy_share, 0, 1, "");
  within("splash.droplet_diameter", p.droplet_diameter, 1e-4, 1, "m");
  within("splash.most_droplets", p.most_droplets, 0, 5e6, "");
  within("splash.cavity_slice", p.cavity_slice, 1e-3, 10, "m");
  within("splash.cavity_opening", p.cavity_opening, 0, 1, "");
  within("splash.jet_share", p.jet_share, 0, 1, "");
  within("splash.foam_life", p.foam_life, 0.01, 1e6, "s");
  const std::size_t before = faults.size();
  for (const PondFloat& f : s.floats) check_body(s, f, faults);
  if (faults.size() == before && s.density > 0) check_overlaps(s, faults);
  if (faults.empty()) return {};
  std::string text;
  for (const std::string& f : faults) text += (text.empty() ? "" : "; ") + f;
  return usage_error(text);
}

}  // namespace ft::inline solvers
