// Measured fabrics in SI units. The list with sources is in fabrics.cpp.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ft::inline solvers {

struct Fabric {
  std::string name;
  /// Areal density [kg/m2]. 0.05 silk, 0.15 cotton, 0.32 denim.
  double mass_per_area = 0.15;
  /// Membrane stiffness in warp (pattern v) and weft (pattern u) direction [N/m]. 100 jersey, 1000 denim.
  double stretch_warp = 500, stretch_weft = 500;
  /// In-plane shear modulus [N/m].
  double shear = 100;
  /// Poisson's ratio of the membrane [1], 0..0.45.
  double poisson = 0.3;
  /// Bending rigidity of the warp and of the weft yarns: fold across them [N m]. 1e-6 silk, 1e-4 denim. 0 folds freely.
  double bend_warp = 1e-5, bend_weft = 1e-5;
  /// Strain along the warp and the weft from which on the crimp of the yarns is used up and they pull straight [1]; 0:
  /// never (knits).
  double limit_warp = 0, limit_weft = 0;
  /// Stiffness that straight yarns add beyond it [N/m].
  double limit_stretch = 1e4;
  /// Angle by which warp and weft turn against each other before their yarns begin to jam, sideways against the next
  /// ones [rad]; 0: never. See fabrics.cpp.
  double limit_shear = 0;
  /// Shear stiffness that jammed yarns add beyond it [N/m].
  double limit_jam = 1000;
  /// Strain-rate damping time of the membrane and of bending [s]: stress = C (strain + time * strain rate). 0 none,
  /// 0.01 dull.
  double damping = 2e-3;
  /// Air drag: normal and tangential coefficients of the panel law [1].
  double drag_normal = 1.2, drag_tangential = 0.03;
  /// Lift of a thin plate at small angles, by the angle: 2 pi / (1 + 2 / AR), AR: span by chord [1]; 0 leaves it out.
  double lift = 0;
  /// Thickness of the layer of air that goes along with the cloth, pi / 4 of the shorter side for a plate [m].
  double added_mass = 0;
  std::string source;
};

std::span<const Fabric> fabrics();
const Fabric* find_fabric(std::string_view name);
/// Sets a member by its name ("mass_per_area"); false when there is no such key. fabric_keys() tells what is allowed.
bool set_fabric_value(Fabric& fabric, std::string_view key, double value);
/// A member by its name; none when there is no such key.
std::optional<double> fabric_value(const Fabric& fabric, std::string_view key);
struct FabricKey {
  std::string_view key;
  double lowest, highest;
  std::string_view unit;
};
std::span<const FabricKey> fabric_keys();

}  // namespace ft::inline solvers
