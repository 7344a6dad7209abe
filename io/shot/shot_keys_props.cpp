// Keys of rigid props.
#include "io/shot/key_text.h"
#include "io/shot/shot_judge.h"
#include "io/shot/words.h"

namespace ft::inline io {
namespace {

void read_release_key(const KeyReader&, const ValueReader& reader, const Value& value, const Allowed& allowed,
                      PrimarySpec& spec) {
  read_release(reader, value, allowed, spec);
}
std::string release_key_text(const PrimarySpec& spec, const std::filesystem::path&) {
  if (spec.release == Release::k_contact) return toml_text("contact");
  return spec.release == Release::k_frame ? number_text(spec.release_frame) : "none";
}

}  // namespace

std::span<const ShotKey<PrimarySpec>> prop_keys() {
  static const ShotKey<PrimarySpec> keys[] = {
      {"shape", &PrimarySpec::shape, 0, 0, "", "sphere box capsule ground", false, "primitive type geometry",
       "A rigid prop of a plain shape, in the place of `file`; `ground`: a level floor that stands still"},
      {"radius", &PrimarySpec::radius, 1e-3, 100, "m", "", false, "r diameter", "Sphere, capsule"},
      {"size", &PrimarySpec::size, 1e-3, 1000, "m", "", false, "dimensions extents width", "Box: along x, y, z"},
      {"length", &PrimarySpec::length, 1e-3, 1000, "m", "", false, "height",
       "Capsule: between the centres of its round ends, along y"},
      {"position", &PrimarySpec::position, -1e4, 1e4, "m", "", false, "centre center place location translate",
       "A shape's centre at the shot's first frame, of a ground a point of its upper side; a character or cache is "
       "moved by it. y up"},
      {"rotation", &PrimarySpec::rotation_deg, -3600, 3600, "degrees", "", false, "orientation angles rotate",
       "A shape at the first frame, or all of a character or cache about the origin: turned about x, then y, then z of "
       "the world"},
      {"velocity", &PrimarySpec::velocity, -1000, 1000, "m/s", "", false, "speed_vector throw",
       "Of a shape's centre; it keeps it until it is released"},
      {"spin", &PrimarySpec::spin, -10'000, 10'000, "rad/s", "", false, "angular_velocity omega",
       "Angular velocity of a shape, world axes; it keeps it until it is released"},
      {"hollow", &PrimarySpec::hollow, 0, 0, "", "", false, "shell",
       "A shape's mass lies in its surface, as a ball's does; without it all through"},
      {"inertia", &PrimarySpec::inertia, 0, 1e6, "kg m2", "", false, "moment_of_inertia moments",
       "Principal moments about the centre of mass; without it from shape and `mass`"},
      {"release", OwnGrammar<PrimarySpec>{"frame or text", read_release_key, release_key_text}, 0, 9'999'999, "frame",
       "", false, "release_frame free from start",
       "From when on only forces move it: a frame, or `\"contact\"`, the first with a secondary; without it the first "
       "frame"},
  };
  return keys;
}

}  // namespace ft::inline io
