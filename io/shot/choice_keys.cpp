#include "io/shot/choice_keys.h"

#include <algorithm>

#include "io/shot/shot_keys.h"
#include "io/shot/words.h"

namespace ft::inline io {
namespace {

bool has(std::string_view words, std::string_view word) {
  const std::vector<std::string> all = split_words(words);
  return std::find(all.begin(), all.end(), word) != all.end();
}

}  // namespace

void judge_choice(const std::string& owner, const Value& table, std::string_view key, std::string_view word,
                  std::span<const ChoiceKeys> rows, FaultList& faults) {
  const auto chosen = std::find_if(rows.begin(), rows.end(), [&](const ChoiceKeys& row) { return row.word == word; });
  if (chosen == rows.end()) return;
  const auto named = [&](std::string_view choice) {
    return choice.empty() ? std::string("file") : std::string(key) + " = " + in_quotes(choice);
  };
  for (const std::string& needed : split_words(chosen->needs))
    if (!table.find(needed))
      faults.add(table.place, owner + ": " + needed + " is missing; " + named(word) + " needs it");
  for (const Member& member : table.members) {
    if (has(chosen->needs, member.key) || has(chosen->takes, member.key)) continue;
    std::vector<std::string> others;
    for (const ChoiceKeys& row : rows)
      if (has(row.needs, member.key) || has(row.takes, member.key)) others.push_back(named(row.word));
    if (!others.empty())
      faults.add(member.place,
                 owner + ": " + member.key + " goes with " + joined(others, " or ") + ", not with " + named(word));
  }
}

const Value* section_of(const Value& root, std::string_view kind, std::string_view name) {
  const Member* all = root.find(kind);
  const Member* one = all ? all->value.find(name) : nullptr;
  return one && one->value.kind == Value::Kind::k_table ? &one->value : nullptr;
}

}  // namespace ft::inline io
