// Reads a shot: tree of values -> structs, by the key table; then what only the whole can tell (who wears what). Faults
// are collected, never stopped at, except for TOML's own syntax: behind a syntax fault nothing can be understood.
#include <algorithm>
#include <cmath>

#include "baker/core/file.h"
#include "io/shot/key_reader.h"
#include "io/shot/secondary.h"
#include "io/shot/shot_judge.h"
#include "io/shot/shot_override.h"
#include "io/shot/shot_values.h"
#include "io/shot/words.h"

namespace ft::inline io {
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
      : vocabulary_(vocabulary), faults_(faults), keys_(file.parent_path(), vocabulary, faults) {
    shot_.file = file;
  }

  Shot read(const Value& root) {
    for (const Member& member : root.members) {
      const auto section = [&](auto& spec, auto keys) { read_plain(member, spec, keys); };
      if (member.key == "shot")
        section(shot_, shot_keys());
      else if (member.key == "wind")
        read_wind(member);
      else if (member.key == "solver")
        section(shot_.solver, solver_keys());
      else if (member.key == "cache")
        section(shot_, cache_keys());
      else if (member.key == "gate")
        section(shot_, gate_keys());
      else if (member.key == "primary")
        read_named(member, shot_.primaries, std::span<const ShotKey<PrimarySpec>>(primary_keys_));
      else if (member.key == "standin")
        read_named(member, shot_.standins, standin_keys());
      else if (!is_named_section(vocabulary_, member.key))
        refuse_section(member);
    }
    for (const SecondarySection* section : vocabulary_.sections)
      if (const Member* member = root.find(section->name())) read_secondaries(*member, *section);
    const Member* own = root.find("shot");
    shot_.preroll_given = own != nullptr && own->value.find("preroll") != nullptr;
    judge_whole(root, shot_, vocabulary_, faults_);
    return std::move(shot_);
  }

 private:
  void refuse_section(const Member& member) {
    const std::vector<std::string> sections = section_names(vocabulary_);
    if (member.value.kind == Value::Kind::k_table || member.value.kind == Value::Kind::k_list) {
      std::string hint = suggestion(member.key, sections);
      for (const std::string& key : {member.key, member.key + "s"})
        if (const std::string home = home_of(vocabulary_, key); !home.empty())
          hint = printable(key) + (key.ends_with("s") ? " belong" : " belongs") + " under " + home;
      faults_.add(member.place, with_hint("unknown section [" + printable(member.key) + "]", hint));
    } else {
      const std::string home = home_of(vocabulary_, member.key);
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
    keys_.read("[" + member.key + "]", member.value, spec, keys);
  }

  /// Calls take(name, table) for each [KIND.NAME].
  template <class Take>
  void for_each_named(const Member& member, Take&& take) {
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
      judge_name(named, kind + " " + in_quotes(named.key));
      take(named.key, named.value);
    }
  }

  template <class Spec>
  void read_named(const Member& member, std::vector<Spec>& specs, std::span<const ShotKey<Spec>> keys) {
    for_each_named(member, [&](const std::string& name, const Value& table) {
      Spec& spec = specs.emplace_back();
      spec.name = name;
      keys_.read(member.key + " " + in_quotes(name), table, spec, keys);
    });
  }

  /// Keys that stand in it, and sections with names.
  void read_wind(const Member& member) {
    Member steady = member, fields = member;
    if (member.value.kind == Value::Kind::k_table) {
      const auto is_field = [](const Member& m) { return m.value.kind == Value::Kind::k_table; };
      std::erase_if(steady.value.members, is_field);
      std::erase_if(fields.value.members, [&](const Member& m) { return !is_field(m); });
      read_named(fields, shot_.winds, wind_field_keys());
    }
    read_plain(steady, shot_.wind, wind_keys());
  }

  void read_secondaries(const Member& member, const SecondarySection& section) {
    for_each_named(member, [&](const std::string& name, const Value& table) {
      SecondarySpec& spec = *shot_.secondaries.emplace_back(section.make());
      spec.section = &section;
      spec.name = name;
      section.read(spec.owner(), table, spec, keys_);
    });
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

  const std::vector<ShotKey<PrimarySpec>> primary_keys_ = every_primary_key();
  const ShotVocabulary& vocabulary_;
  FaultList& faults_;
  KeyReader keys_;
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
    for (const std::string& text_override : overrides) apply_override(root, text_override, vocabulary, list);
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

}  // namespace ft::inline io
