#include "io/shot/shot_keys.h"

namespace ft::inline io {

std::span<const ShotKey<WindSpec>> wind_keys() {
  static const ShotKey<WindSpec> keys[] = {
      {"velocity", &WindSpec::velocity, -100, 100, "m/s", "", false, "speed direction",
       "Steady wind, world axes, y up; fields of [wind.NAME] are added to it"},
  };
  return keys;
}

std::span<const ShotKey<WindKeys>> wind_field_keys() {
  static const ShotKey<WindKeys> keys[] = {
      {"kind", &WindKeys::kind, 0, 0, "", "uniform source sink vortex doublet turbulence grid wake", true, "type model",
       "`uniform`: the same everywhere, with gusts; `source`, `sink`, `vortex`; `doublet`: the air about a sphere that "
       "moves; `turbulence`: eddies without divergence; `grid`: velocities from an OpenVDB file; `wake`: what a "
       "primary does to the air as it moves"},
      {"velocity", &WindKeys::velocity, -100, 100, "m/s", "", false, "speed direction",
       "Of a uniform wind, world axes, y up; of a doublet's sphere; with which turbulence drifts"},
      {"gusts", &WindKeys::gusts, 0, 2, "1", "", false, "gustiness variation",
       "Uniform: root mean square of its changes, by its speed; 0.2 is a fresh breeze over a town"},
      {"gust_time", &WindKeys::gust_time, 0.1, 1000, "s", "", false, "gust_length period",
       "Uniform: how long a gust lasts, about"},
      {"roughness_length", &WindKeys::roughness_length, 1e-5, 10, "m", "", false, "roughness z0",
       "Uniform: the wind is slower near the ground, by the logarithmic law; 0.0002 open water, 0.01 short grass, 0.03 "
       "a field, 0.1 scattered bushes, 0.5 a suburb. Without it the wind is as fast at the ground as above"},
      {"reference_height", &WindKeys::reference_height, 0.05, 1000, "m", "", false, "height",
       "Uniform with a `roughness_length`: how far above the ground it has its velocity; weather reports say 10"},
      {"ground", &WindKeys::ground, -1e4, 1e4, "m", "", false, "floor level",
       "Uniform with a `roughness_length`: height of the ground"},
      {"position", &WindKeys::position, -1e4, 1e4, "m", "", false, "centre center place location offset",
       "Centre of source, sink, vortex and doublet; added to a grid"},
      {"axis", &WindKeys::axis, -1e4, 1e4, "", "", false, "about", "Vortex: about which it turns, right-handed"},
      {"flow", &WindKeys::flow, 0, 1e6, "m3/s", "", false, "strength rate", "Source, sink: air that comes or goes"},
      {"circulation", &WindKeys::circulation, -1e6, 1e6, "m2/s", "", false, "strength gamma",
       "Vortex: 2 pi times the distance times the speed there"},
      {"radius", &WindKeys::radius, 1e-3, 1e4, "m", "", false, "core size",
       "Core of source, sink and vortex; of a doublet's sphere"},
      {"intensity", &WindKeys::intensity, 0, 100, "m/s", "", false, "strength amplitude rms",
       "Turbulence: root mean square of each component"},
      {"length", &WindKeys::length, 0.01, 1e4, "m", "", false, "size scale eddy_size",
       "Turbulence: size of its larger eddies"},
      {"seed", &WindKeys::seed, 0, 2'147'483'647, "", "", false, "random", "Of gusts and turbulence"},
      {"file", &WindKeys::file, 0, 0, "", "", false, "path vdb",
       "Grid: OpenVDB; with `####` in the place of the frame's number, one for each frame"},
      {"grid", &WindKeys::grid, 0, 0, "", "", false, "name field",
       "Grid: name of the velocities in the file; not needed when there are no others"},
      {"unit_scale", &WindKeys::unit_scale, 1e-6, 1000, "m per file unit", "", false, "scale", "Grid"},
      {"up", &WindKeys::up, 0, 0, "", "y z", false, "up_axis", "Grid: up axis of the file"},
      {"of", &WindKeys::of, 0, 0, "", "@name of a primary", false, "on primary body",
       "Wake: whose; not needed when there is only one primary"},
      {"parts", &WindKeys::parts, 0, 0, "", "", false, "bones part",
       "Wake: which of its parts, names with `*` and `?`; without it all"},
      {"drag_area", &WindKeys::drag_area, 1e-6, 1e4, "m2", "", false, "cda area",
       "Wake: drag coefficient times area of all parts together, a standing man 0.6; without it from their surfaces"},
      {"turbulence", &WindKeys::turbulence, 0, 5, "1", "", false, "",
       "Wake: root mean square of its eddies, by its mean velocity"},
      {"gain", &WindKeys::gain, 0, 100, "1", "", false, "scale factor", "Factor of its velocity"},
      {"from", &WindKeys::from, 0, 9'999'999, "frame", "", false, "start begin", "Blows from this frame on"},
      {"until", &WindKeys::until, 0, 9'999'999, "frame", "", false, "end stop last", "Blows up to this frame"},
      {"fade", &WindKeys::fade, 0, 100'000, "frames", "", false, "ramp",
       "It takes so long to grow after `from` and to die down after `until`; 0 is at once"},
  };
  return keys;
}

}  // namespace ft::inline io
