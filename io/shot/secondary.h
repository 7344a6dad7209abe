// What follows, as the shot file's reader knows it. Each kind of secondary has a section of its own with a table of
// keys, [cloth.NAME]; the conductor brings them along (ShotVocabulary), and the reader names none.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/shot/shot_values.h"

namespace ft::inline io {

class KeyReader;
class SecondarySection;
struct Shot;
struct ShotVocabulary;

/// One section [KIND.NAME]; each kind has more in a struct of its own.
struct SecondarySpec {
  virtual ~SecondarySpec() = default;
  const SecondarySection* section = nullptr;  ///< its kind's
  std::string name;
  std::string on;                    ///< name of the primary, or reference() of a secondary that is baked before
  std::string coupling = "one-way";  ///< with its primary: "one-way", "hybrid" (through stand-ins), "two-way"

  std::string_view kind() const;
  /// "cloth \"skirt\"", for messages.
  std::string owner() const;
  /// What other secondaries call it, "cloth.skirt".
  std::string reference() const;
};

using Settings = std::vector<std::pair<std::string, std::string>>;

class SecondarySection {
 public:
  virtual ~SecondarySection() = default;

  virtual std::string_view name() const = 0;
  virtual std::vector<std::string> key_names() const = 0;
  virtual std::shared_ptr<SecondarySpec> make() const = 0;
  virtual void read(const std::string& owner, const Value& table, SecondarySpec& spec,
                    const KeyReader& reader) const = 0;
  /// Faults that only the whole shot shows; may fill in what depends on other keys. root: all of the file.
  virtual void judge(const Value& /*root*/, SecondarySpec& /*spec*/, const Shot& /*shot*/,
                     FaultList& /*faults*/) const {}
  /// Appends its settings, ("cloth.skirt.fabric", "\"denim\""); section: "cloth.skirt". Paths relative to the folder.
  virtual void append_settings(const std::string& section, const SecondarySpec& spec,
                               const std::filesystem::path& folder, Settings& out) const = 0;
  /// Appends its tables of keys as Markdown.
  virtual void append_reference(const ShotVocabulary& vocabulary, std::string& out) const = 0;
  /// Files that it reads: the key, "mesh", and the path.
  virtual std::vector<std::pair<std::string, std::filesystem::path>> files(const SecondarySpec& spec) const = 0;
  /// Names of its systems, after which their caches are called.
  virtual std::vector<std::string> system_names(const SecondarySpec& spec) const { return {spec.name}; }
  /// Files beside its caches that its bake writes; names in the bake's folder.
  virtual std::vector<std::string> written_files(const SecondarySpec&) const { return {}; }
  /// Lists of words that its keys name by "@...".
  virtual std::vector<std::pair<std::string, std::vector<std::string>>> lists() const { return {}; }

  /// What `on` says: "who wears it".
  virtual std::string_view whom() const = 0;
  /// Whether one has to be named where there are several; else it is on the first.
  virtual bool needs_on() const { return true; }
  /// Primaries that it moves while it is solved, beside the one that it is on and is coupled with two-way; names with
  /// `*` and `?`.
  virtual std::vector<std::string> moves(const SecondarySpec&) const { return {}; }
  /// Patterns of what it meets beside what it is on. One that is another secondary's reference() has that baked before.
  virtual std::vector<std::string> meets(const SecondarySpec&) const { return {}; }
  /// Names of others of its kind that it can only be solved together with.
  virtual std::vector<std::string> solved_with(const SecondarySpec&) const { return {}; }
  /// Why no other secondary can be on it or meet it; empty: they can.
  virtual std::string_view why_no_carrier() const { return {}; }
  /// Whether its surface is a liquid's: no body, and only for what floats.
  virtual bool is_liquid() const { return false; }
  /// Whether it floats on liquids that it meets, or is on.
  virtual bool floats() const { return false; }
  /// Whether its primary has to be one rigid body.
  virtual bool needs_rigid_primary() const { return false; }
  /// Whether it needs the joints of its primary, where that has some.
  virtual bool needs_character() const { return false; }
  /// Why a primary cannot feel it two-way; empty: it can.
  virtual std::string_view why_not_two_way() const = 0;
};

/// The secondaries of one kind, in the order of the file.
template <class Spec, class Secondaries>
std::vector<const Spec*> specs_of(const Secondaries& all) {
  std::vector<const Spec*> out;
  for (const auto& one : all)
    if (const auto* spec = dynamic_cast<const Spec*>(one.get())) out.push_back(spec);
  return out;
}

}  // namespace ft::inline io
