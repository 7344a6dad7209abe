// A shot as text: the settings list (for hashing, and to say what changed) and the printed reference. Both walk the key
// table.
#include <algorithm>
#include <map>

#include "io/shot/key_text.h"
#include "io/shot/secondary.h"
#include "io/shot/words.h"

namespace ft::inline io {
std::string toml_text(std::string_view text) {
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
  return bare ? std::string(name) : toml_text(name);
}

std::string list_text(const std::vector<std::string>& words) {
  std::string out = "[";
  for (const std::string& word : words) out.append(out.size() > 1 ? ", " : "").append(toml_text(word));
  return out.append("]");
}

std::string vector_text(const Vec3& v) {
  std::string out = "[";
  for (int k = 0; k < 3; ++k) out.append(k > 0 ? ", " : "").append(number_text(v[k]));
  return out.append("]");
}

std::string relative_text(const std::filesystem::path& path, const std::filesystem::path& folder) {
  if (path.empty()) return toml_text("");
  std::error_code ignored;  // without a current folder, absolute() gives nothing and the path stands as it is
  const auto relative =
      std::filesystem::absolute(path, ignored)
          .lexically_relative(std::filesystem::absolute(folder.empty() ? "." : folder, ignored).lexically_normal());
  return toml_text(relative.empty() ? path.generic_string() : relative.generic_string());
}

std::string allowed_text(double lowest, double highest, std::string_view unit) {
  std::string out;
  if (lowest != 0 || highest != 0) out.append(number_text(lowest)).append(" to ").append(number_text(highest));
  if (!unit.empty() && unit != "1") out.append(out.empty() ? "" : " ").append(unit);
  return out;
}

namespace {

/// Words inside a Markdown table cell.
std::string known_words(const std::vector<std::string>& words, std::string_view otherwise) {
  if (words.empty()) return std::string(otherwise);
  std::string out;
  for (const std::string& word : words) out.append(out.empty() ? "`" : ", `").append(word).append("`");
  return out;
}

}  // namespace

std::string allowed_words(double lowest, double highest, std::string_view unit, std::string_view choices,
                          const ShotVocabulary& vocabulary) {
  if (choices.empty()) return allowed_text(lowest, highest, unit);
  if (choices.front() != '@') return known_words(split_words(choices), "");
  const auto list = vocabulary.lists.find(choices);
  return list == vocabulary.lists.end() ? std::string(choices.substr(1)) : known_words(list->second, "");
}

Settings settings(const Shot& shot) {
  Settings out;
  const std::filesystem::path folder = shot.file.parent_path();
  append_keys(out, "shot", shot_keys(), shot, folder);
  for (const PrimarySpec& primary : shot.primaries) {
    append_keys(out, "primary." + key_word(primary.name), primary_keys(), primary, folder);
    append_keys(out, "primary." + key_word(primary.name), prop_keys(), primary, folder);
    append_keys(out, "primary." + key_word(primary.name), yield_keys(), primary, folder);
  }
  for (const auto& secondary : shot.secondaries)
    secondary->section->append_settings(std::string(secondary->kind()).append(".").append(key_word(secondary->name)),
                                        *secondary, folder, out);
  for (const StandInKeys& standin : shot.standins)
    append_keys(out, "standin." + key_word(standin.name), standin_keys(), standin, folder);
  append_keys(out, "wind", wind_keys(), shot.wind, folder);
  for (const WindKeys& wind : shot.winds)
    append_keys(out, "wind." + key_word(wind.name), wind_field_keys(), wind, folder);
  append_keys(out, "solver", solver_keys(), shot.solver, folder);
  append_keys(out, "cache", cache_keys(), shot, folder);
  append_keys(out, "gate", gate_keys(), shot, folder);
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
  append_reference(out, "[primary.NAME]", primary_keys(), vocabulary, 1);
  append_reference(out, "[primary.NAME], a rigid prop", prop_keys(), vocabulary, 1);
  append_reference(out, "[primary.NAME] that meets stand-ins", yield_keys(), vocabulary);
  for (const SecondarySection* section : vocabulary.sections) section->append_reference(vocabulary, out);
  append_reference(out, "[standin.NAME]", standin_keys(), vocabulary);
  append_reference(out, "[wind]", wind_keys(), vocabulary);
  append_reference(out, "[wind.NAME]", wind_field_keys(), vocabulary);
  append_reference(out, "[solver]", solver_keys(), vocabulary);
  append_reference(out, "[cache]", cache_keys(), vocabulary);
  append_reference(out, "[gate]", gate_keys(), vocabulary);
  return out;
}

}  // namespace ft::inline io
