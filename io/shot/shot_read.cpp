// Reads a shot: tree of values -> structs, by the key table; then what only the whole can tell (who wears what). Faults
// are collected, never stopped at, except for TOML's own syntax: behind a syntax fault nothing can be understood.
#include <algorithm>
#include <cmath>

#include "baker/core/file.h"
#include "io/shot/shot_judge.h"
#include "io/shot/shot_keys.h"
#include "io/shot/shot_maps.h"
#include "io/shot/shot_override.h"
#include "io/shot/shot_values.h"
#include "io/shot/words.h"

namespace ft {
namespace {

constexpr std::uint64_t k_max_shot_bytes = 16 << 20;

/// Of a character and of a prop; judge_couplings says which go together.
std::vector<ShotKey<PrimarySpec>> every_primary_key() {
  std::vector<ShotKey<PrimarySpec>> out(primary_keys().begin(), primary_keys().end());
  out.insert(out.end(), prop_keys().begin(), prop_keys().end());
  out.insert(out.end(), yield_keys().begin(), yield_keys().end());
  return out;
}

class ShotReader {
 public:
  ShotReader(const std::filesystem::path& file, const ShotVocabulary& vocabulary, FaultList& faults)
      : folder_(file.parent_path()), vocabulary_(vocabulary), faults_(faults) {
    shot_.file = file;
  }

  Shot read(const Value& root) {
    for (const Member& member : root.members) {
      const auto section = [&](auto& spec, auto keys) { read_plain(member, spec, keys); };
      if (member.key == "shot")
        section(shot_, shot_keys());
      else if (member.key == "wind")
        section(shot_.wind, wind_keys());
      else if (member.key == "solver")
        section(shot_.solver, solver_keys());
      else if (member.key == "cache")
        section(shot_, cache_keys());
      else if (member.key == "gate")
        section(shot_, gate_keys());
      else if (member.key == "primary")
        read_named(member, shot_.primaries, std::span<const ShotKey<PrimarySpec>>(primary_keys_));
      else if (member.key == "cloth")
        read_named(member, shot_.cloths, cloth_keys());
      else if (member.key == "cords")
        read_named(member, shot_.cords, cords_keys());
      else if (member.key == "standin")
        read_named(member, shot_.standins, standin_keys());
      else
        refuse_section(member);
    }
    judge_whole(root, shot_, faults_);
    return std::move(shot_);
  }

 private:
  void refuse_section(const Member& member) {
    const std::vector<std::string> sections = section_names();
    if (member.value.kind == Value::Kind::k_table || member.value.kind == Value::Kind::k_list) {
      std::string hint = suggestion(member.key, sections);
      if (member.key == "pins" || member.key == "pin") hint = "pins belong under [cloth.NAME]";
      if (member.key == "maps" || member.key == "map") hint = "maps belong under [cloth.NAME]";
      faults_.add(member.place, with_hint("unknown section [" + printable(member.key) + "]", hint));
    } else {
      const std::string home = home_of(member.key);
      faults_.add(member.place,
                  with_hint("key " + in_quotes(member.key) + " stands outside of any section",
                            home.empty() ? suggestion(member.key, sections) : "it belongs under " + home));
    }
  }

  template <class Spec>
  void read_plain(const Member& member, Spec& spec, std::span<const ShotKey<Spec>> keys) {
    if (member.value.kind != Value::Kind::k_table) {
      faults_.add(member.place, "[" + member.key + "] needs to be a section with keys, not " + describe(member.value));
      return;
    }
    read_keys("[" + member.key + "]", member.value, spec, keys);
  }

  /// [primary.NAME], [cloth.NAME], ...
  template <class Spec>
  void read_named(const Member& member, std::vector<Spec>& specs, std::span<const ShotKey<Spec>> keys) {
    const std::string& kind = member.key;
    const std::string form = "write [" + kind + ".NAME], one section for each";
    if (member.value.kind != Value::Kind::k_table) {
      faults_.add(member.place,
                  with_hint("[" + kind + "] needs to be sections with names, not " + describe(member.value), form));
      return;
    }
    for (const Member& named : member.value.members) {
      if (named.value.kind != Value::Kind::k_table) {
        faults_.add(
            named.place,
            with_hint("key " + in_quotes(named.key) + " stands directly in [" + kind + "], which has no name", form));
        continue;
      }
      Spec& spec = specs.emplace_back();
      spec.name = named.key;
      const std::string owner = kind + " " + in_quotes(named.key);
      judge_name(named, owner);
      read_keys(owner, named.value, spec, keys);
    }
  }

  /// Names become file names of caches.
  void judge_name(const Member& named, const std::string& owner) {
    const bool plain =
        !named.key.empty() && named.key.size() <= 100 && named.key.front() != '.' &&
        std::all_of(named.key.begin(), named.key.end(), [](char c) {
          return static_cast<unsigned char>(c) >= 32 && c != 127 && c != '/' && c != '\\' && c != ':' && c != '"';
        });
    if (!plain)
      faults_.add(
          named.place,
          owner + ": the name becomes a file name; it may have up to 100 characters, no / \\ : \" and no dot in front");
  }

  template <class Spec>
  void read_keys(const std::string& owner, const Value& table, Spec& spec, std::span<const ShotKey<Spec>> keys) {
    for (const Member& member : table.members) {
      const auto key = std::find_if(keys.begin(), keys.end(), [&](const auto& k) { return k.name == member.key; });
      const ValueReader reader{faults_, owner, member.key};
      if (key != keys.end()) {
        std::visit([&](auto target) { set(reader, member, *key, spec, target); }, key->target);
        continue;
      }
      if constexpr (std::is_same_v<Spec, ClothSpec>)
        if (read_override(reader, member, spec)) continue;
      refuse_key(owner, member, keys);
    }
    for (const auto& key : keys)
      if (key.required && table.find(key.name) == nullptr)
        faults_.add(table.place,
                    owner + ": " + std::string(key.name) + " is missing (" + std::string(key.meaning) + ")");
  }

  template <class Spec>
  void refuse_key(const std::string& owner, const Member& member, std::span<const ShotKey<Spec>> keys) {
    std::vector<std::string> known;
    std::string other;
    for (const auto& key : keys) {
      known.emplace_back(key.name);
      if (other.empty() && is_synonym(key.also, member.key)) other = std::string(key.name);
    }
    if constexpr (std::is_same_v<Spec, ClothSpec>)
      for (const FabricKeyWord& word : vocabulary_.fabric_keys) known.push_back(word.key);
    std::string hint;
    const std::string home = home_of(member.key);
    const std::string near = nearest_word(member.key, known);
    if (!near.empty() && edit_distance(member.key, near) <= 1)
      hint = suggestion(member.key, known);
    else if (!other.empty())
      hint = "did you mean \"" + other + "\"?";
    else if (!home.empty())
      hint = "it belongs under " + home;
    else
      hint = suggestion(member.key, known);
    faults_.add(member.place, with_hint(owner + ": unknown key " + in_quotes(member.key), hint));
  }

  bool read_override(const ValueReader& reader, const Member& member, ClothSpec& cloth) {
    for (const FabricKeyWord& word : vocabulary_.fabric_keys) {
      if (word.key != member.key) continue;
      const bool ranged = std::isfinite(word.lowest) && std::isfinite(word.highest);
      const auto value = reader.number(member.value, {ranged ? word.lowest : 0, ranged ? word.highest : 0, word.unit});
      if (value) cloth.fabric_overrides.emplace_back(word.key, *value);
      return true;
    }
    return false;
  }

  // One function for each kind of target in the key table.

  template <class Spec>
  static Allowed allowed(const ShotKey<Spec>& key, bool whole = false) {
    return {key.lowest, key.highest, key.unit, whole};
  }

  template <class Spec>
  void set(const ValueReader& reader, const Member& member, const ShotKey<Spec>& key, Spec& spec, int Spec::*target) {
    if (const auto value = reader.number(member.value, allowed(key, true))) spec.*target = static_cast<int>(*value);
  }
  template <class Spec>
  void set(const ValueReader& reader, const Member& member, const ShotKey<Spec>& key, Spec& spec,
           double Spec::*target) {
    if (const auto value = reader.number(member.value, allowed(key))) spec.*target = *value;
  }
  template <class Spec>
  void set(const ValueReader& reader, const Member& member, const ShotKey<Spec>& key, Spec& spec,
           std::optional<double> Spec::*target) {
    if (const auto value = reader.number(member.value, allowed(key))) spec.*target = *value;
  }
  template <class Spec>
  void set(const ValueReader& reader, const Member& member, const ShotKey<Spec>&, Spec& spec, bool Spec::*target) {
    if (const auto value = reader.flag(member.value)) spec.*target = *value;
  }
  template <class Spec>
  void set(const ValueReader& reader, const Member& member, const ShotKey<Spec>& key, Spec& spec, Vec3 Spec::*target) {
    if (const auto value = reader.vector(member.value, allowed(key))) spec.*target = *value;
  }
  template <class Spec>
  void set(const ValueReader& reader, const Member& member, const ShotKey<Spec>&, Spec& spec,
           std::filesystem::path Spec::*target) {
    if (auto value = reader.file(member.value, folder_)) spec.*target = std::move(*value);
  }
  template <class Spec>
  void set(const ValueReader& reader, const Member& member, const ShotKey<Spec>& key, Spec& spec,
           std::string Spec::*target) {
    const auto value = reader.text(member.value);
    if (!value) return;
    if (key.choices == "@fabrics" && !reader.is_one_of(member.value, *value, vocabulary_.fabrics)) return;
    const bool closed = !key.choices.empty() && key.choices.front() != '@';
    if (closed && !reader.is_one_of(member.value, *value, split_words(key.choices))) return;
    spec.*target = *value;
  }
  template <class Spec>
  void set(const ValueReader& reader, const Member& member, const ShotKey<Spec>& key, Spec& spec,
           std::vector<std::string> Spec::*target) {
    const auto value = reader.texts(member.value);
    if (!value) return;
    bool good = true;
    if (key.choices == "@formats")
      for (std::size_t i = 0; i < value->size(); ++i) {
        const Value& item = member.value.kind == Value::Kind::k_list ? member.value.items[i] : member.value;
        good = reader.is_one_of(item, (*value)[i], vocabulary_.cache_formats) && good;
      }
    if (key.choices == "@formats" && value->empty())
      reader.fault(member.value, "is empty: nothing would be written"), good = false;
    if (good) spec.*target = *value;
  }
  template <class Spec>
  void set(const ValueReader& reader, const Member& member, const ShotKey<Spec>&, Spec& spec, FramesKey) {
    if constexpr (std::is_same_v<Spec, Shot>) {
      const auto range = read_frames(reader, member.value);
      if (range) spec.first_frame = range->first, spec.last_frame = range->last;
    } else {
      CHECK(false);
    }
  }
  template <class Spec>
  void set(const ValueReader& reader, const Member& member, const ShotKey<Spec>&, Spec& spec, SinglePinKey) {
    if constexpr (std::is_same_v<Spec, ClothSpec>)
      read_pin(reader.owner + ", pin", member.value, spec);
    else
      CHECK(false);
  }
  template <class Spec>
  void set(const ValueReader& reader, const Member& member, const ShotKey<Spec>&, Spec& spec, PinsKey) {
    const Value& value = member.value;
    if constexpr (std::is_same_v<Spec, ClothSpec>) {
      if (value.kind != Value::Kind::k_list) return read_pin(reader.owner + ", pins", value, spec);
      for (std::size_t i = 0; i < value.items.size(); ++i)
        read_pin(reader.owner + ", pin " + std::to_string(i + 1), value.items[i], spec);
    } else if constexpr (std::is_same_v<Spec, PinSpec>) {
      read_vertices(reader, value, spec.vertices);
    } else {
      CHECK(false);
    }
  }

  template <class Spec>
  void set(const ValueReader& reader, const Member& member, const ShotKey<Spec>& key, Spec& spec, TeleportsKey) {
    if constexpr (std::is_same_v<Spec, PrimarySpec>)
      read_teleports(reader, member.value, allowed(key, true), spec);
    else
      CHECK(false);
  }

  template <class Spec>
  void set(const ValueReader& reader, const Member& member, const ShotKey<Spec>& key, Spec& spec, ReleaseKey) {
    if constexpr (std::is_same_v<Spec, PrimarySpec>)
      read_release(reader, member.value, allowed(key), spec);
    else
      CHECK(false);
  }

  template <class Spec>
  void set(const ValueReader& reader, const Member& member, const ShotKey<Spec>&, Spec& spec, MapsKey) {
    if constexpr (std::is_same_v<Spec, ClothSpec>) {
      const Value& value = member.value;
      const bool list = value.kind == Value::Kind::k_list;
      int number = 0;
      for (const Value& item : list ? std::span(value.items) : std::span(&value, 1))
        read_map(reader.owner + (list ? ", map " + std::to_string(++number) : ", maps"), item, spec);
      judge_maps(reader.owner, value, spec.maps, faults_);
    } else {
      CHECK(false);
    }
  }

  void read_map(const std::string& owner, const Value& value, ClothSpec& cloth) {
    MapSpec& map = cloth.maps.emplace_back();
    if (value.kind != Value::Kind::k_table) {
      faults_.add(value.place,
                  owner + " needs a table like { of = \"thickness\", from = \"red\", low = 1e-3, high = 4e-3 }, not " +
                      describe(value));
      return;
    }
    read_keys(owner, value, map, map_keys());
    judge_map(owner, value, map, faults_);
  }

  void read_pin(const std::string& owner, const Value& value, ClothSpec& cloth) {
    PinSpec pin;
    if (value.kind == Value::Kind::k_text) {
      pin.group = value.text;
      if (pin.group.empty()) faults_.add(value.place, owner + ": the name of a vertex group is empty");
      cloth.pins.push_back(std::move(pin));
      return;
    }
    if (value.kind != Value::Kind::k_table) {
      faults_.add(value.place,
                  owner + " needs a table like { group = \"waist\" } or { within = 0.02 }, not " + describe(value));
      return;
    }
    read_keys(owner, value, pin, pin_keys());
    const bool group = value.find("group") != nullptr, within = value.find("within") != nullptr,
               vertices = value.find("vertices") != nullptr, file = value.find("file") != nullptr;
    const int selections = group + within + vertices + file;
    if (selections != 1)
      faults_.add(value.place, owner + ": needs one of group, within, vertices, file, and has " +
                                   (selections == 0 ? "none" : std::to_string(selections)) +
                                   " (several pins are written as several { } in the list)");
    if (group && pin.group.empty()) faults_.add(value.place, owner + ": the name of a vertex group is empty");
    judge_column(owner, value, faults_);
    judge_hold(owner, value, pin, faults_);
    pin.select = within     ? PinSpec::Select::k_within
                 : vertices ? PinSpec::Select::k_vertices
                 : file     ? PinSpec::Select::k_file
                            : PinSpec::Select::k_group;
    cloth.pins.push_back(std::move(pin));
  }

  const std::vector<ShotKey<PrimarySpec>> primary_keys_ = every_primary_key();
  std::filesystem::path folder_;
  const ShotVocabulary& vocabulary_;
  FaultList& faults_;
  Shot shot_;
};

Error error_of(const FaultList& list, const ShotFaults& faults, std::string_view file) {
  auto [what, where] = list.first(file);
  std::string hint;
  if (faults.messages.size() > 1) {
    const std::size_t more = faults.messages.size() - 1;
    hint = std::string("and ").append(std::to_string(more)).append(more == 1 ? " more fault" : " more faults");
  }
  return {list.only_missing_files() ? ErrorKind::k_input : ErrorKind::k_usage, std::move(what), std::move(where),
          std::move(hint)};
}

}  // namespace

Result<Shot> parse_shot(std::string_view text, const std::filesystem::path& file, const ShotVocabulary& vocabulary,
                        const std::vector<std::string>& overrides, ShotFaults& faults) {
  FaultList list;
  Value root;
  ParseFault syntax;
  Shot shot;
  if (!parse_tree(text, root, syntax)) {
    list.add(syntax.place, syntax.message);
  } else {
    for (const std::string& text_override : overrides) apply_override(root, text_override, list);
    shot = ShotReader(file, vocabulary, list).read(root);
  }
  faults.messages = list.texts(file.string());
  if (!list.empty()) return error_of(list, faults, file.string());
  return shot;
}

Result<Shot> read_shot(const std::filesystem::path& file, const ShotVocabulary& vocabulary,
                       const std::vector<std::string>& overrides, ShotFaults& faults) {
  faults.messages.clear();
  auto text = read_text(file, k_max_shot_bytes);
  if (!text) {
    Error error = text.error();
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) error.hint = similar_file(file);
    faults.messages.push_back(error.text());
    return error;
  }
  return parse_shot(*text, file, vocabulary, overrides, faults);
}

}  // namespace ft
