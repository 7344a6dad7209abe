#include "io/shot/shot_judge.h"

#include <algorithm>

#include "io/shot/words.h"

namespace ft {
namespace {

constexpr int k_most_frames = 100'000;

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// kind: "cloth" or "cords".
template <class Spec>
void judge_wearer(const Value& root, std::string_view kind, Spec& spec, const std::vector<std::string>& primaries,
                  FaultList& faults) {
  const std::string owner = std::string(kind) + " " + in_quotes(spec.name);
  if (contains(primaries, spec.name))
    faults.add(place_of(root, {kind, spec.name}),
               owner + ": a primary has the same name, their caches would overwrite each other");
  if (spec.on.empty() && primaries.size() == 1) spec.on = primaries.front();
  if (primaries.empty() || contains(primaries, spec.on)) return;
  const Place place = place_of(root, {kind, spec.name, "on"});
  if (spec.on.empty())
    faults.add(place, owner + ": on is missing; it says " + (kind == "cloth" ? "who wears it" : "whom they meet") +
                          " (one of: " + joined(primaries) + ")");
  else
    faults.add(place,
               with_hint(owner + ": on = " + in_quotes(spec.on) + " names no primary", suggestion(spec.on, primaries)));
}

/// Pins that hold to a cloth: only what one primary wears is solved together.
void judge_attachments(const Value& root, const ClothSpec& cloth, const std::vector<ClothSpec>& cloths,
                       const std::vector<std::string>& primaries, FaultList& faults) {
  const Place place = place_of(root, {"cloth", cloth.name, "pins"});
  std::vector<std::string> names;
  for (const ClothSpec& other : cloths) names.push_back(other.name);
  for (const PinSpec& pin : cloth.pins) {
    if (pin.to.empty() || pin.to == k_pin_world) continue;
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

void read_teleports(const ValueReader& reader, const Value& value, const Allowed& frames, PrimarySpec& spec) {
  const bool number = value.kind == Value::Kind::k_integer || value.kind == Value::Kind::k_number;
  if (value.kind == Value::Kind::k_text) {
    if (!reader.is_one_of(value, value.text, std::vector<std::string>{"detect", "ignore"})) return;
    spec.teleports = value.text == "detect" ? Teleports::k_detect : Teleports::k_ignore;
  } else if (value.kind == Value::Kind::k_list || number) {
    spec.teleports = Teleports::k_frames;
    for (const Value& item : number ? std::vector<Value>{value} : value.items)
      if (const auto frame = reader.number(item, frames)) spec.teleport_frames.push_back(static_cast<int>(*frame));
    auto& all = spec.teleport_frames;
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
  } else {
    reader.fault(value, "needs \"detect\", \"ignore\" or a list of frames like [1041], not " + describe(value));
  }
}

void read_release(const ValueReader& reader, const Value& value, const Allowed& frames, PrimarySpec& spec) {
  if (value.kind == Value::Kind::k_integer || value.kind == Value::Kind::k_number) {
    const auto frame = reader.number(value, frames);
    if (frame) spec.release = Release::k_frame, spec.release_frame = *frame;
  } else if (value.kind == Value::Kind::k_text && value.text == "contact") {
    spec.release = Release::k_contact;
  } else {
    reader.fault(value, "needs a frame or \"contact\", not " + describe(value));
  }
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
    if (const Member* member = value.find(key); member && value.find("to") && pin.to != k_pin_world)
      faults.add(member->place, owner + ": " + key + " does not go with to: a cloth is held as firmly as by a seam; " +
                                    "weights below 1 (file, group) hold it less");
}

void judge_whole(const Value& root, Shot& shot, FaultList& faults) {
  if (root.find("shot") == nullptr) faults.add({}, "has no [shot] section: frames = \"1-100\" is needed");
  if (shot.primaries.empty()) faults.add({}, "has no [primary.NAME] section: the character that the cloth is worn by");
  if (shot.cloths.empty() && shot.cords.empty() && shot.standins.empty())
    faults.add({}, "has no [cloth.NAME] or [cords.NAME] section: there is nothing to bake");
  const int low = shot.solver.min_substeps, high = shot.solver.max_substeps;
  if (low > high) {
    const Member* solver = root.find("solver");
    const bool says_low = solver != nullptr && solver->value.find("min_substeps") != nullptr;
    faults.add(place_of(root, {"solver", says_low ? "min_substeps" : "max_substeps"}),
               "[solver]: min_substeps = " + std::to_string(low) + " is above max_substeps = " + std::to_string(high));
  }
  std::vector<std::string> primaries;
  for (const PrimarySpec& primary : shot.primaries) primaries.push_back(primary.name);
  for (ClothSpec& cloth : shot.cloths) judge_wearer(root, "cloth", cloth, primaries, faults);
  for (CordsSpec& cords : shot.cords) {
    judge_wearer(root, "cords", cords, primaries, faults);
    if (std::any_of(shot.cloths.begin(), shot.cloths.end(), [&](const auto& c) { return c.name == cords.name; }))
      faults.add(place_of(root, {"cords", cords.name}), "cords " + in_quotes(cords.name) +
                                                            ": a cloth has the same name, their caches would overwrite "
                                                            "each other");
  }
  for (const ClothSpec& cloth : shot.cloths) judge_attachments(root, cloth, shot.cloths, primaries, faults);
  judge_couplings(root, shot, faults);
}

}  // namespace ft
