// One table of all keys of the shot file: name, type (by the member it fills), range, unit, meaning. Reading, messages,
// --set, the settings list and the printed reference walk over it. To add a key: a member in shot.h and a line in
// shot_keys.cpp.
#pragma once

#include <span>
#include <string_view>
#include <variant>

#include "io/shot/shot.h"

namespace ft {

/// Types without a plain member: frames, teleports and release fill two, pins and maps have grammars of their own.
struct FramesKey {};
struct PinsKey {};
struct SinglePinKey {};
struct MapsKey {};
struct TeleportsKey {};
struct ReleaseKey {};

template <class Spec>
struct ShotKey {
  using Target =
      std::variant<int Spec::*, double Spec::*, bool Spec::*, std::string Spec::*, std::filesystem::path Spec::*,
                   std::optional<double> Spec::*, Vec3 Spec::*, std::vector<std::string> Spec::*, FramesKey, PinsKey,
                   SinglePinKey, MapsKey, TeleportsKey, ReleaseKey>;
  std::string_view name;
  Target target;
  double lowest = 0, highest = 0;  ///< of numbers, and of every component of vectors; both 0: no range
  std::string_view unit;
  std::string_view choices;  ///< "y z": the words allowed; "@fabrics", "@formats", "@primaries", "@cloths",
                             ///< "@secondaries": a list known later
  bool required = false;
  std::string_view also;  ///< other words people write for it: "material cloth_type"
  std::string_view meaning;
};

std::span<const ShotKey<Shot>> shot_keys();            ///< [shot]
std::span<const ShotKey<PrimarySpec>> primary_keys();  ///< [primary.NAME]
std::span<const ShotKey<PrimarySpec>> prop_keys();     ///< [primary.NAME] that is a rigid prop
std::span<const ShotKey<PrimarySpec>> yield_keys();    ///< [primary.NAME] that meets stand-ins
std::span<const ShotKey<ClothSpec>> cloth_keys();      ///< [cloth.NAME], beside the fabric's keys
std::span<const ShotKey<CordsSpec>> cords_keys();      ///< [cords.NAME]
std::span<const ShotKey<StandInKeys>> standin_keys();  ///< [standin.NAME]
std::span<const ShotKey<PinSpec>> pin_keys();          ///< one table of pins; group, within, vertices, file choose
std::span<const ShotKey<MapSpec>> map_keys();          ///< one table of maps; from, file choose
std::span<const ShotKey<WindSpec>> wind_keys();        ///< [wind]
std::span<const ShotKey<SolverSpec>> solver_keys();    ///< [solver]
std::span<const ShotKey<Shot>> cache_keys();           ///< [cache]
std::span<const ShotKey<Shot>> gate_keys();            ///< [gate]

/// Calls visit(section name, keys) for the sections without a NAME, in the order of the reference.
template <class Visit>
void for_each_plain_section(Visit&& visit) {
  visit("shot", shot_keys());
  visit("wind", wind_keys());
  visit("solver", solver_keys());
  visit("cache", cache_keys());
  visit("gate", gate_keys());
}

/// Calls visit(section name, keys) for the sections with a NAME.
template <class Visit>
void for_each_named_section(Visit&& visit) {
  visit("primary", primary_keys());
  visit("primary", prop_keys());
  visit("primary", yield_keys());
  visit("cloth", cloth_keys());
  visit("cords", cords_keys());
  visit("standin", standin_keys());
}

/// Words of a space-separated list of the table.
std::vector<std::string> split_words(std::string_view words);

/// shot, primary, cloth, ...
std::vector<std::string> section_names();

/// Whether sections of that name have names of their own: [cloth.NAME].
bool is_named_section(std::string_view section);

/// The section in which a key of that name is at home, "[shot]"; empty when none.
std::string home_of(std::string_view key);

/// True when `word` is one of the other words for a key.
bool is_synonym(std::string_view also, std::string_view word);

}  // namespace ft
