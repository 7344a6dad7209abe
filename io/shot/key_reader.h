// Reads the keys of one section by its table. Faults are collected.
#pragma once

#include <algorithm>
#include <functional>

#include "io/shot/shot_keys.h"

namespace ft::inline io {

/// Keys of a section beside its table, such as numbers of a fabric.
struct OtherKeys {
  std::vector<std::string> names;
  std::function<bool(const ValueReader&, const Member&)> read;  ///< false: it is none of them
};

class KeyReader {
 public:
  KeyReader(std::filesystem::path folder, const ShotVocabulary& vocabulary, FaultList& faults)
      : folder_(std::move(folder)), vocabulary_(vocabulary), faults_(faults) {}

  FaultList& faults() const { return faults_; }
  const ShotVocabulary& vocabulary() const { return vocabulary_; }

  /// owner: "cloth \"cape\"" or "[shot]".
  template <class Spec>
  void read(const std::string& owner, const Value& table, Spec& spec, std::span<const ShotKey<Spec>> keys,
            const OtherKeys& others = {}) const {
    for (const Member& member : table.members) {
      const auto key = std::find_if(keys.begin(), keys.end(), [&](const auto& k) { return k.name == member.key; });
      const ValueReader reader{faults_, owner, member.key};
      if (key != keys.end()) {
        std::visit([&](auto target) { set(reader, member.value, *key, spec, target); }, key->target);
        continue;
      }
      if (others.read && others.read(reader, member)) continue;
      std::vector<std::string> known;
      std::string other;
      for (const auto& k : keys) {
        known.emplace_back(k.name);
        if (other.empty() && is_synonym(k.also, member.key)) other = std::string(k.name);
      }
      known.insert(known.end(), others.names.begin(), others.names.end());
      refuse(owner, member, known, other);
    }
    for (const auto& key : keys)
      if (key.required && table.find(key.name) == nullptr)
        faults_.add(table.place,
                    owner + ": " + std::string(key.name) + " is missing (" + std::string(key.meaning) + ")");
  }

 private:
  /// other: the key for which the word is a synonym; may be empty.
  void refuse(const std::string& owner, const Member& member, const std::vector<std::string>& known,
              const std::string& other) const;
  /// False where a text is not among the words that the key allows.
  bool is_allowed(const ValueReader& reader, const Value& value, const std::string& word,
                  std::string_view choices) const;
  std::optional<std::vector<std::string>> words(const ValueReader& reader, const Value& value,
                                                std::string_view choices) const;

  // One function for each kind of target in the key table.
  template <class Spec>
  static Allowed allowed(const ShotKey<Spec>& key, bool whole = false) {
    return {key.lowest, key.highest, key.unit, whole};
  }
  template <class Spec>
  void set(const ValueReader& reader, const Value& value, const ShotKey<Spec>& key, Spec& spec,
           int Spec::*target) const {
    if (const auto number = reader.number(value, allowed(key, true))) spec.*target = static_cast<int>(*number);
  }
  template <class Spec>
  void set(const ValueReader& reader, const Value& value, const ShotKey<Spec>& key, Spec& spec,
           double Spec::*target) const {
    if (const auto number = reader.number(value, allowed(key))) spec.*target = *number;
  }
  template <class Spec>
  void set(const ValueReader& reader, const Value& value, const ShotKey<Spec>& key, Spec& spec,
           std::optional<double> Spec::*target) const {
    if (const auto number = reader.number(value, allowed(key))) spec.*target = *number;
  }
  template <class Spec>
  void set(const ValueReader& reader, const Value& value, const ShotKey<Spec>&, Spec& spec, bool Spec::*target) const {
    if (const auto flag = reader.flag(value)) spec.*target = *flag;
  }
  template <class Spec>
  void set(const ValueReader& reader, const Value& value, const ShotKey<Spec>& key, Spec& spec,
           Vec3 Spec::*target) const {
    if (const auto vector = reader.vector(value, allowed(key))) spec.*target = *vector;
  }
  template <class Spec>
  void set(const ValueReader& reader, const Value& value, const ShotKey<Spec>&, Spec& spec,
           std::filesystem::path Spec::*target) const {
    if (auto file = reader.file(value, folder_)) spec.*target = std::move(*file);
  }
  template <class Spec>
  void set(const ValueReader& reader, const Value& value, const ShotKey<Spec>& key, Spec& spec,
           std::string Spec::*target) const {
    if (const auto text = reader.text(value); text && is_allowed(reader, value, *text, key.choices))
      spec.*target = *text;
  }
  template <class Spec>
  void set(const ValueReader& reader, const Value& value, const ShotKey<Spec>& key, Spec& spec,
           std::vector<std::string> Spec::*target) const {
    if (auto list = words(reader, value, key.choices)) spec.*target = std::move(*list);
  }
  template <class Spec>
  void set(const ValueReader& reader, const Value& value, const ShotKey<Spec>& key, Spec& spec,
           const OwnGrammar<Spec>& grammar) const {
    grammar.read(*this, reader, value, allowed(key), spec);
  }

  std::filesystem::path folder_;
  const ShotVocabulary& vocabulary_;
  FaultList& faults_;
};

}  // namespace ft::inline io
