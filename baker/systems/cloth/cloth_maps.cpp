#include "baker/systems/cloth/cloth_maps.h"

#include <algorithm>
#include <array>

#include "io/shot/shot_keys.h"
#include "io/shot/words.h"

namespace ft::inline baker {
namespace {

// The range of mass_per_area is the fabric key's; the stiffness of real garments varies by less than the factors here.
constexpr std::array<MapKind, 4> k_kinds = {{
    {"stretch", 0.01, 100, "1", "stiffness stretch_factor shear stretch_stiffness membrane stretch_warp stretch_weft"},
    {"bend", 0, 1000, "1", "bending bend_factor bend_stiffness rigidity bend_warp bend_weft"},
    {"thickness", 0.5e-3, 10e-3, "m", "contact_radius gap padding"},
    {"mass_per_area", 0.02, 2, "kg/m2", "mass density weight"},
}};

/// What may have been meant by a word that is no kind.
std::string guess(const std::string& word) {
  for (const MapKind& kind : k_kinds)
    if (is_synonym(kind.also, word)) return "did you mean \"" + std::string(kind.name) + "\"?";
  if (is_synonym("pin pins pin_weight pin_weights", word))
    return "pins take weights themselves: pins = [ { group = \"red\" } ] or [ { file = \"weights.csv\" } ]";
  return suggestion(word, map_words());
}

void judge_source(const std::string& owner, const Value& value, const MapSpec& map, FaultList& faults) {
  const Member *from = value.find("from"), *file = value.find("file");
  if (from && file)
    faults.add(value.place, owner + ": has both from and file; a map takes its values from one of them");
  else if (!from && !file)
    faults.add(value.place,
               owner + ": needs from = \"red\" (a colour channel or vertex group) or file = \"values.csv\"");
  if (from && map.from.empty() && from->value.kind == Value::Kind::k_text)
    faults.add(from->value.place, owner + ": from is empty; it names a vertex group or a colour channel");
  judge_column(owner, value, faults);
}

}  // namespace

std::span<const MapKind> map_kinds() {
  return k_kinds;
}

const MapKind* find_map_kind(std::string_view name) {
  const auto found = std::find_if(k_kinds.begin(), k_kinds.end(), [&](const MapKind& k) { return k.name == name; });
  return found == k_kinds.end() ? nullptr : &*found;
}

std::vector<std::string> map_words() {
  std::vector<std::string> out;
  for (const MapKind& kind : k_kinds) out.emplace_back(kind.name);
  return out;
}

void judge_column(const std::string& owner, const Value& value, FaultList& faults) {
  const Member* column = value.find("column");
  if (column && !value.find("file"))
    faults.add(column->place, owner + ": column is a column of a file, and there is no file");
}

void judge_map(const std::string& owner, const Value& value, const MapSpec& map, FaultList& faults) {
  judge_source(owner, value, map, faults);
  const Member *low = value.find("low"), *high = value.find("high"), *of = value.find("of");
  const std::string ends = "the values where the weight is 0 and where it is 1";
  if (low && !high) faults.add(low->place, owner + ": low needs high beside it, " + ends);
  if (high && !low) faults.add(high->place, owner + ": high needs low beside it, " + ends);
  if (!low && !high && value.find("from") && !value.find("file"))
    faults.add(value.place, owner + ": from needs low and high, " + ends);
  const MapKind* kind = find_map_kind(map.of);
  if (!kind && of && of->value.kind == Value::Kind::k_text)
    faults.add(of->value.place,
               with_hint(owner + ": of = " + in_quotes(map.of) + " is nothing that can vary", guess(map.of)));
  if (!kind) return;
  for (const Member* end : {low, high})
    if (end && (end->value.kind == Value::Kind::k_integer || end->value.kind == Value::Kind::k_number))
      ValueReader{faults, owner, end->key}.number(end->value, {kind->lowest, kind->highest, kind->unit});
}

void judge_maps(const std::string& owner, const Value& list, std::span<const MapSpec> maps, FaultList& faults) {
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const bool twice = std::any_of(maps.begin(), maps.begin() + static_cast<std::ptrdiff_t>(i),
                                   [&](const MapSpec& earlier) { return earlier.of == maps[i].of; });
    if (!twice || !find_map_kind(maps[i].of)) continue;
    const bool in_list = list.kind == Value::Kind::k_list && i < list.items.size();
    faults.add(in_list ? list.items[i].place : list.place, owner + ": " + maps[i].of + " has two maps; it takes one");
  }
}

}  // namespace ft::inline baker
