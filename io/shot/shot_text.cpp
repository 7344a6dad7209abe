// A shot as text: the settings list (for hashing, and to say what changed) and the printed reference. Both walk the key
// table.
#include <algorithm>
#include <map>

#include "io/shot/ranges.h"
#include "io/shot/shot_keys.h"
#include "io/shot/shot_maps.h"
#include "io/shot/words.h"

namespace ft {
namespace {

/// TOML's basic string: what differs in the shot differs in the text.
std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out.append(1, '\\').append(1, c);
    else if (c == '\n')
      out.append("\\n");
    else if (c == '\t')
      out.append("\\t");
    else if (c == '\r')
      out.append("\\r");
    else
      out.append(1, c);
  }
  return out.append("\"");
}

std::string key_word(std::string_view name) {
  const bool bare = !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  return bare ? std::string(name) : in_quotes(name);
}

std::string list_text(const std::vector<std::string>& words) {
  std::string out = "[";
  for (const std::string& word : words) out.append(out.size() > 1 ? ", " : "").append(in_quotes(word));
  return out.append("]");
}

std::string vector_text(const Vec3& v) {
  std::string out = "[";
  for (int k = 0; k < 3; ++k) out.append(k > 0 ? ", " : "").append(number_text(v[k]));
  return out.append("]");
}

std::string relative_text(const std::filesystem::path& path, const std::filesystem::path& folder) {
  if (path.empty()) return in_quotes("");
  std::error_code ignored;  // without a current folder, absolute() gives nothing and the path stands as it is
  const auto relative =
      std::filesystem::absolute(path, ignored)
          .lexically_relative(std::filesystem::absolute(folder.empty() ? "." : folder, ignored).lexically_normal());
  return in_quotes(relative.empty() ? path.generic_string() : relative.generic_string());
}

std::string pin_text(const PinSpec& pin, const std::filesystem::path& folder) {
  std::string out = "{ ";
  switch (pin.select) {
    case PinSpec::Select::k_group: out.append("group = ").append(in_quotes(pin.group)); break;
    case PinSpec::Select::k_within: out.append("within = ").append(number_text(pin.within)); break;
    case PinSpec::Select::k_vertices: out.append("vertices = ").append(in_quotes(vertices_text(pin.vertices))); break;
    case PinSpec::Select::k_file: out.append("file = ").append(relative_text(pin.file, folder)); break;
  }
  if (!pin.column.empty()) out.append(", column = ").append(in_quotes(pin.column));
  out.append(", stiffness = ")
      .append(number_text(pin.stiffness))
      .append(", max_pull = ")
      .append(number_text(pin.max_pull));
  if (pin.from) out.append(", from = ").append(number_text(*pin.from));
  if (pin.until) out.append(", until = ").append(number_text(*pin.until));
  if (pin.fade > 0) out.append(", fade = ").append(number_text(pin.fade));
  if (!pin.to.empty()) out.append(", to = ").append(in_quotes(pin.to));
  if (!pin.opens.isZero()) out.append(", opens = ").append(vector_text(pin.opens));
  return out.append(" }");
}

std::string map_text(const MapSpec& map, const std::filesystem::path& folder) {
  std::string out = "{ of = " + in_quotes(map.of);
  if (!map.from.empty()) out.append(", from = ").append(in_quotes(map.from));
  if (!map.file.empty()) out.append(", file = ").append(relative_text(map.file, folder));
  if (!map.column.empty()) out.append(", column = ").append(in_quotes(map.column));
  if (map.low) out.append(", low = ").append(number_text(*map.low));
  if (map.high) out.append(", high = ").append(number_text(*map.high));
  return out.append(" }");
}

/// Text of one key's value; empty when the key only repeats another (pin), or adds nothing (no maps).
template <class Spec>
struct ValueText {
  const Spec& spec;
  const std::filesystem::path& folder;
  std::string operator()(int Spec::*member) const { return std::to_string(spec.*member); }
  std::string operator()(double Spec::*member) const { return number_text(spec.*member); }
  std::string operator()(bool Spec::*member) const { return spec.*member ? "true" : "false"; }
  std::string operator()(std::string Spec::*member) const { return in_quotes(spec.*member); }
  std::string operator()(std::filesystem::path Spec::*member) const { return relative_text(spec.*member, folder); }
  std::string operator()(std::optional<double> Spec::*member) const {
    return spec.*member ? number_text(*(spec.*member)) : "none";
  }
  std::string operator()(Vec3 Spec::*member) const { return vector_text(spec.*member); }
  std::string operator()(std::vector<std::string> Spec::*member) const { return list_text(spec.*member); }
  std::string operator()(FramesKey) const {
    if constexpr (std::is_same_v<Spec, Shot>) return in_quotes(frames_text({spec.first_frame, spec.last_frame}));
    return {};
  }
  std::string operator()(PinsKey) const {
    std::string out = "[";
    if constexpr (std::is_same_v<Spec, ClothSpec>)
      for (const PinSpec& pin : spec.pins) out.append(out.size() > 1 ? ", " : "").append(pin_text(pin, folder));
    return out.append("]");
  }
  std::string operator()(SinglePinKey) const { return {}; }
  std::string operator()(TeleportsKey) const {
    if constexpr (std::is_same_v<Spec, PrimarySpec>) {
      if (spec.teleports != Teleports::k_frames)
        return in_quotes(spec.teleports == Teleports::k_detect ? "detect" : "ignore");
      std::string out = "[";
      for (const int frame : spec.teleport_frames) out.append(out.size() > 1 ? ", " : "").append(std::to_string(frame));
      return out.append("]");
    }
    return {};
  }
  std::string operator()(ReleaseKey) const {
    if constexpr (std::is_same_v<Spec, PrimarySpec>) {
      if (spec.release == Release::k_contact) return in_quotes("contact");
      if (spec.release == Release::k_frame) return number_text(spec.release_frame);
    }
    return "none";
  }
  std::string operator()(MapsKey) const {
    std::string out;
    if constexpr (std::is_same_v<Spec, ClothSpec>)
      for (const MapSpec& map : spec.maps) out.append(out.empty() ? "[" : ", ").append(map_text(map, folder));
    return out.empty() ? out : out.append("]");
  }
};

using Settings = std::vector<std::pair<std::string, std::string>>;

template <class Spec>
void append_section(Settings& out, const std::string& section, std::span<const ShotKey<Spec>> keys, const Spec& spec,
                    const std::filesystem::path& folder) {
  for (const ShotKey<Spec>& key : keys) {
    std::string text = std::visit(ValueText<Spec>{spec, folder}, key.target);
    if (!text.empty()) out.emplace_back(std::string(section).append(".").append(key.name), std::move(text));
  }
}

template <class Spec>
std::string type_text(const ShotKey<Spec>& key) {
  struct Names {
    std::string operator()(int Spec::*) const { return "whole number"; }
    std::string operator()(double Spec::*) const { return "number"; }
    std::string operator()(bool Spec::*) const { return "true or false"; }
    std::string operator()(std::string Spec::*) const { return "text"; }
    std::string operator()(std::filesystem::path Spec::*) const { return "file"; }
    std::string operator()(std::optional<double> Spec::*) const { return "number"; }
    std::string operator()(Vec3 Spec::*) const { return "[x, y, z]"; }
    std::string operator()(std::vector<std::string> Spec::*) const { return "list of text"; }
    std::string operator()(FramesKey) const { return "frames"; }
    std::string operator()(PinsKey) const { return std::is_same_v<Spec, PinSpec> ? "vertices" : "list of pins"; }
    std::string operator()(SinglePinKey) const { return "text"; }
    std::string operator()(TeleportsKey) const { return "text or list of frames"; }
    std::string operator()(ReleaseKey) const { return "frame or text"; }
    std::string operator()(MapsKey) const { return "list of maps"; }
  };
  return std::visit(Names{}, key.target);
}

std::string allowed_text(double lowest, double highest, std::string_view unit) {
  std::string out;
  if (lowest != 0 || highest != 0) out.append(number_text(lowest)).append(" to ").append(number_text(highest));
  if (!unit.empty() && unit != "1") out.append(out.empty() ? "" : " ").append(unit);
  return out;
}

/// Words inside a Markdown table cell.
std::string known_words(const std::vector<std::string>& words, std::string_view otherwise) {
  if (words.empty()) return std::string(otherwise);
  std::string out;
  for (const std::string& word : words) out.append(out.empty() ? "`" : ", `").append(word).append("`");
  return out;
}

template <class Spec>
void append_reference(std::string& out, std::string_view heading, std::span<const ShotKey<Spec>> keys,
                      const ShotVocabulary& vocabulary) {
  out.append("### `").append(heading).append(
      "`\n\n| key | type | allowed | default | meaning |\n|---|---|---|---|---|\n");
  const Spec defaults;
  const std::filesystem::path nowhere;
  for (const ShotKey<Spec>& key : keys) {
    std::string allowed = allowed_text(key.lowest, key.highest, key.unit);
    if (key.choices == "@fabrics")
      allowed = known_words(vocabulary.fabrics, "a fabric's name");
    else if (key.choices == "@formats")
      allowed = known_words(vocabulary.cache_formats, "cache formats");
    else if (key.choices == "@primaries")
      allowed = "name of a primary";
    else if (key.choices == "@cloths")
      allowed = "name of a cloth";
    else if (key.choices == "@secondaries")
      allowed = "name of a cloth or of cords";
    else if (key.choices == "@maps")
      allowed = known_words(map_words(), "");
    else if (!key.choices.empty())
      allowed = known_words(split_words(key.choices), "");
    std::string fallback = key.required ? "**required**" : std::visit(ValueText<Spec>{defaults, nowhere}, key.target);
    // One of the first keys says which vertices, where values come from, what a primary is; it has no default then.
    const std::ptrdiff_t choosing = std::is_same_v<Spec, PinSpec>       ? 4
                                    : std::is_same_v<Spec, MapSpec>     ? 2
                                    : std::is_same_v<Spec, PrimarySpec> ? 1
                                                                        : 0;
    const bool chooses = &key < keys.data() + choosing && fallback.size() <= 2;
    if (chooses)
      fallback = "one of these";
    else if (fallback == "\"\"" || fallback == "none" || fallback == "[]" || fallback.empty())
      fallback = "none";
    else if (!key.required)
      fallback = std::string("`").append(fallback).append("`");
    out.append("| `")
        .append(key.name)
        .append("` | ")
        .append(type_text(key))
        .append(" | ")
        .append(allowed)
        .append(" | ");
    out.append(fallback).append(" | ").append(key.meaning).append(" |\n");
  }
  out.append("\n");
}

}  // namespace

Settings settings(const Shot& shot) {
  Settings out;
  const std::filesystem::path folder = shot.file.parent_path();
  append_section(out, "shot", shot_keys(), shot, folder);
  for (const PrimarySpec& primary : shot.primaries) {
    append_section(out, "primary." + key_word(primary.name), primary_keys(), primary, folder);
    append_section(out, "primary." + key_word(primary.name), prop_keys(), primary, folder);
    append_section(out, "primary." + key_word(primary.name), yield_keys(), primary, folder);
  }
  for (const ClothSpec& cloth : shot.cloths) {
    const std::string section = "cloth." + key_word(cloth.name);
    append_section(out, section, cloth_keys(), cloth, folder);
    for (const auto& [key, value] : cloth.fabric_overrides)
      out.emplace_back(std::string(section).append(".").append(key), number_text(value));
  }
  for (const CordsSpec& cords : shot.cords)
    append_section(out, "cords." + key_word(cords.name), cords_keys(), cords, folder);
  for (const StandInKeys& standin : shot.standins)
    append_section(out, "standin." + key_word(standin.name), standin_keys(), standin, folder);
  append_section(out, "wind", wind_keys(), shot.wind, folder);
  append_section(out, "solver", solver_keys(), shot.solver, folder);
  append_section(out, "cache", cache_keys(), shot, folder);
  append_section(out, "gate", gate_keys(), shot, folder);
  return out;
}

std::string canonical(const Shot& shot) {
  std::string out;
  for (const auto& [key, value] : settings(shot)) out.append(key).append(" = ").append(value).append("\n");
  return out;
}

std::vector<std::string> changed_settings(const Settings& before, const Settings& now) {
  const std::map<std::string, std::string> old_values(before.begin(), before.end()), new_values(now.begin(), now.end());
  std::vector<std::string> out;
  for (const auto& [key, value] : now) {
    const auto old_value = old_values.find(key);
    if (old_value == old_values.end())
      out.push_back(key + " is new (" + value + ")");
    else if (old_value->second != value)
      out.push_back(key + " changed from " + old_value->second + " to " + value);
  }
  for (const auto& [key, value] : before)
    if (!new_values.contains(key)) out.push_back(key + " is gone (was " + value + ")");
  if (out.empty() && before != now) out.push_back("the order of the sections changed");
  return out;
}

std::string shot_file_reference(const ShotVocabulary& vocabulary) {
  std::string out;
  append_reference(out, "[shot]", shot_keys(), vocabulary);
  append_reference(out, "[primary.NAME]", primary_keys(), vocabulary);
  append_reference(out, "[primary.NAME], a rigid prop", prop_keys(), vocabulary);
  append_reference(out, "[primary.NAME] that meets stand-ins", yield_keys(), vocabulary);
  append_reference(out, "[cloth.NAME]", cloth_keys(), vocabulary);
  out.append("A cloth may also override numbers of its fabric:\n\n| key | allowed |\n|---|---|\n");
  for (const FabricKeyWord& key : vocabulary.fabric_keys)
    out.append("| `")
        .append(key.key)
        .append("` | ")
        .append(allowed_text(key.lowest, key.highest, key.unit))
        .append(" |\n");
  out.append("\n");
  append_reference(out, "pins = [ { ... } ]", pin_keys(), vocabulary);
  append_reference(out, "maps = [ { ... } ]", map_keys(), vocabulary);
  append_reference(out, "[cords.NAME]", cords_keys(), vocabulary);
  append_reference(out, "[standin.NAME]", standin_keys(), vocabulary);
  append_reference(out, "[wind]", wind_keys(), vocabulary);
  append_reference(out, "[solver]", solver_keys(), vocabulary);
  append_reference(out, "[cache]", cache_keys(), vocabulary);
  append_reference(out, "[gate]", gate_keys(), vocabulary);
  return out;
}

}  // namespace ft
