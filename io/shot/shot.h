// The shot file: what to bake, as plain structs with good defaults. shot_read.cpp reads it from TOML and reports every
// fault at once, with line and column, the allowed range and what was probably meant. The keys, their ranges and units
// stand once, in shot_keys*.cpp and in the folders of the kinds of secondaries; reading, messages, --set, the settings
// list and the reference all come from that table.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "baker/core/result.h"
#include "baker/core/types.h"
#include "io/shot/secondary.h"

namespace ft::inline io {

/// What is done about a primary that jumps to another place between two frames.
enum class Teleports { k_detect, k_ignore, k_frames };

/// When a prop begins to move by itself.
enum class Release { k_start, k_frame, k_contact };

inline constexpr std::string_view k_ground = "ground";  ///< PrimarySpec::shape

/// [primary.NAME]: what drives: a character or cache from a file, or a prop of a plain shape.
struct PrimarySpec {
  std::string name;
  std::filesystem::path file;  ///< character (FBX, glTF/GLB, DAE, BVH, ...) or geometry cache (PC2; MDD, OBJ sequence)
  std::filesystem::path
      animation;  ///< second file with the motion for the skeleton in `file`, matched by node name; may be empty
  std::filesystem::path
      topology;           ///< geometry caches without faces (PC2): the OBJ with the same vertices; may be empty
  std::string clip;       ///< name of the clip; empty: the only one, or the first with a note
  double clip_start = 0;  ///< s into the clip at the shot's first frame
  std::optional<double> clip_bind;   ///< no key: what clip_start is of the whole shot, where only a part of it is baked
  double speed = 1;                  ///< playback speed [1], 0.01..100
  int repeat = 1;                    ///< how often the clip is played in a row, each from where the last has got to
  bool loop = false;                 ///< the clip repeats as long as the shot lasts, carried on from cycle to cycle
  std::optional<double> unit_scale;  ///< m per file unit, overrides what the file says
  std::string up;                    ///< "y", "z", "" = as the file says
  std::optional<double> source_fps;  ///< geometry caches: frames per second of the samples; default the shot's fps
  std::string body;                  ///< BVH: "blended" (default) or "capsules"
  std::string bind;                  ///< "t_pose": garments are modelled on one; empty: on the file's bind pose
  std::optional<double> height;      ///< BVH and others: scale so that the bind pose is this tall [m]
  std::optional<double> mass;        ///< kg; without it from the body's volume
  std::vector<std::string> meshes;   ///< names of the meshes that make the collider; empty: all
  std::string surface;  ///< geometry caches: "solid", "sheet"; empty: as its mesh says (io/import/motion/sheet.h)
  std::vector<std::string> ignore;  ///< patterns (* and ?) of parts that no cloth meets
  Teleports teleports = Teleports::k_detect;
  std::vector<int> teleport_frames;  ///< k_frames: first frames at a new place, ascending
  std::string shape;                 ///< "sphere", "box", "capsule", "ground" instead of `file`; empty: from the file
  std::optional<double> radius;      ///< sphere, capsule [m]
  Vec3 size = Vec3::Zero();          ///< box [m]
  std::optional<double> length;      ///< capsule: between the centres of its ends, along y [m]
  Vec3 position = Vec3::Zero();      ///< of a shape's centre at the first frame [m]
  Vec3 rotation_deg = Vec3::Zero();  ///< of a shape at the first frame: about x, then y, then z of the world
  Vec3 velocity = Vec3::Zero();      ///< of a shape, constant until it is released [m/s]
  Vec3 spin = Vec3::Zero();          ///< of a shape, world axes, constant until it is released [rad/s]
  bool hollow = false;               ///< its mass lies in its surface
  Vec3 inertia = Vec3::Zero();       ///< principal moments about its centre [kg m2]; zero: from shape and mass
  Release release = Release::k_start;
  double release_frame = 0;       ///< k_frame: from here on only forces move it
  std::string limbs = "rigid";    ///< of a character that yields: "rigid", or "planted": feet on the ground stay there
  std::string comeback = "free";  ///< to its animation: "free", "spring", "window", "hold"
  double comeback_frequency = 1;  ///< of the spring that brings it back [Hz]
  double comeback_damping_ratio = 1;       ///< its damping
  double comeback_window = 0.5;            ///< in which the spring grows after the last touch [s]
  std::optional<double> max_displacement;  ///< from its animation [m]
  std::optional<double> max_acceleration;  ///< by the stand-ins together [m/s2]
  bool blocks_wind = false;                ///< what is behind it is in its lee
};

/// [standin.NAME]: what a primary meets in the place of a hybrid secondary. Members have the names of their keys.
struct StandInKeys {
  std::string name;
  std::string kind;                          ///< "damping", "mat", "water", "spring", "weight", "fitted"
  std::string stands_for;                    ///< key `for`: name of the secondary; empty: of none, see on
  std::string on;                            ///< name of the primary, where no secondary is there to be baked
  std::string shape;                         ///< of a volume: "box", "cone", "mesh"
  Vec3 position = Vec3::Zero();              ///< m: centre of a box, of a cone's top; offset of a mesh; level
  Vec3 size = Vec3::Zero();                  ///< box [m]
  double radius_top = 0, radius_bottom = 0;  ///< cone [m]
  double height = 0;                         ///< cone, from its top down [m]
  std::filesystem::path mesh;                ///< closed OBJ
  double soft_edge = 0;                      ///< m inwards from its surface until it acts in full
  double damping = 0;                        ///< force per velocity [N s/m]
  double damping_quadratic = 0;              ///< force per velocity squared [N s2/m2]
  double damping_spin = 0;                   ///< torque per angular velocity [N m s]
  double stiffness = 0;                      ///< N/m
  double stiffness_cubic = 0;                ///< N/m3
  std::optional<double> damping_ratio;       ///< of the critical damping of the primary's mass on it
  double density = 1000;                     ///< water [kg/m3]
  double drag = 1;                           ///< water: drag coefficient
  double slam = 0;                           ///< water: slamming coefficient at entry
  double length = 0;                         ///< spring: it pulls when it is longer [m]
  Vec3 anchor = Vec3::Zero();                ///< spring: its end in the world [m]
  double mass = 0;                           ///< weight that is carried [kg]
  std::string support = "add";               ///< "add": beside what the clip holds; "replace": instead of it
  double gain = 1;                           ///< of all its forces
  std::optional<double> from, until;         ///< frames at which it begins and ends to act
  std::optional<double> limit_force;         ///< N
};

/// [wind]: the same everywhere and for ever, beside the fields.
struct WindSpec {
  Vec3 velocity = Vec3::Zero();  ///< m/s, world
};

/// [wind.NAME]: a field of moving air. Members have the names of their keys.
struct WindKeys {
  std::string name;
  std::string kind;              ///< "uniform", "source", "sink", "vortex", "doublet", "turbulence", "grid", "wake"
  Vec3 velocity = Vec3::Zero();  ///< m/s
  double gusts = 0;              ///< root mean square of a uniform wind's changes, by its speed
  double gust_time = 3;          ///< s
  std::optional<double> roughness_length;  ///< of the ground under a uniform wind, z0 [m]; none: as fast at all heights
  double reference_height = 10;            ///< above the ground, where a uniform wind has its velocity [m]
  double ground = 0;                       ///< height of that ground [m]
  Vec3 position = Vec3::Zero();            ///< m
  Vec3 axis = Vec3::UnitY();               ///< of a vortex
  double flow = 0;                         ///< of a source or sink [m3/s]
  double circulation = 0;                  ///< of a vortex [m2/s]
  double radius = 0.1;                     ///< m
  double intensity = 0;                    ///< of turbulence, root mean square of each component [m/s]
  double length = 1;                       ///< of its larger eddies [m]
  int seed = 1;                            ///< of gusts and turbulence
  std::filesystem::path file;              ///< of a grid: OpenVDB, or many with #### in the place of the frame
  std::string grid;                        ///< name of the velocities in it; empty: the one that is there
  double unit_scale = 1;                   ///< of a grid: m per file unit
  std::string up = "y";                    ///< of a grid
  std::string of;                          ///< of a wake: name of the primary
  std::vector<std::string> parts;          ///< of a wake: patterns (* and ?) of its parts; empty: all
  std::optional<double> drag_area;         ///< of a wake: C_d A [m2]
  double turbulence = 0.4;                 ///< of a wake, root mean square by its mean velocity
  double gain = 1;                         ///< of its velocity
  std::optional<double> from, until;       ///< frames at which it begins and ends to blow
  double fade = 0;                         ///< frames
};

struct SolverSpec {
  int min_substeps = 3, max_substeps = 32;  ///< a frame
  int newton_iterations = 3;
  double linear_tolerance = 1e-2;
  std::string integrator = "bdf2";  ///< "bdf2" or "euler"
  double gap = 6e-3;                ///< room kept between body parts [m]
  bool carve = true;
  Vec3 gravity = Vec3(0, -k_gravity, 0);  ///< m/s2
};

using Secondaries = std::vector<std::shared_ptr<SecondarySpec>>;

struct Shot {
  std::filesystem::path file;  ///< the shot file; other paths are resolved against its folder
  int first_frame = 1, last_frame = 1;
  double fps = 24;
  int preroll = 24;            ///< frames before the first
  bool preroll_given = false;  ///< whether the shot file says it; else it may become longer (make_plan)
  bool write_preroll = false;
  std::string quality = "final";  ///< "final" or "preview"
  std::vector<PrimarySpec> primaries;
  Secondaries secondaries;  ///< by kind, then in the order of the file
  std::vector<StandInKeys> standins;
  WindSpec wind;
  std::vector<WindKeys> winds;
  SolverSpec solver;
  std::vector<std::string> cache_formats = {"abc", "pc2"};
  bool cache_collider = true;   ///< the feasible collider, beside the cloth
  bool cache_volumes = false;   ///< the water as OpenVDB, when all else is baked
  double gate_p99_strain = 0;   ///< quality gate: exit code 4 above it; 0 off
  bool gate_crossings = false;  ///< exit code 4 when any frame has crossings
  /// Exit code 4 when a metric of any frame is above its limit.
  std::vector<std::pair<std::string, double>> gate_most;
  std::vector<std::string> notes;  ///< what is allowed and may be a mistake: a stand-in that is not used
};

/// What the shot file may name; the conductor fills it from the registries above this floor.
struct ShotVocabulary {
  std::vector<const SecondarySection*> sections;  ///< kinds of secondaries, in the order of the reference
  /// Words that keys allow by "@fabrics", "@formats"; a list that is not there is not checked.
  std::map<std::string, std::vector<std::string>, std::less<>> lists;
};

/// All faults of one shot file in the order of the file; the first is also what Result carries.
struct ShotFaults {
  std::vector<std::string> messages;  ///< "shot.toml:14:7: cloth "cape": ..."
};

/// overrides: "cloth.dress.fabric=denim" as given by --set; values are TOML or bare words, paths are the shot file's.
/// Error kind: k_input when nothing but missing files is wrong, k_usage otherwise.
Result<Shot> read_shot(const std::filesystem::path& file, const ShotVocabulary& vocabulary,
                       const std::vector<std::string>& overrides, ShotFaults& faults);

/// The same from text; paths are resolved against the folder of `file`, which need not exist.
Result<Shot> parse_shot(std::string_view text, const std::filesystem::path& file, const ShotVocabulary& vocabulary,
                        const std::vector<std::string>& overrides, ShotFaults& faults);

/// Every setting as (key path, value text), in the order of the file's sections: ("cloth.skirt.fabric", "\"denim\"").
/// Paths are relative to the shot file's folder, so that a moved project is the same shot.
Settings settings(const Shot& shot);

/// settings() as lines "key = value": changes exactly when a value changes. For hashing.
std::string canonical(const Shot& shot);

/// What differs between two lists of settings, for "stale because ...": "cloth.skirt.fabric changed from \"cotton\" to
/// \"denim\"".
std::vector<std::string> changed_settings(const Settings& before, const Settings& now);

/// The keys of the shot file as Markdown tables, from the table that the reader uses.
std::string shot_file_reference(const ShotVocabulary& vocabulary);

}  // namespace ft::inline io
