#include "io/shot/shot_judge.h"

#include <algorithm>
#include <initializer_list>

#include "io/shot/words.h"

namespace ft {
namespace {

constexpr int k_most_frames = 100'000;

/// Where a path of keys stands; as far as it exists.
Place place_of(const Value& root, std::initializer_list<std::string_view> path) {
  const Value* value = &root;
  Place place;
  for (const std::string_view key : path) {
    const Member* member = value->find(key);
    if (member == nullptr) break;
    place = member->place;
    value = &member->value;
    if (value->kind != Value::Kind::k_table) return value->place;
  }
  return place;
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

void judge_wearer(const Value& root, ClothSpec& cloth, const std::vector<std::string>& primaries, FaultList& faults) {
  const std::string owner = "cloth " + in_quotes(cloth.name);
  if (contains(primaries, cloth.name))
    faults.add(place_of(root, {"cloth", cloth.name}),
               owner + ": a primary has the same name, their caches would overwrite each other");
  if (cloth.on.empty() && primaries.size() == 1) cloth.on = primaries.front();
  if (primaries.empty() || contains(primaries, cloth.on)) return;
  const Place place = place_of(root, {"cloth", cloth.name, "on"});
  if (cloth.on.empty())
    faults.add(place, owner + ": on is missing; it says who wears it (one of: " + joined(primaries) + ")");
  else
    faults.add(place, with_hint(owner + ": on = " + in_quotes(cloth.on) + " names no primary",
                                suggestion(cloth.on, primaries)));
}

/// Pins that hold to a cloth: only what one primary wears is solved together.
void judge_attachments(const Value& root, const ClothSpec& cloth, const std::vector<ClothSpec>& cloths,
                       const std::vector<std::string>& primaries, FaultList& faults) {
  const Place place = place_of(root, {"cloth", cloth.name, "pins"});
  std::vector<std::string> names;
  for (const ClothSpec& other : cloths) names.push_back(other.name);
  for (const PinSpec& pin : cloth.pins) {
    if (pin.to.empty()) continue;
    const std::string fault = "cloth " + in_quotes(cloth.name) + ": to = " + in_quotes(pin.to);
    const auto held = std::find(names.begin(), names.end(), pin.to) - names.begin();
    if (held == std::ssize(names))
      faults.add(place, with_hint(fault + " names no cloth", contains(primaries, pin.to)
                                                                 ? "a pin without to holds to the primary"
                                                                 : suggestion(pin.to, names)));
    else if (cloths[static_cast<std::size_t>(held)].on != cloth.on)
      faults.add(place, fault + " is worn by another primary; only cloths on the same one can hold each other");
    else if (pin.to == cloth.name && pin.select == PinSpec::Select::k_within)
      faults.add(place,
                 fault + " is the cloth itself, to which all of it is near: say which side by group, vertices or file");
  }
}

}  // namespace

std::optional<FrameRange> read_frames(const ValueReader& reader, const Value& value) {
  std::string shown, fault;
  if (value.kind == Value::Kind::k_integer) {
    shown = std::to_string(value.integer);
  } else if (value.kind == Value::Kind::k_list && value.items.size() == 2 &&
             value.items[0].kind == Value::Kind::k_integer && value.items[1].kind == Value::Kind::k_integer) {
    reader.fault(value, "needs a text, not a list (write \"" + std::to_string(value.items[0].integer) + "-" +
                            std::to_string(value.items[1].integer) + "\")");
    return {};
  } else if (const auto text = reader.text(value)) {
    shown = *text;
  } else {
    return {};
  }
  FrameRange range;
  if (!parse_frames(shown, range, fault)) {
    reader.fault(value, "= " + in_quotes(shown) + " " + fault);
    return {};
  }
  if (range.last - range.first >= k_most_frames) {
    reader.fault(value, "= " + frames_text(range) + " has " + std::to_string(range.last - range.first + 1) +
                            " frames, at most " + std::to_string(k_most_frames) + " are baked at once");
    return {};
  }
  return range;
}

void read_vertices(const ValueReader& reader, const Value& value, std::vector<int>& out) {
  const bool list = value.kind == Value::Kind::k_list;
  std::string text, fault;
  for (const Value& item : list ? std::span(value.items) : std::span(&value, 1)) {
    if (item.kind != Value::Kind::k_text && item.kind != Value::Kind::k_integer)
      return reader.fault(item, "needs vertices like \"0-199\" or [0, 1, 2], not " + describe(item));
    if (!text.empty()) text.append(",");
    text.append(item.kind == Value::Kind::k_integer ? std::to_string(item.integer) : item.text);
  }
  if (list && value.items.empty()) return reader.fault(value, "is empty");
  std::vector<int> vertices;
  if (parse_vertices(text, vertices, fault))
    out = std::move(vertices);
  else
    reader.fault(value, fault);
}

void judge_hold(const std::string& owner, const Value& value, const PinSpec& pin, FaultList& faults) {
  const Member *until = value.find("until"), *fade = value.find("fade"), *opens = value.find("opens");
  if (until && pin.from && pin.until && !(*pin.from < *pin.until))
    faults.add(until->place, owner + ": until = " + number_text(*pin.until) +
                                 " is not after from = " + number_text(*pin.from) + ": it would never hold");
  if (fade && !until && !value.find("from"))
    faults.add(fade->place, owner + ": fade needs until (or from), the frame at which it begins");
  if (opens && !(pin.fade > 0))
    faults.add(opens->place, owner + ": opens needs fade, the frames that it takes from one end to the other");
  for (const char* key : {"stiffness", "max_pull"})
    if (const Member* member = value.find(key); member && value.find("to"))
      faults.add(member->place, owner + ": " + key + " does not go with to: a cloth is held as firmly as by a seam; " +
                                    "weights below 1 (file, group) hold it less");
}

void judge_whole(const Value& root, Shot& shot, FaultList& faults) {
  if (root.find("shot") == nullptr) faults.add({}, "has no [shot] section: frames = \"1-100\" is needed");
  if (shot.primaries.empty()) faults.add({}, "has no [primary.NAME] section: the character that the cloth is worn by");
  if (shot.cloths.empty()) faults.add({}, "has no [cloth.NAME] section: there is nothing to bake");
  const int low = shot.solver.min_substeps, high = shot.solver.max_substeps;
  if (low > high) {
    const Member* solver = root.find("solver");
    const bool says_low = solver != nullptr && solver->value.find("min_substeps") != nullptr;
    faults.add(place_of(root, {"solver", says_low ? "min_substeps" : "max_substeps"}),
               "[solver]: min_substeps = " + std::to_string(low) + " is above max_substeps = " + std::to_string(high));
  }
  std::vector<std::string> primaries;
  for (const PrimarySpec& primary : shot.primaries) primaries.push_back(primary.name);
  for (ClothSpec& cloth : shot.cloths) judge_wearer(root, cloth, primaries, faults);
  for (const ClothSpec& cloth : shot.cloths) judge_attachments(root, cloth, shot.cloths, primaries, faults);
}

}  // namespace ft
