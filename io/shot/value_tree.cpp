// The only file that includes toml++ (without exceptions). Tables come out of toml++ sorted by name; here they get the order of
// the file back, because the order of cloths is the order of caches.
#include "io/shot/value_tree.h"

#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_UNRELEASED_FEATURES 0
#include <toml++/toml.h>

#include <algorithm>

#include "io/shot/words.h"

namespace ft {
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

/// toml++ speaks of its parser; the artist wants to know what to write.
std::string syntax_hint(std::string_view text, int line_number) {
  std::string_view line = text;
  for (int i = 1; i < line_number && !line.empty(); ++i) {
    const std::size_t end = line.find('\n');
    line.remove_prefix(end == std::string_view::npos ? line.size() : end + 1);
  }
  line = line.substr(0, line.find('\n'));
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos) {
    const std::size_t colon = line.find(':');
    return colon != std::string_view::npos ? " (a key is written name = value, not name: value)" : "";
  }
  std::string_view value = line.substr(equals + 1);
  while (!value.empty() && (value.front() == ' ' || value.front() == '\t')) value.remove_prefix(1);
  while (!value.empty() && (value.back() == ' ' || value.back() == '\t' || value.back() == '\r')) value.remove_suffix(1);
  const bool quoted = value.find_first_of("\"'[{#") != std::string_view::npos;
  if (value.empty() || quoted) return "";
  if (value.find(',') != std::string_view::npos) return " (decimal numbers are written with a point, lists in [ ])";
  if (value == "True" || value == "False" || value == "yes" || value == "no" || value == "on" || value == "off")
    return " (write true or false)";
  std::string out = " (text needs quotes: ";
  return out.append(printable(line.substr(0, equals), 40)).append("= \"").append(printable(value, 40)).append("\")");
}

}  // namespace

const Member* Value::find(std::string_view key) const {
  for (const Member& member : members)
    if (member.key == key) return &member;
  return nullptr;
}

Member* Value::find(std::string_view key) { return const_cast<Member*>(static_cast<const Value*>(this)->find(key)); }

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
  fault.message = printable(result.error().description(), 200).append(syntax_hint(text, fault.place.line));
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

}  // namespace ft
