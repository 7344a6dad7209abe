// Which keys of a section go with which choice of one of them, such as the shape of a prop.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "io/shot/shot_values.h"

namespace ft::inline io {

/// What goes with one choice of a key: keys that it needs, and that it takes. Keys of no row go with all.
struct ChoiceKeys {
  std::string_view word;  ///< empty: the key is not there
  std::string_view needs, takes;
};

/// Faults of keys that the chosen row needs, and of those that only other rows know. A word that is no row's has its
/// fault already.
void judge_choice(const std::string& owner, const Value& table, std::string_view key, std::string_view word,
                  std::span<const ChoiceKeys> rows, FaultList& faults);

/// The section of that kind and name; null where the file's own fault has been reported.
const Value* section_of(const Value& root, std::string_view kind, std::string_view name);

}  // namespace ft::inline io
