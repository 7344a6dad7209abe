// Values of the shot file turned into typed ones; what does not fit becomes a fault that says what would. For
// shot_read.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "baker/core/types.h"
#include "io/shot/value_tree.h"

namespace ft::inline io {

/// Faults with their places, in any order; texts() brings them into the order of the file.
class FaultList {
 public:
  void add(const Place& place, std::string text, bool missing_file = false);
  bool empty() const { return entries_.empty(); }
  bool only_missing_files() const;
  /// "shot.toml:14:7: ..." each; at most 200, then a count.
  std::vector<std::string> texts(std::string_view file) const;
  /// The first fault without its place, and the place alone.
  std::pair<std::string, std::string> first(std::string_view file) const;

 private:
  struct Entry {
    Place place;
    std::string text;
    bool missing_file = false;
  };
  std::vector<Entry> sorted() const;
  std::vector<Entry> entries_;
};

/// "word" in quotes, and "what (hint)" unless the hint is empty: the forms of all messages.
std::string in_quotes(std::string_view word);
std::string with_hint(std::string what, const std::string& hint);

/// What is allowed of a number; lowest == highest == 0 allows all finite numbers.
struct Allowed {
  double lowest = 0, highest = 0;
  std::string_view unit;
  bool whole = false;
};

/// Reads values of one key of one section: `owner` is "cloth \"cape\"", `key` the key's name.
struct ValueReader {
  FaultList& faults;
  std::string owner;
  std::string_view key;

  std::optional<double> number(const Value& value, const Allowed& allowed) const;
  std::optional<bool> flag(const Value& value) const;
  std::optional<std::string> text(const Value& value) const;
  std::optional<Vec3> vector(const Value& value, const Allowed& allowed) const;
  /// A list of different texts, or one text.
  std::optional<std::vector<std::string>> texts(const Value& value) const;
  /// A text of the list; `choices` empty allows all.
  bool is_one_of(const Value& value, const std::string& word, std::span<const std::string> choices) const;
  /// An existing file, resolved against `folder`; a missing one is a fault that names the nearest file there is.
  std::optional<std::filesystem::path> file(const Value& value, const std::filesystem::path& folder) const;

  void fault(const Value& value, std::string what, bool missing_file = false) const;
};

/// "150 g/m2 is written 0.15": the unit in which `value` would be allowed; empty when none is likely.
std::string unit_slip(double value, const Allowed& allowed);

/// "did you mean \"dress.obj\"?" for a path that does not exist; empty when nothing there is similar.
std::string similar_file(const std::filesystem::path& missing);

}  // namespace ft::inline io
