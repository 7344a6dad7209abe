// Fields of moving air: which keys go with which kind, and what would not blow.
#include <algorithm>

#include "io/shot/choice_keys.h"
#include "io/shot/shot_judge.h"
#include "io/shot/words.h"

namespace ft::inline io {
namespace {

constexpr ChoiceKeys k_winds[] = {
    {"uniform", "velocity", "gusts gust_time seed roughness_length reference_height ground"},
    {"source", "flow", "position radius"},
    {"sink", "flow", "position radius"},
    {"vortex", "circulation", "position axis radius"},
    {"doublet", "velocity", "position radius"},
    {"turbulence", "intensity", "length velocity seed"},
    {"grid", "file", "grid unit_scale up position"},
    {"wake", "", "of parts drag_area turbulence seed"},
};

/// What a field lacks to do anything; empty: nothing.
std::string_view lacks(const WindKeys& w, const Value& table) {
  // What the file says, for what it says out of range has its own fault.
  const auto is_zero = [&](std::string_view key) {
    const Member* member = table.find(key);
    if (!member) return false;
    const Value& value = member->value;
    return value.items.empty() ? value.number == 0
                               : std::ranges::all_of(value.items, [](const Value& v) { return v.number == 0; });
  };
  if ((w.kind == "uniform" || w.kind == "doublet") && is_zero("velocity")) return "a direction: its velocity is 0";
  if (w.kind == "vortex" && is_zero("axis")) return "a direction: its axis is 0";
  if ((w.kind == "source" || w.kind == "sink") && is_zero("flow")) return "a flow above 0";
  if (w.kind == "vortex" && is_zero("circulation")) return "a circulation";
  if (w.kind == "turbulence" && is_zero("intensity")) return "an intensity above 0";
  return {};
}

void judge_wind(const Value& table, const Shot& shot, WindKeys& wind, FaultList& faults) {
  const std::string owner = "wind " + in_quotes(wind.name);
  judge_choice(owner, table, "kind", wind.kind, k_winds, faults);
  if (const std::string_view what = lacks(wind, table); !what.empty())
    faults.add(table.place, owner + ": does nothing without " + std::string(what));
  for (const char* key : {"reference_height", "ground"})
    if (const Member* alone = table.find(key); alone && wind.kind == "uniform" && !wind.roughness_length)
      faults.add(alone->place, owner + ": " + key + " does nothing without roughness_length");
  if (const Member* rough = table.find("roughness_length");
      rough && wind.roughness_length && !(*wind.roughness_length < wind.reference_height))
    faults.add(rough->place, owner + ": roughness_length = " + number_text(*wind.roughness_length) +
                                 " is not below reference_height = " + number_text(wind.reference_height));
  if (const Member* until = table.find("until"); until && wind.from && wind.until && !(*wind.from < *wind.until))
    faults.add(until->place, owner + ": until = " + number_text(*wind.until) +
                                 " is not after from = " + number_text(*wind.from) + ": it would never blow");
  if (wind.kind != "wake" || shot.primaries.empty()) return;
  std::vector<std::string> primaries;
  for (const PrimarySpec& primary : shot.primaries) primaries.push_back(primary.name);
  const Member* of = table.find("of");
  if (!of && primaries.size() == 1)
    wind.of = primaries.front();
  else if (!of)
    faults.add(table.place, owner + ": of is missing; it says whose wake it is (one of: " + joined(primaries) + ")");
  else if (std::find(primaries.begin(), primaries.end(), wind.of) == primaries.end())
    faults.add(of->value.place,
               with_hint(owner + ": of = " + in_quotes(wind.of) + " names no primary", suggestion(wind.of, primaries)));
}

}  // namespace

void judge_winds(const Value& root, Shot& shot, FaultList& faults) {
  for (WindKeys& wind : shot.winds)
    if (const Value* table = section_of(root, "wind", wind.name)) judge_wind(*table, shot, wind, faults);
}

}  // namespace ft::inline io
