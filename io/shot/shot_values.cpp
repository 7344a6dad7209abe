#include "io/shot/shot_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "io/shot/words.h"

namespace ft::inline io {
namespace {

/// A unit that people write instead of ours: value in `unit` times `factor` is in `our_unit`.
struct UnitSlip {
  std::string_view our_unit, unit;
  double factor;
};

constexpr UnitSlip k_slips[] = {
    {"kg/m2", "g/m2", 1e-3}, {"kg/m2", "gsm", 1e-3},   {"kg/m2", "oz/yd2", 0.0339057},
    {"m", "mm", 1e-3},       {"m", "cm", 1e-2},        {"m", "inch", 0.0254},
    {"m", "in", 0.0254},     {"m", "ft", 0.3048},      {"m", "km", 1e3},
    {"1", "%", 1e-2},        {"m/s", "km/h", 1 / 3.6}, {"m/s", "kmh", 1 / 3.6},
    {"m/s", "mph", 0.44704}, {"m/s", "cm/s", 1e-2},    {"s", "ms", 1e-3},
    {"s", "min", 60},        {"N/m", "N/mm", 1e3},     {"N/m", "N/cm", 1e2},
    {"N/m", "kN/m", 1e3},    {"N m", "uN m", 1e-6},    {"N m", "gf cm2/cm", 9.80665e-5},
    {"N m", "N mm", 1e-3},   {"Pa", "kPa", 1e3},       {"Pa", "MPa", 1e6},
    {"m/s2", "cm/s2", 1e-2}, {"m/s2", "g", 9.80665},
};

bool in_range(double value, const Allowed& allowed) {
  return (allowed.lowest == 0 && allowed.highest == 0) || (value >= allowed.lowest && value <= allowed.highest);
}

/// Six digits are enough for a hint: 150/3.6 is written 41.6667.
std::string short_number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string range_text(const Allowed& allowed) {
  std::string out = "[";
  out.append(number_text(allowed.lowest)).append(", ").append(number_text(allowed.highest)).append("]");
  if (!allowed.unit.empty() && allowed.unit != "1") out.append(" ").append(allowed.unit);
  return out;
}

/// Units as people write them: without blanks, "^" or superscripts.
std::string folded_unit(std::string_view unit) {
  std::string out;
  for (const char c : unit)
    if (c != ' ' && c != '^' && c != '*' && c != '.' && c != '"') out.push_back(c);
  for (const auto& [from, to] :
       {std::pair<std::string_view, std::string_view>{"\xc2\xb2", "2"}, {"\xc2\xb7", ""}, {"\xc2\xb5", "u"}})
    for (std::size_t i = out.find(from); i != std::string::npos; i = out.find(from)) out.replace(i, from.size(), to);
  return out;
}

/// A hint for a number in quotes: `"5 mm"` is written 0.005, `"5"` is written 5.
std::string number_in_text(std::string_view text, const Allowed& allowed) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc{} || !std::isfinite(value)) return {};
  const std::string unit = folded_unit({end, static_cast<std::size_t>(text.data() + text.size() - end)});
  if (unit.empty() || unit == folded_unit(allowed.unit))
    return std::string("write ").append(number_text(value)).append(" without quotes");
  for (const UnitSlip& slip : k_slips)
    if (slip.our_unit == allowed.unit && folded_unit(slip.unit) == unit)
      return printable(text).append(" is written ").append(short_number(value * slip.factor));
  return {};
}

}  // namespace

std::string in_quotes(std::string_view word) {
  return std::string("\"").append(printable(word)).append("\"");
}

std::string with_hint(std::string what, const std::string& hint) {
  return hint.empty() ? what : what.append(" (").append(hint).append(")");
}

void FaultList::add(const Place& place, std::string text, bool missing_file) {
  entries_.push_back({place, std::move(text), missing_file});
}

bool FaultList::only_missing_files() const {
  return std::all_of(entries_.begin(), entries_.end(), [](const Entry& e) { return e.missing_file; });
}

std::vector<FaultList::Entry> FaultList::sorted() const {
  std::vector<Entry> out = entries_;
  // What stands in the file first, then what is missing from it (line 0), then the command line.
  const auto rank = [](const Entry& e) { return e.place.line > 0 ? 0 : e.place.command.empty() ? 1 : 2; };
  std::stable_sort(out.begin(), out.end(), [&](const Entry& a, const Entry& b) {
    if (rank(a) != rank(b)) return rank(a) < rank(b);
    return a.place.line != b.place.line ? a.place.line < b.place.line : a.place.column < b.place.column;
  });
  return out;
}

namespace {
std::string place_text(std::string_view file, const Place& place) {
  if (!place.command.empty()) return place.command;
  std::string out(file);
  if (place.line > 0)
    out.append(":").append(std::to_string(place.line)).append(":").append(std::to_string(place.column));
  return out;
}
}  // namespace

std::vector<std::string> FaultList::texts(std::string_view file) const {
  std::vector<std::string> out;
  for (const Entry& e : sorted()) {
    if (out.size() == 200) {
      out.push_back(
          std::string(file).append(": and ").append(std::to_string(entries_.size() - 200)).append(" more faults"));
      break;
    }
    out.push_back(place_text(file, e.place).append(": ").append(e.text));
  }
  return out;
}

std::pair<std::string, std::string> FaultList::first(std::string_view file) const {
  const std::vector<Entry> all = sorted();
  return {all.front().text, place_text(file, all.front().place)};
}

void ValueReader::fault(const Value& value, std::string what, bool missing_file) const {
  faults.add(value.place, std::string(owner).append(": ").append(key).append(" ").append(what), missing_file);
}

std::optional<double> ValueReader::number(const Value& value, const Allowed& allowed) const {
  const bool is_number = value.kind == Value::Kind::k_integer || value.kind == Value::Kind::k_number;
  const char* wanted = allowed.whole ? "needs a whole number, not " : "needs a number, not ";
  if (!is_number) {
    const std::string hint = value.kind == Value::Kind::k_text ? number_in_text(value.text, allowed) : std::string();
    fault(value, with_hint(std::string(wanted).append(describe(value)), hint));
    return {};
  }
  if (!std::isfinite(value.number) || (allowed.whole && value.number != std::floor(value.number))) {
    fault(value, std::string(wanted).append(number_text(value.number)));
    return {};
  }
  if (!in_range(value.number, allowed)) {
    fault(value,
          with_hint(
              std::string("= ").append(number_text(value.number)).append(" is outside ").append(range_text(allowed)),
              unit_slip(value.number, allowed)));
    return {};
  }
  return value.number;
}

std::optional<bool> ValueReader::flag(const Value& value) const {
  if (value.kind == Value::Kind::k_flag) return value.flag;
  std::string hint;
  const std::string word = value.kind == Value::Kind::k_text ? value.text : number_text(value.number);
  for (const char* yes : {"true", "True", "TRUE", "yes", "on", "1"})
    if (word == yes) hint = "write true";
  for (const char* no : {"false", "False", "FALSE", "no", "off", "0"})
    if (word == no && value.kind != Value::Kind::k_table && value.kind != Value::Kind::k_list) hint = "write false";
  fault(value, with_hint(std::string("needs true or false, not ").append(describe(value)), hint));
  return {};
}

std::optional<std::string> ValueReader::text(const Value& value) const {
  std::string out = value.text;
  if (value.kind != Value::Kind::k_text) {
    const bool word = value.loose && value.kind != Value::Kind::k_list && value.kind != Value::Kind::k_table;
    if (!word) {
      const bool number_like = value.kind == Value::Kind::k_integer || value.kind == Value::Kind::k_number;
      fault(value, with_hint(std::string("needs a text, not ").append(describe(value)),
                             number_like ? std::string("write \"").append(number_text(value.number)).append("\"")
                                         : std::string()));
      return {};
    }
  }
  if (std::any_of(out.begin(), out.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; })) {
    fault(value, std::string("has control characters in \"")
                     .append(printable(out))
                     .append("\" (a backslash is written \\\\ or in '...')"));
    return {};
  }
  return out;
}

std::optional<Vec3> ValueReader::vector(const Value& value, const Allowed& allowed) const {
  if (value.kind != Value::Kind::k_list || value.items.size() != 3) {
    std::string what = "needs three numbers [x, y, z], not ";
    what.append(value.kind == Value::Kind::k_list ? std::string("a list of ").append(std::to_string(value.items.size()))
                                                  : describe(value));
    fault(value, std::move(what));
    return {};
  }
  Vec3 out;
  bool good = true;
  for (int k = 0; k < 3; ++k) {
    const auto component = number(value.items[static_cast<std::size_t>(k)], allowed);
    good = good && component.has_value();
    out[k] = component.value_or(0);
  }
  return good ? std::optional<Vec3>(out) : std::nullopt;
}

std::optional<std::vector<std::string>> ValueReader::texts(const Value& value) const {
  if (value.kind != Value::Kind::k_list) {
    const auto one = text(value);
    return one ? std::optional<std::vector<std::string>>({*one}) : std::nullopt;
  }
  std::vector<std::string> out;
  bool good = true;
  for (const Value& item : value.items) {
    const auto word = text(item);
    good = good && word.has_value();
    if (!word) continue;
    if (std::find(out.begin(), out.end(), *word) != out.end())
      fault(item, std::string("names ").append(in_quotes(*word)).append(" twice"));
    out.push_back(*word);
  }
  return good ? std::optional(out) : std::nullopt;
}

bool ValueReader::is_one_of(const Value& value, const std::string& word, std::span<const std::string> choices) const {
  if (choices.empty() || std::find(choices.begin(), choices.end(), word) != choices.end()) return true;
  fault(value,
        with_hint(std::string("= \"").append(printable(word)).append("\" is not known"), suggestion(word, choices)));
  return false;
}

std::optional<std::filesystem::path> ValueReader::file(const Value& value, const std::filesystem::path& folder) const {
  const auto name = text(value);
  if (!name) return {};
  if (name->empty()) {
    fault(value, "is empty; it needs the name of a file");
    return {};
  }
  const std::filesystem::path path = (folder / *name).lexically_normal();
  std::error_code ignored;
  // Patterns of file sequences ("body.####.obj") are judged by who reads them.
  const bool pattern = name->find_first_of("#%*") != std::string::npos;
  if (!pattern && !std::filesystem::exists(path, ignored)) {
    std::string hint = name->find('\\') != std::string::npos ? "folders are separated by /"
                       : name->starts_with("~")              ? "~ is not expanded; write the whole path"
                                                             : similar_file(path);
    fault(value, with_hint(std::string("= \"").append(printable(*name, 200)).append("\" does not exist"), hint), true);
  }
  return path;
}

std::string unit_slip(double value, const Allowed& allowed) {
  // Where several units would do, the one that lands nearest to the middle of the range: a height of 175 is in cm, not
  // in mm.
  const UnitSlip* best = nullptr;
  double best_distance = std::numeric_limits<double>::infinity();
  for (const UnitSlip& slip : k_slips) {
    const double in_ours = value * slip.factor;
    if (slip.our_unit != allowed.unit || value == 0 || !in_range(in_ours, allowed)) continue;
    const double middle = std::sqrt(allowed.lowest * allowed.highest);
    const double distance = middle > 0 ? std::abs(std::log(in_ours / middle)) : 1;
    if (distance < best_distance) best = &slip, best_distance = distance;
  }
  if (best == nullptr) return {};
  return number_text(value)
      .append(" ")
      .append(best->unit)
      .append(" is written ")
      .append(short_number(value * best->factor));
}

std::string similar_file(const std::filesystem::path& missing) {
  std::error_code fault;
  std::filesystem::path folder = missing.parent_path();
  if (folder.empty()) folder = ".";
  if (!std::filesystem::is_directory(folder, fault)) {
    // Walk up to the first folder that exists and name what is missing from it.
    std::filesystem::path gone = folder;
    while (gone.has_parent_path() && gone.parent_path() != gone &&
           !std::filesystem::is_directory(gone.parent_path(), fault))
      gone = gone.parent_path();
    if (gone == missing || gone == ".") return {};
    const std::string near = similar_file(gone);
    return std::string("there is no folder \"")
        .append(printable(gone.generic_string(), 200))
        .append(near.empty() ? "\"" : "\", ")
        .append(near);
  }
  std::vector<std::string> names;
  std::filesystem::directory_iterator entries(folder, fault);
  for (; !fault && entries != std::filesystem::directory_iterator() && names.size() < 10'000; entries.increment(fault))
    names.push_back(entries->path().filename().string());
  std::sort(names.begin(), names.end());
  // First among those of the same kind, then among all.
  const std::string wanted = missing.filename().string();
  std::vector<std::string> same_kind;
  std::copy_if(names.begin(), names.end(), std::back_inserter(same_kind),
               [&](const std::string& n) { return std::filesystem::path(n).extension() == missing.extension(); });
  std::string near = nearest_word(wanted, same_kind);
  if (near.empty()) near = nearest_word(wanted, names);
  if (near.empty() && !same_kind.empty())
    return std::string("there is \"")
        .append(joined(std::span(same_kind).first(std::min<std::size_t>(3, same_kind.size())), "\", \""))
        .append("\"");
  return near.empty() ? near : std::string("did you mean \"").append(near).append("\"?");
}

}  // namespace ft::inline io
