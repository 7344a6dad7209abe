#include "io/shot/shot_judge.h"

#include <algorithm>

#include "io/shot/chains.h"
#include "io/shot/secondary.h"
#include "io/shot/words.h"

namespace ft::inline io {
namespace {

constexpr int k_most_frames = 100'000;

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// A secondary goes by its kind, too: "cloth.robe".
std::string suggestion_of_wearer(const SecondarySpec& spec, std::vector<std::string> primaries,
                                 const std::vector<std::string>& carriers) {
  for (const std::string& carrier : carriers)
    if (carrier.ends_with("." + spec.on)) return "did you mean " + in_quotes(carrier) + "?";
  if (spec.on.find('.') != std::string::npos)
    for (const std::string& carrier : carriers)
      if (carrier != spec.reference()) primaries.push_back(carrier);
  return suggestion(spec.on, primaries);
}

/// carriers: what other secondaries are called, which it may be on as well.
void judge_wearer(const Value& root, SecondarySpec& spec, const std::vector<std::string>& primaries,
                  const std::vector<std::string>& carriers, FaultList& faults) {
  const std::string owner = spec.owner();
  for (const std::string& name : spec.section->system_names(spec))
    if (contains(primaries, name))
      faults.add(place_of(root, {spec.kind(), spec.name}), owner + ": a primary has the same name" +
                                                               (name == spec.name ? "" : " as its " + in_quotes(name)) +
                                                               ", their caches would overwrite each other");
  const bool is_clear = primaries.size() == 1 || (!primaries.empty() && !spec.section->needs_on());
  if (spec.on.empty() && is_clear) spec.on = primaries.front();
  if (primaries.empty() || contains(primaries, spec.on) || contains(carriers, spec.on)) return;
  const Place place = place_of(root, {spec.kind(), spec.name, "on"});
  if (spec.on.empty())
    faults.add(place, owner + ": on is missing; it says " + std::string(spec.section->whom()) +
                          " (one of: " + joined(primaries) + ")");
  else
    faults.add(place, with_hint(owner + ": on = " + in_quotes(spec.on) + " names no primary",
                                suggestion_of_wearer(spec, primaries, carriers)));
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

void judge_whole(const Value& root, Shot& shot, const ShotVocabulary& vocabulary, FaultList& faults) {
  if (root.find("shot") == nullptr) faults.add({}, "has no [shot] section: frames = \"1-100\" is needed");
  if (shot.primaries.empty()) faults.add({}, "has no [primary.NAME] section: the character that the cloth is worn by");
  if (shot.secondaries.empty() && shot.standins.empty()) {
    std::vector<std::string> kinds;
    for (const SecondarySection* section : vocabulary.sections)
      kinds.push_back(std::string("[").append(section->name()).append(".NAME]"));
    faults.add({}, "has no " + joined(kinds, " or ") + " section: there is nothing to bake");
  }
  const int low = shot.solver.min_substeps, high = shot.solver.max_substeps;
  if (low > high) {
    const Member* solver = root.find("solver");
    const bool says_low = solver != nullptr && solver->value.find("min_substeps") != nullptr;
    faults.add(place_of(root, {"solver", says_low ? "min_substeps" : "max_substeps"}),
               "[solver]: min_substeps = " + std::to_string(low) + " is above max_substeps = " + std::to_string(high));
  }
  std::vector<std::string> primaries;
  for (const PrimarySpec& primary : shot.primaries) primaries.push_back(primary.name);
  std::vector<std::string> carriers;
  for (const auto& secondary : shot.secondaries) carriers.push_back(secondary->reference());
  for (const auto& secondary : shot.secondaries) judge_wearer(root, *secondary, primaries, carriers, faults);
  for (std::size_t i = 0; i < shot.secondaries.size(); ++i) {
    const SecondarySpec& own = *shot.secondaries[i];
    const std::vector<std::string> names = own.section->system_names(own);
    for (std::size_t k = 0; k < i; ++k) {
      const SecondarySpec& other = *shot.secondaries[k];
      for (const std::string& name : other.section->system_names(other))
        if (contains(names, name))
          faults.add(
              place_of(root, {own.kind(), own.name}),
              own.owner() + ": " +
                  (name == own.name && name == other.name ? "a " + std::string(other.kind()) + " has the same name"
                                                          : other.owner() + " makes " + in_quotes(name) + ", too") +
                  ", their caches would overwrite each other");
    }
  }
  for (const auto& secondary : shot.secondaries) secondary->section->judge(root, *secondary, shot, faults);
  judge_couplings(root, shot, faults);
  judge_winds(root, shot, faults);
  judge_chains(root, shot, faults);
}

}  // namespace ft::inline io
