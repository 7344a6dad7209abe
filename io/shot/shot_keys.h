// Tables of all keys of the shot file: name, type (by the member it fills), range, unit, meaning. Reading, messages,
// --set, the settings list and the printed reference walk over them. To add a key: a member of the spec and a row.
#pragma once

#include <span>
#include <string_view>
#include <variant>

#include "io/shot/shot.h"
#include "io/shot/shot_values.h"

namespace ft::inline io {

class KeyReader;

/// A key with a grammar of its own, such as frames, pins and maps.
template <class Spec>
struct OwnGrammar {
  std::string_view type;  ///< for the reference: "list of pins"
  void (*read)(const KeyReader& keys, const ValueReader& reader, const Value& value, const Allowed& allowed,
               Spec& spec);
  /// Empty where the key only repeats another, or adds nothing.
  std::string (*text)(const Spec& spec, const std::filesystem::path& folder);
};

template <class Spec>
struct ShotKey {
  using Target =
      std::variant<int Spec::*, double Spec::*, bool Spec::*, std::string Spec::*, std::filesystem::path Spec::*,
                   std::optional<double> Spec::*, Vec3 Spec::*, std::vector<std::string> Spec::*, OwnGrammar<Spec>>;
  std::string_view name;
  Target target;
  double lowest = 0, highest = 0;  ///< of numbers, and of every component of vectors; both 0: no range
  std::string_view unit;
  std::string_view choices;  ///< "y z": the words allowed; "@fabrics": a list of the vocabulary, or what it is called
  bool required = false;
  std::string_view also;  ///< other words people write for it: "material cloth_type"
  std::string_view meaning;
};

std::span<const ShotKey<Shot>> shot_keys();            ///< [shot]
std::span<const ShotKey<PrimarySpec>> primary_keys();  ///< [primary.NAME]
std::span<const ShotKey<PrimarySpec>> prop_keys();     ///< [primary.NAME] that is a rigid prop
std::span<const ShotKey<PrimarySpec>> yield_keys();    ///< [primary.NAME] that meets stand-ins
std::span<const ShotKey<StandInKeys>> standin_keys();  ///< [standin.NAME]
std::span<const ShotKey<WindSpec>> wind_keys();        ///< [wind]
std::span<const ShotKey<WindKeys>> wind_field_keys();  ///< [wind.NAME]
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

/// Words of a space-separated list of the table.
std::vector<std::string> split_words(std::string_view words);

/// shot, primary, cloth, ...
std::vector<std::string> section_names(const ShotVocabulary& vocabulary);

/// Whether sections of that name have names of their own: [cloth.NAME].
bool is_named_section(const ShotVocabulary& vocabulary, std::string_view section);

/// The section in which a key of that name is at home, "[shot]"; empty when none.
std::string home_of(const ShotVocabulary& vocabulary, std::string_view key);

/// True when `word` is one of the other words for a key.
bool is_synonym(std::string_view also, std::string_view word);

}  // namespace ft::inline io
