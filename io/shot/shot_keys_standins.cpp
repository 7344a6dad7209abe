#include "io/shot/shot_keys.h"

namespace ft::inline io {

std::span<const ShotKey<PrimarySpec>> yield_keys() {
  static const ShotKey<PrimarySpec> keys[] = {
      {"limbs", &PrimarySpec::limbs, 0, 0, "", "rigid planted", false, "feet legs ik",
       "A character's: `rigid` goes along as a whole; `planted` keeps feet that stand on the ground, or in the mat, "
       "where they are, and bends the legs"},
      {"comeback", &PrimarySpec::comeback, 0, 0, "", "free spring window hold", false,
       "return back return_to_animation",
       "How it comes back to its animation: `free`, not at all; `spring`, drawn at all times; `window`, drawn once "
       "nothing touches it any more; `hold`, it stays where it was pushed to"},
      {"comeback_frequency", &PrimarySpec::comeback_frequency, 0.01, 100, "Hz", "", false, "frequency return_frequency",
       "Of the spring: 1 is back within a second or so"},
      {"comeback_damping_ratio", &PrimarySpec::comeback_damping_ratio, 0, 10, "1", "", false, "return_damping zeta",
       "Of the spring: at 1 it comes back without overshoot"},
      {"comeback_window", &PrimarySpec::comeback_window, 0, 100, "s", "", false, "window return_time",
       "`window`: the spring grows to its full strength in this time after the last touch"},
      {"max_displacement", &PrimarySpec::max_displacement, 1e-6, 1000, "m", "", false, "displacement_limit",
       "It is never farther from its animation"},
      {"max_acceleration", &PrimarySpec::max_acceleration, 1e-6, 1e6, "m/s2", "", false, "acceleration_limit",
       "Stand-ins never accelerate it more, all together"},
  };
  return keys;
}

std::span<const ShotKey<StandInKeys>> standin_keys() {
  static const ShotKey<StandInKeys> keys[] = {
      {"kind", &StandInKeys::kind, 0, 0, "", "damping mat water spring weight fitted", true, "type model",
       "`damping`: a volume that slows what is in it; `mat`: vertical springs below a level; `water`: buoyancy and "
       "drag below a level; `spring`: pulls when it is taut; `weight`: is carried; `fitted`: a damping fitted to "
       "recorded forces"},
      {"for", &StandInKeys::stands_for, 0, 0, "", "@name of a secondary", false, "of secondary cloth cords stands_for",
       "The secondary that it stands for; not needed when there is only one"},
      {"on", &StandInKeys::on, 0, 0, "", "@name of a primary", false, "primary",
       "In the place of `for`: the primary that meets it, when what it stands for is not baked here"},
      {"shape", &StandInKeys::shape, 0, 0, "", "box cone mesh", false, "volume geometry", "Of a volume"},
      {"position", &StandInKeys::position, -1e4, 1e4, "m", "", false, "centre center place level location offset",
       "Centre of a box, of a cone's top; added to a mesh; a mat's and a water's level is its y"},
      {"size", &StandInKeys::size, 1e-3, 1000, "m", "", false, "dimensions extents",
       "Box: along x, y, z. Mat: without it without end"},
      {"radius_top", &StandInKeys::radius_top, 0, 100, "m", "", false, "top", "Cone"},
      {"radius_bottom", &StandInKeys::radius_bottom, 0, 100, "m", "", false, "bottom", "Cone"},
      {"height", &StandInKeys::height, 0, 1000, "m", "", false, "depth", "Cone: from its top down"},
      {"mesh", &StandInKeys::mesh, 0, 0, "", "", false, "file path", "Closed OBJ around the volume"},
      {"soft_edge", &StandInKeys::soft_edge, 0, 10, "m", "", false, "edge falloff fade",
       "A volume acts in full from so deep inside on"},
      {"damping", &StandInKeys::damping, 0, 1e6, "N s/m", "", false, "c linear damping_linear",
       "Force per velocity: of the volume, mat or spring"},
      {"damping_quadratic", &StandInKeys::damping_quadratic, 0, 1e6, "N s2/m2", "", false, "c2 quadratic",
       "Force per velocity squared"},
      {"damping_spin", &StandInKeys::damping_spin, 0, 1e6, "N m s", "", false, "rotational angular_damping",
       "Torque per angular velocity"},
      {"stiffness", &StandInKeys::stiffness, 0, 1e9, "N/m", "", false, "k spring_constant", "Of a mat or spring"},
      {"stiffness_cubic", &StandInKeys::stiffness_cubic, 0, 1e12, "N/m3", "", false, "k3 cubic",
       "Of a mat or spring: force per cube of the way"},
      {"damping_ratio", &StandInKeys::damping_ratio, 0, 10, "1", "", false, "zeta",
       "Mat or spring: of the critical damping of the primary's mass on it; in the place of `damping`"},
      {"density", &StandInKeys::density, 1, 20'000, "kg/m3", "", false, "rho", "Water"},
      {"drag", &StandInKeys::drag, 0, 10, "1", "", false, "cd drag_coefficient", "Water: drag coefficient"},
      {"slam", &StandInKeys::slam, 0, 10, "1", "", false, "cs slam_coefficient",
       "Water: slamming coefficient at entry"},
      {"length", &StandInKeys::length, 0, 1e4, "m", "", false, "rest_length", "Spring: it pulls when it is longer"},
      {"anchor", &StandInKeys::anchor, -1e4, 1e4, "m", "", false, "attach end", "Spring: its end in the world"},
      {"mass", &StandInKeys::mass, 0, 1e6, "kg", "", false, "", "Weight: what is carried"},
      {"support", &StandInKeys::support, 0, 0, "", "add replace", false, "mode",
       "`add`: beside the forces that the clip holds; `replace`: instead of those that support it there, as of a "
       "floor"},
      {"gain", &StandInKeys::gain, 0, 1000, "1", "", false, "strength scale factor", "Factor of all its forces"},
      {"from", &StandInKeys::from, 0, 9'999'999, "frame", "", false, "start begin", "Acts from this frame on"},
      {"until", &StandInKeys::until, 0, 9'999'999, "frame", "", false, "end stop last", "Acts up to this frame"},
      {"limit_force", &StandInKeys::limit_force, 0, 1e9, "N", "", false, "max_force limit clamp",
       "Its force is never larger"},
  };
  return keys;
}

}  // namespace ft::inline io
