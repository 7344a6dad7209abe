// What sections of all kinds do alike: a table of keys fills a spec.
#pragma once

#include <span>

#include "io/shot/key_reader.h"
#include "io/shot/key_text.h"
#include "io/shot/secondary.h"

namespace ft::inline baker {

template <class Spec>
class SectionOf : public SecondarySection {
 public:
  SectionOf(std::string_view name, std::span<const ShotKey<Spec>> keys) : name_(name), keys_(keys) {}

  std::string_view name() const override { return name_; }
  std::vector<std::string> key_names() const override {
    std::vector<std::string> out;
    for (const ShotKey<Spec>& key : keys_) out.emplace_back(key.name);
    return out;
  }
  std::shared_ptr<SecondarySpec> make() const override { return std::make_shared<Spec>(); }
  void read(const std::string& owner, const Value& table, SecondarySpec& spec, const KeyReader& reader) const override {
    auto& own = static_cast<Spec&>(spec);
    reader.read(owner, table, own, keys_, other_keys(own));
  }
  void append_settings(const std::string& section, const SecondarySpec& spec, const std::filesystem::path& folder,
                       Settings& out) const override {
    append_keys(out, section, keys_, of(spec), folder);
  }
  void append_reference(const ShotVocabulary& vocabulary, std::string& out) const override {
    ft::append_reference(out, std::string("[").append(name_).append(".NAME]"), keys_, vocabulary);
  }

 protected:
  static const Spec& of(const SecondarySpec& spec) { return static_cast<const Spec&>(spec); }
  virtual OtherKeys other_keys(Spec&) const { return {}; }

 private:
  std::string_view name_;
  std::span<const ShotKey<Spec>> keys_;
};

}  // namespace ft::inline baker
