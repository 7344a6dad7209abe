#include "baker/systems/cords/cords_keys.h"

namespace ft::inline baker {

std::span<const ShotKey<CordsSpec>> cords_keys() {
  static const ShotKey<CordsSpec> keys[] = {
      {"shape", &CordsSpec::shape, 0, 0, "", "net rope knots mesh", true, "type kind",
       "`net`: of diamonds, below a rim; `rope`; `knots`: a rope with heavier knots; `mesh`: the edges of a mesh"},
      {"columns", &CordsSpec::columns, 3, 1000, "", "", false, "loops hooks", "Net: loops at the rim"},
      {"rows", &CordsSpec::rows, 1, 1000, "", "", false, "rings",
       "Net: rings of knots below the rim; two to a diamond"},
      {"radius_top", &CordsSpec::radius_top, 1e-3, 100, "m", "", false, "rim ring_radius top", "Net: of the rim"},
      {"radius_bottom", &CordsSpec::radius_bottom, 1e-3, 100, "m", "", false, "bottom", "Net: of its lower opening"},
      {"length", &CordsSpec::length, 1e-3, 1000, "m", "", false, "height depth", "Net: from the rim down"},
      {"points", &CordsSpec::points, 0, 10'000, "", "", false,
       "pieces points_per_cord segments subdivisions resolution",
       "Straight pieces of a side of a net, of a rope, between two knots, of an edge of a mesh; 0 is 2, 32, 4, 1"},
      {"position", &CordsSpec::position, -1e4, 1e4, "m", "", false, "from start offset place centre center location",
       "Centre of the rim; start of a rope; added to a mesh"},
      {"to", &CordsSpec::to, -1e4, 1e4, "m", "", false, "end target", "Rope, knots: where it ends"},
      {"knots", &CordsSpec::knots, 1, 10'000, "", "", false, "beads weights knot_count",
       "Knots: how many, evenly spaced, the last at the end"},
      {"knot_mass", &CordsSpec::knot_mass, 0, 1e4, "kg", "", false, "bead_mass weight_mass",
       "Knots: of each; `mass` includes them"},
      {"mesh", &CordsSpec::mesh, 0, 0, "", "", false, "file path", "OBJ whose edges are cords"},
      {"unit_scale", &CordsSpec::unit_scale, 1e-6, 1000, "m per mesh unit", "", false, "scale units unit",
       "0.01 for a mesh in centimetres"},
      {"up", &CordsSpec::up, 0, 0, "", "y z", false, "up_axis axis", "Up axis of the mesh"},
      {"held", &CordsSpec::held, 0, 0, "", "", false, "hold pin pins pinned attach fixed group",
       "What is tied to the world. Rope, knots: `start` (default), `end`, `both`, `none`; mesh: a vertex group. A net "
       "is held by its rim"},
      {"mass", &CordsSpec::mass, 1e-6, 1e4, "kg", "", true, "weight total_mass", "Of all of it"},
      {"stretch", &CordsSpec::stretch, 1, 1e9, "N", "", false, "ea stiffness axial_stiffness",
       "Axial stiffness EA, the force at a strain of 1: 3 mm loose nylon twine 3000, climbing rope 2e4, 16 mm hemp "
       "1e5"},
      {"bend", &CordsSpec::bend, 0, 1e4, "N m2", "", false, "ei bending bend_stiffness",
       "Bending stiffness EI; 0 folds freely"},
      {"damping", &CordsSpec::damping, 0, 1, "s", "", false, "damp stiffness_damping",
       "Of stretch and bend, in units of their stiffness; the damping ratio of what vibrates at w rad/s is w/2 times "
       "it"},
      {"radius", &CordsSpec::radius, 0.5e-3, 0.05, "m", "", false, "thickness width cord_radius",
       "Of a cord, as it is drawn and as it touches"},
      {"friction", &CordsSpec::friction, 0, 2, "1", "", false, "mu", "Coulomb coefficient"},
      {"self_collision", &CordsSpec::self_collision, 0, 0, "", "", false, "self_contact", "Cords meet each other"},
      {"hold_stiffness", &CordsSpec::hold_stiffness, 1, 1e9, "N/m", "", false, "pin_stiffness",
       "Of the spring at each held point"},
      {"meets", &CordsSpec::meets, 0, 0, "", "", false, "collides collides_with colliders obstacles",
       "Primaries that these cords meet beside the one that they are on, and do not move: names with `*` and `?`; "
       "`[]`: no other"},
      {"on", &CordsSpec::on, 0, 0, "", "@name of a primary", false, "primary body collider prop with",
       "The primary that it meets; not needed when there is only one"},
      {"coupling", &CordsSpec::coupling, 0, 0, "", "one-way hybrid two-way", false, "couple interaction",
       "Who feels whom: `one-way`, the cords feel the primary; `hybrid`, the primary yields to stand-ins first; "
       "`two-way`, both feel each other"},
  };
  return keys;
}

}  // namespace ft::inline baker
