#include "io/shot/shot_override.h"

#include <algorithm>

#include "io/shot/shot_keys.h"
#include "io/shot/words.h"

namespace ft::inline io {

void apply_override(Value& root, const std::string& text, const ShotVocabulary& vocabulary, FaultList& faults) {
  std::vector<std::string> path;
  Value value;
  std::string fault;
  const Place place{0, 0, "--set " + printable(text, 80)};
  if (!parse_override(text, path, value, fault)) return faults.add(place, fault);
  const std::vector<std::string> sections = section_names(vocabulary);
  // [wind] has keys, and fields with names.
  const bool named = is_named_section(vocabulary, path.front()) || (path.front() == "wind" && path.size() == 3);
  if (std::find(sections.begin(), sections.end(), path.front()) == sections.end())
    return faults.add(place,
                      with_hint("unknown section " + in_quotes(path.front()), suggestion(path.front(), sections)));
  if (path.size() != (named ? 3u : 2u))
    return faults.add(place, "is not of the form " + path.front() + (named ? ".NAME" : "") + ".key=value");
  Value* table = &root;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    Member* member = table->find(path[i]);
    if (member == nullptr && named) {
      std::vector<std::string> names;
      if (i == 1)
        for (const Member& m : table->members) names.push_back(m.key);
      return faults.add(
          place, with_hint("there is no " + path.front() + " " + in_quotes(path[1]), suggestion(path[1], names)));
    }
    if (member == nullptr) {
      Value empty;
      empty.place = place;
      table->members.push_back({path[i], place, empty});
      member = &table->members.back();
    }
    if (member->value.kind != Value::Kind::k_table) return;  // the file's own fault is reported there
    table = &member->value;
  }
  if (Member* old = table->find(path.back()))
    *old = {path.back(), place, std::move(value)};
  else
    table->members.push_back({path.back(), place, std::move(value)});
}

}  // namespace ft::inline io
