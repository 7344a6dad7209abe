// The list of fabrics, in SI units, each with its source. For shot files ("fabric = "denim"") and for material tests.
//
// [W] Wang, O'Brien, Ramamoorthi 2011, "Data-driven elastic models for cloth", the published ten-material database.
//     It is nonlinear; we keep one linear constant each: stretch = mean of c11 (weft) and c22 (warp) over the strained
//     rows, shear = c33 of the unstrained row for knits (the strained ones scatter around it), mean of the strained
//     rows for wovens; poisson = mean c12 / sqrt(c11 c22), at most 0.45; bending = mean over the curvatures 0, 10, 20,
//     30 /m of the row whose fold lies along the weft (bend_warp) and along the warp (bend_weft).
// [P] Penava, Simic Penava, Knezic 2014, "Determination of the elastic constants of plain woven fabrics by a tensile
//     test", as quoted by public simulation code: areal density and Poisson's ratio.
// [literature] Typical values of the Kawabata system (KES), recalled and not read again:
//     1 gf cm2/cm = 9.807e-5 N m for bending, 1 gf/cm/degree = 56.2 N/m for shear. Right in size, not a measurement of
//     one piece of cloth.
// Limits of stretch of the weaves: KES reads the strain at 490 N/m, which is 3 to 10 % for them (shirting, suiting,
//     denim); the first half of that goes into the crimp at the soft slope above, the rest at 1e4 N/m [literature].
//     Knits and elastic wefts have none that a garment reaches.
// Limits of shear: none of the sources has any, and no fabric of the list. Parallel yarns touch each other when
//     cos(angle) is their width by their distance: 0.2 rad where yarns cover 98 % of it, as in poplin, 0.7 rad at 75 %;
//     they begin to press earlier. What jammed yarns add is ours: ten times cotton's.
// Damping times are ours, none of the sources has any: as small as what swings in a second and is still in a few.
#include <algorithm>

#include "solvers/energies/fabric.h"

namespace ft::inline solvers {
namespace {

constexpr double k_gf_cm2_per_cm = 9.80665e-5;  ///< N m
constexpr double k_gf_per_cm_degree = 56.188;   ///< N/m per radian

constexpr const char* k_wang = "Wang, O'Brien, Ramamoorthi 2011, ";

/// The drag of a flat plate is that of all of them, as air does not know the yarn.
Fabric measured(std::string name, double mass, double warp, double weft, double shear, double poisson, double bend_warp,
                double bend_weft, double damping, std::string source) {
  Fabric out;
  out.name = std::move(name);
  out.mass_per_area = mass;
  out.stretch_warp = warp;
  out.stretch_weft = weft;
  out.shear = shear;
  out.poisson = poisson;
  out.bend_warp = bend_warp;
  out.bend_weft = bend_weft;
  out.damping = damping;
  out.source = std::move(source);
  return out;
}

/// The weave stiffens beyond these strains of warp and weft.
Fabric limited(double warp, double weft, Fabric fabric) {
  fabric.limit_warp = warp;
  fabric.limit_weft = weft;
  return fabric;
}

Fabric typical(std::string name, double mass, double warp, double weft, double kes_shear, double poisson,
               double kes_bend_warp, double kes_bend_weft, double damping, std::string source) {
  return measured(std::move(name), mass, warp, weft, kes_shear * k_gf_per_cm_degree, poisson,
                  kes_bend_warp * k_gf_cm2_per_cm, kes_bend_weft * k_gf_cm2_per_cm, damping, std::move(source));
}

}  // namespace

std::span<const Fabric> fabrics() {
  static const Fabric list[] = {
      measured("jersey", 0.187, 331, 97, 36.9, 0.45, 32.4e-6, 15.1e-6, 3e-3,
               std::string(k_wang) + "gray-interlock (tee-shirt, 60 % cotton 40 % polyester)"),
      limited(
          0.04, 0.04,
          typical(
              "cotton", 0.150, 500, 500, 1.8, 0.243, 0.10, 0.10, 2e-3,
              "Penava et al. 2014 (density, Poisson's ratio, plain weave); stretch between their 261 N/m at first load "
              "and Wang 2011's 2110 N/m of a cotton-polyester weave; bending and shear typical KES values of shirting "
              "[literature]")),
      limited(0.04, 0,
              measured("denim", 0.324, 1055, 227, 72.6, 0.09, 62.0e-6, 109.6e-6, 3e-3,
                       std::string(k_wang) + "11oz-black-denim (jeans, 99 % cotton 1 % spandex, elastic weft)")),
      limited(0.04, 0.04,
              typical("silk", 0.060, 400, 350, 0.32, 0.2, 0.036, 0.030, 1e-3,
                      "typical KES values of silk filament weaves, 14 momme; stretch at garment loads [literature]")),
      limited(
          0.05, 0.05,
          typical("wool", 0.235, 400, 300, 0.7, 0.277, 0.13, 0.09, 3e-3,
                  "Penava et al. 2014 (density, Poisson's ratio, plain weave); the rest typical KES values of suiting "
                  "[literature]")),
      limited(
          0.02, 0.02,
          typical(
              "ripstop", 0.0475, 3000, 2500, 3.0, 0.15, 0.055, 0.045, 1e-3,
              "coated nylon ripstop of kites and shells: Doyle, North Cloth (1.4 oz/yd2); stiffness typical of coated "
              "nylon [literature]")),
      limited(0.03, 0.03,
              typical("linen", 0.185, 900, 800, 1.2, 0.15, 0.20, 0.16, 3e-3,
                      "typical KES values of dress linen [literature]")),
      measured("sweater", 0.224, 221, 75, 17.6, 0.45, 42.1e-6, 34.8e-6, 5e-3,
               std::string(k_wang) + "navy-sparkle-sweat (sweater, 96 % polyester 4 % spandex)"),
      measured("rib_knit", 0.276, 177, 65.6, 83.2, 0.01, 72.5e-6, 37.1e-6, 5e-3,
               std::string(k_wang) + "ivory-rib-knit (underwear, 95 % cotton 5 % spandex)"),
      measured("ponte", 0.284, 191, 110, 31.9, 0.44, 44.8e-6, 34.8e-6, 4e-3,
               std::string(k_wang) + "camel-ponte-roma (jacket, 60 % polyester 40 % rayon)"),
      measured("swim", 0.204, 115, 50.4, 60.8, 0.21, 60.4e-6, 50.6e-6, 4e-3,
               std::string(k_wang) + "white-swim-solid (swimsuit, 87 % nylon 13 % spandex)"),
      limited(0.04, 0.04,
              measured("polyester", 0.128, 2146, 2107, 43.7, 0.02, 51.8e-6, 27.8e-6, 2e-3,
                       std::string(k_wang) + "white-dots-on-blk (tablecloth, 100 % polyester)")),
      limited(0.04, 0.04,
              measured("twill", 0.220, 2148, 2110, 49.8, 0.02, 180.8e-6, 180.8e-6, 3e-3,
                       std::string(k_wang) + "royal-target (trousers, 65 % cotton 35 % polyester)")),
  };
  return list;
}

const Fabric* find_fabric(std::string_view name) {
  const auto all = fabrics();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Fabric& f) { return f.name == name; });
  return found == all.end() ? nullptr : &*found;
}

namespace {

struct Member {
  FabricKey key;
  double Fabric::*member;
};

std::span<const Member> members() {
  static const Member list[] = {
      {{"mass_per_area", 0.02, 2, "kg/m2"}, &Fabric::mass_per_area},
      {{"stretch_warp", 1, 1e6, "N/m"}, &Fabric::stretch_warp},
      {{"stretch_weft", 1, 1e6, "N/m"}, &Fabric::stretch_weft},
      {{"shear", 0.1, 1e6, "N/m"}, &Fabric::shear},
      {{"poisson", 0, 0.45, "1"}, &Fabric::poisson},
      {{"bend_warp", 0, 0.1, "N m"}, &Fabric::bend_warp},
      {{"bend_weft", 0, 0.1, "N m"}, &Fabric::bend_weft},
      {{"limit_warp", 0, 1, "1"}, &Fabric::limit_warp},
      {{"limit_weft", 0, 1, "1"}, &Fabric::limit_weft},
      {{"limit_stretch", 0, 1e6, "N/m"}, &Fabric::limit_stretch},
      {{"limit_shear", 0, 1, "rad"}, &Fabric::limit_shear},
      {{"limit_jam", 0, 1e6, "N/m"}, &Fabric::limit_jam},
      {{"damping", 0, 0.1, "s"}, &Fabric::damping},
      {{"drag_normal", 0, 10, "1"}, &Fabric::drag_normal},
      {{"drag_tangential", 0, 10, "1"}, &Fabric::drag_tangential},
      {{"lift", 0, 6.3, "1"}, &Fabric::lift},
      {{"added_mass", 0, 10, "m"}, &Fabric::added_mass},
  };
  return list;
}

}  // namespace

bool set_fabric_value(Fabric& fabric, std::string_view key, double value) {
  for (const Member& m : members())
    if (m.key.key == key) {
      fabric.*m.member = value;
      return true;
    }
  return false;
}

std::optional<double> fabric_value(const Fabric& fabric, std::string_view key) {
  for (const Member& m : members())
    if (m.key.key == key) return fabric.*m.member;
  return {};
}

std::span<const FabricKey> fabric_keys() {
  static const std::vector<FabricKey> keys = [] {
    std::vector<FabricKey> out;
    for (const Member& m : members()) out.push_back(m.key);
    return out;
  }();
  return keys;
}

}  // namespace ft::inline solvers
