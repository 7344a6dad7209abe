// Keys of a section as text: their values, for the settings list, and their tables, for the reference.
#pragma once

#include <span>
#include <string>

#include "io/shot/shot_keys.h"
#include "io/shot/words.h"

namespace ft::inline io {

/// TOML's basic string: what differs in the shot differs in the text.
std::string toml_text(std::string_view text);
/// A name as a TOML key.
std::string key_word(std::string_view name);
std::string list_text(const std::vector<std::string>& words);
std::string vector_text(const Vec3& v);
std::string relative_text(const std::filesystem::path& path, const std::filesystem::path& folder);
/// "0 to 10 m": of numbers; empty where all are allowed.
std::string allowed_text(double lowest, double highest, std::string_view unit);
/// What a key allows, inside a Markdown table cell.
std::string allowed_words(double lowest, double highest, std::string_view unit, std::string_view choices,
                          const ShotVocabulary& vocabulary);

/// Text of one key's value; empty when the key only repeats another, or adds nothing.
template <class Spec>
struct ValueText {
  const Spec& spec;
  const std::filesystem::path& folder;
  std::string operator()(int Spec::*member) const { return std::to_string(spec.*member); }
  std::string operator()(double Spec::*member) const { return number_text(spec.*member); }
  std::string operator()(bool Spec::*member) const { return spec.*member ? "true" : "false"; }
  std::string operator()(std::string Spec::*member) const { return toml_text(spec.*member); }
  std::string operator()(std::filesystem::path Spec::*member) const { return relative_text(spec.*member, folder); }
  std::string operator()(std::optional<double> Spec::*member) const {
    return spec.*member ? number_text(*(spec.*member)) : "none";
  }
  std::string operator()(Vec3 Spec::*member) const { return vector_text(spec.*member); }
  std::string operator()(std::vector<std::string> Spec::*member) const { return list_text(spec.*member); }
  std::string operator()(const OwnGrammar<Spec>& grammar) const { return grammar.text(spec, folder); }
};

template <class Spec>
void append_keys(Settings& out, const std::string& section, std::span<const ShotKey<Spec>> keys, const Spec& spec,
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
    std::string operator()(const OwnGrammar<Spec>& grammar) const { return std::string(grammar.type); }
  };
  return std::visit(Names{}, key.target);
}

/// choosing: of so many first keys one says what the section is about, and none of them has a default.
template <class Spec>
void append_reference(std::string& out, std::string_view heading, std::span<const ShotKey<Spec>> keys,
                      const ShotVocabulary& vocabulary, std::ptrdiff_t choosing = 0) {
  out.append("### `").append(heading).append(
      "`\n\n| key | type | allowed | default | meaning |\n|---|---|---|---|---|\n");
  const Spec defaults;
  const std::filesystem::path nowhere;
  for (const ShotKey<Spec>& key : keys) {
    const std::string allowed = allowed_words(key.lowest, key.highest, key.unit, key.choices, vocabulary);
    std::string fallback = key.required ? "**required**" : std::visit(ValueText<Spec>{defaults, nowhere}, key.target);
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

}  // namespace ft::inline io
