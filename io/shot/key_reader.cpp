#include "io/shot/key_reader.h"

#include "io/shot/words.h"

namespace ft::inline io {

void KeyReader::refuse(const std::string& owner, const Member& member, const std::vector<std::string>& known,
                       const std::string& other) const {
  std::string hint;
  const std::string home = home_of(vocabulary_, member.key);
  const std::string near = nearest_word(member.key, known);
  if (!near.empty() && edit_distance(member.key, near) <= 1)
    hint = suggestion(member.key, known);
  else if (!other.empty())
    hint = "did you mean \"" + other + "\"?";
  else if (!home.empty())
    hint = "it belongs under " + home;
  else
    hint = suggestion(member.key, known);
  faults_.add(member.place, with_hint(owner + ": unknown key " + in_quotes(member.key), hint));
}

bool KeyReader::is_allowed(const ValueReader& reader, const Value& value, const std::string& word,
                           std::string_view choices) const {
  if (choices.empty()) return true;
  if (choices.front() != '@') return reader.is_one_of(value, word, split_words(choices));
  const auto list = vocabulary_.lists.find(choices);
  return list == vocabulary_.lists.end() || reader.is_one_of(value, word, list->second);
}

std::optional<std::vector<std::string>> KeyReader::words(const ValueReader& reader, const Value& value,
                                                         std::string_view choices) const {
  auto out = reader.texts(value);
  if (!out || choices.empty()) return out;
  bool good = true;
  for (std::size_t i = 0; i < out->size(); ++i)
    good = is_allowed(reader, value.kind == Value::Kind::k_list ? value.items[i] : value, (*out)[i], choices) && good;
  if (out->empty()) reader.fault(value, "is empty: nothing would be written"), good = false;
  return good ? out : std::nullopt;
}

}  // namespace ft::inline io
