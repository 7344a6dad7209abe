// The only file that includes toml++ (without exceptions). Tables come out of toml++ sorted by name; here they get the
// order of the file back, because the order of cloths is the order of caches.
#include "io/shot/value_tree.h"

#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_UNRELEASED_FEATURES 0
#include <toml++/toml.h>

#include <algorithm>

#include "io/shot/words.h"

namespace ft::inline io {
namespace {

Place place_of(const toml::source_region& region) {
  return {static_cast<int>(region.begin.line), static_cast<int>(region.begin.column), {}};
}

Value converted(const toml::node& node) {
  Value out;
  out.place = place_of(node.source());
  if (const auto* table = node.as_table()) {
    out.kind = Value::Kind::k_table;
    for (const auto& [key, child] : *table)
      out.members.push_back({std::string(key.str()), place_of(key.source()), converted(child)});
    std::stable_sort(out.members.begin(), out.members.end(), [](const Member& a, const Member& b) {
      return a.place.line != b.place.line ? a.place.line < b.place.line : a.place.column < b.place.column;
    });
  } else if (const auto* list = node.as_array()) {
    out.kind = Value::Kind::k_list;
    for (const auto& child : *list) out.items.push_back(converted(child));
  } else if (const auto text = node.as_string()) {
    out.kind = Value::Kind::k_text;
    out.text = text->get();
  } else if (const auto integer = node.as_integer()) {
    out.kind = Value::Kind::k_integer;
    out.integer = integer->get();
    out.number = static_cast<double>(integer->get());
  } else if (const auto number = node.as_floating_point()) {
    out.kind = Value::Kind::k_number;
    out.number = number->get();
  } else if (const auto flag = node.as_boolean()) {
    out.kind = Value::Kind::k_flag;
    out.flag = flag->get();
  } else {
    out.kind = Value::Kind::k_date;
  }
  return out;
}

bool holds(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

std::string_view trimmed(std::string_view s) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!s.empty() && blank(s.front())) s.remove_prefix(1);
  while (!s.empty() && blank(s.back())) s.remove_suffix(1);
  return s;
}

std::string_view line_of(std::string_view text, int number) {
  for (int i = 1; i < number && !text.empty(); ++i) {
    const std::size_t end = text.find('\n');
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return text.substr(0, text.find('\n'));
}

/// What an artist should write instead of a line that TOML does not understand; empty when there is no idea.
std::string line_hint(std::string_view line) {
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos) return holds(line, ":") ? "a key is written name = value, not name: value" : "";
  const std::string_view key = trimmed(line.substr(0, equals)), value = trimmed(line.substr(equals + 1));
  if (value.empty()) return "the value is missing";
  if (value.find_first_of("\"'[{#") != std::string_view::npos) return "";
  if (holds(value, ",")) return "decimal numbers are written with a point, lists in [ ]";
  for (const std::string_view word : {"True", "False", "TRUE", "FALSE", "yes", "no", "on", "off"})
    if (value == word) return "write true or false";
  const std::size_t number_end = value.find_first_not_of("0123456789.+-eE");
  const bool number_and_unit =
      value.front() >= '0' && value.front() <= '9' && number_end != std::string_view::npos && number_end > 0;
  if (number_and_unit) return "numbers are written without a unit, as SI";
  return std::string("text needs quotes: ")
      .append(printable(key, 40))
      .append(" = \"")
      .append(printable(value, 40))
      .append("\"");
}

/// toml++ speaks of its parser; the artist wants to know what is wrong with his file.
std::string syntax_message(std::string_view said, std::string_view line) {
  const std::size_t twice = said.find("cannot redefine existing ");
  if (twice != std::string_view::npos) {
    const std::size_t quote = said.find('\'', twice);
    return printable(said.substr(std::min(quote, said.size())), 80).append(" is there twice");
  }
  if (holds(said, "table header") && holds(said, "expected ']'"))
    return "a section needs a closing ]; names with blanks or dots are written [cloth.\"my dress\"]";
  if (holds(said, "parsing string") && holds(said, "control characters")) return "a text has no closing quote";
  if (holds(said, "utf-8")) return "is not a text file in UTF-8";
  std::string out = printable(said, 200);
  const std::string hint = line_hint(line);
  return hint.empty() ? out : out.append(" (").append(hint).append(")");
}

}  // namespace

const Member* Value::find(std::string_view key) const {
  for (const Member& member : members)
    if (member.key == key) return &member;
  return nullptr;
}

Member* Value::find(std::string_view key) {
  return const_cast<Member*>(static_cast<const Value*>(this)->find(key));
}

std::string describe(const Value& value) {
  switch (value.kind) {
    case Value::Kind::k_flag: return value.flag ? "true" : "false";
    case Value::Kind::k_integer: return std::string("the number ").append(std::to_string(value.integer));
    case Value::Kind::k_number: return std::string("the number ").append(number_text(value.number));
    case Value::Kind::k_text: return std::string("the text \"").append(printable(value.text)).append("\"");
    case Value::Kind::k_list: return "a list";
    case Value::Kind::k_table: return "a table";
    case Value::Kind::k_date: return "a date";
  }
  return "something else";
}

bool parse_tree(std::string_view text, Value& root, ParseFault& fault) {
  const toml::parse_result result = toml::parse(text);
  if (result) {
    root = converted(result.table());
    return true;
  }
  fault.place = place_of(result.error().source());
  fault.message = syntax_message(result.error().description(), line_of(text, fault.place.line));
  return false;
}

bool parse_override(std::string_view text, std::vector<std::string>& path, Value& value, std::string& fault) {
  path.clear();
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0 || text.find_first_of("\n\r") != std::string_view::npos) {
    fault = "is not of the form section.key=value";
    return false;
  }
  // Read as TOML first (numbers, lists, quoted text), then as bare words.
  std::string line(text);
  toml::parse_result result = toml::parse(line);
  const bool bare = !result;
  if (bare) {
    line.assign(text.substr(0, equals)).append(" = \"");
    for (const char c : text.substr(equals + 1)) {
      if (c == '"' || c == '\\') line.push_back('\\');
      line.push_back(c);
    }
    line.push_back('"');
    result = toml::parse(line);
  }
  if (!result || result.table().size() != 1) {
    fault = "is not of the form section.key=value";
    return false;
  }
  const toml::node* node = &result.table();
  while (const auto* table = node->as_table()) {
    if (table->is_inline() || table->size() != 1 || (path.size() > 0 && !table->size())) break;
    path.emplace_back(table->begin()->first.str());
    node = &table->begin()->second;
  }
  value = converted(*node);
  value.loose = true;
  if (value.kind != Value::Kind::k_text) value.text = std::string(text.substr(equals + 1));
  const auto mark = [&](auto& self, Value& v) -> void {
    v.place = {0, 0, std::string("--set ").append(printable(text, 80))};
    for (Value& item : v.items) self(self, item);
    for (Member& member : v.members) member.place = v.place, self(self, member.value);
  };
  mark(mark, value);
  return true;
}

}  // namespace ft::inline io
