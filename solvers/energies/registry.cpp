#include "solvers/energies/registry.h"

#include "solvers/energies/attachments.h"
#include "solvers/energies/bending.h"
#include "solvers/energies/membrane.h"
#include "solvers/energies/seams.h"

namespace ft::inline solvers {
namespace {

template <class T>
std::unique_ptr<Energy> make_plain(const ClothTopology& topology, const AirSettings&) {
  return std::make_unique<T>(topology);
}

std::unique_ptr<Energy> make_air_drag(const ClothTopology& topology, const AirSettings& air) {
  return std::make_unique<AirDrag>(topology, air);
}

constexpr ClothEnergyKind k_kinds[] = {
    {"membrane", make_plain<Membrane>, true, true},
    {"bending", make_plain<Bending>, true, false},
    {"air_drag", make_air_drag, false, true},
    {"seams", make_plain<Seams>, false, true},
    {"attachments", make_plain<Attachments>, false, true},
};

}  // namespace

std::span<const ClothEnergyKind> cloth_energy_kinds() {
  return k_kinds;
}

std::vector<std::unique_ptr<Energy>> make_cloth_energies(const ClothTopology& topology, const AirSettings& air) {
  std::vector<std::unique_ptr<Energy>> out;
  for (const ClothEnergyKind& kind : k_kinds) out.push_back(kind.make(topology, air));
  return out;
}

}  // namespace ft::inline solvers
