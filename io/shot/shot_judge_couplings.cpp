// Props, cords, stand-ins: which keys go with which shape or kind, and what their couplings ask for.
#include <algorithm>
#include <map>

#include "io/shot/shot_judge.h"
#include "io/shot/shot_keys.h"
#include "io/shot/words.h"

namespace ft {
namespace {

/// What goes with one choice of a key: keys that it needs, and that it takes. Keys of no row go with all.
struct ChoiceKeys {
  std::string_view word;  ///< empty: the key is not there
  std::string_view needs, takes;
};

constexpr ChoiceKeys k_primary_shapes[] = {
    {"", "file",
     "animation topology clip clip_start speed unit_scale up source_fps body height meshes ignore teleports limbs "
     "position rotation"},
    {"sphere", "radius", "position rotation velocity spin hollow"},
    {"box", "size", "position rotation velocity spin hollow"},
    {"capsule", "radius length", "position rotation velocity spin hollow"},
    {"ground", "", "size position"},
};

constexpr ChoiceKeys k_cords_shapes[] = {
    {"net", "", "columns rows radius_top radius_bottom length"},
    {"rope", "to", "held"},
    {"knots", "to", "knots knot_mass held"},
    {"mesh", "mesh", "unit_scale up held"},
};

constexpr ChoiceKeys k_standin_kinds[] = {
    {"damping", "shape",
     "position size radius_top radius_bottom height mesh soft_edge damping damping_quadratic "
     "damping_spin"},
    {"mat", "stiffness", "position size stiffness_cubic damping damping_ratio"},
    {"water", "", "position density drag slam"},
    {"spring", "stiffness anchor length", "stiffness_cubic damping damping_ratio"},
    {"weight", "mass", ""},
    {"fitted", "", "shape position size radius_top radius_bottom height mesh soft_edge"},
};

constexpr ChoiceKeys k_volume_shapes[] = {
    {"box", "size", ""},
    {"cone", "radius_top radius_bottom height", ""},
    {"mesh", "mesh", ""},
};

constexpr double k_most_cords = 1e6;

bool has(std::string_view words, std::string_view word) {
  const std::vector<std::string> all = split_words(words);
  return std::find(all.begin(), all.end(), word) != all.end();
}

/// Faults of keys that the chosen row needs, and of those that only other rows know. A word that is no row's has its
/// fault already.
void judge_choice(const std::string& owner, const Value& table, std::string_view key, std::string_view word,
                  std::span<const ChoiceKeys> rows, FaultList& faults) {
  const auto chosen = std::find_if(rows.begin(), rows.end(), [&](const ChoiceKeys& row) { return row.word == word; });
  if (chosen == rows.end()) return;
  const auto named = [&](std::string_view choice) {
    return choice.empty() ? std::string("file") : std::string(key) + " = " + in_quotes(choice);
  };
  for (const std::string& needed : split_words(chosen->needs))
    if (!table.find(needed))
      faults.add(table.place, owner + ": " + needed + " is missing; " + named(word) + " needs it");
  for (const Member& member : table.members) {
    if (has(chosen->needs, member.key) || has(chosen->takes, member.key)) continue;
    std::vector<std::string> others;
    for (const ChoiceKeys& row : rows)
      if (has(row.needs, member.key) || has(row.takes, member.key)) others.push_back(named(row.word));
    if (!others.empty())
      faults.add(member.place,
                 owner + ": " + member.key + " goes with " + joined(others, " or ") + ", not with " + named(word));
  }
}

/// The section of that kind and name; null where the file's own fault has been reported.
const Value* section(const Value& root, std::string_view kind, std::string_view name) {
  const Member* all = root.find(kind);
  const Member* one = all ? all->value.find(name) : nullptr;
  return one && one->value.kind == Value::Kind::k_table ? &one->value : nullptr;
}

void judge_primary(const Value& table, const Shot& shot, const PrimarySpec& primary, FaultList& faults) {
  const std::string owner = "primary " + in_quotes(primary.name);
  const Member *file = table.find("file"), *shape = table.find("shape");
  if (!file && !shape) {
    faults.add(table.place, owner + ": file is missing (a character or geometry cache), or shape, for a rigid prop");
  } else if (file && shape) {
    faults.add(shape->place, owner + ": has both file and shape; a primary is one of them");
  } else if (!shape || !primary.shape.empty()) {
    judge_choice(owner, table, "shape", primary.shape, k_primary_shapes, faults);
  }
  if (const Member* release = table.find("release");
      release && primary.release == Release::k_frame && primary.release_frame < shot.first_frame)
    faults.add(release->place, owner + ": release = " + number_text(primary.release_frame) +
                                   " is before the shot's first frame, " + std::to_string(shot.first_frame) +
                                   " (without release it is free from there on)");
  const bool part = (primary.inertia.array() > 0).any() && !(primary.inertia.array() > 0).all();
  const double most = primary.inertia.maxCoeff();
  if (const Member* inertia = table.find("inertia"); inertia && (part || 2 * most > primary.inertia.sum()))
    faults.add(inertia->place, owner +
                                   ": inertia is no body's: each moment is above 0 and at most the other two "
                                   "together");
}

/// Fills in what depends on its shape: where it is held, and in how many pieces.
void judge_cords(const Value& table, CordsSpec& cords, FaultList& faults) {
  const std::string owner = "cords " + in_quotes(cords.name);
  judge_choice(owner, table, "shape", cords.shape, k_cords_shapes, faults);
  const bool line = cords.shape == "rope" || cords.shape == "knots";
  const Member *held = table.find("held"), *knot_mass = table.find("knot_mass"), *to = table.find("to");
  if (line && held && held->value.kind == Value::Kind::k_text)
    ValueReader{faults, owner, "held"}.is_one_of(held->value, cords.held,
                                                 std::vector<std::string>{"start", "end", "both", "none"});
  if (line && !held) cords.held = "start";
  if (cords.points == 0) cords.points = cords.shape == "net" ? 2 : cords.shape == "rope" ? 32 : line ? 4 : 1;
  const double sides = cords.shape == "net"     ? 2.0 * cords.columns * cords.rows
                       : cords.shape == "knots" ? cords.knots
                                                : 1;
  if (sides * cords.points > k_most_cords)
    faults.add(table.place, owner + ": would be of " + number_text(sides * cords.points) + " pieces, at most " +
                                number_text(k_most_cords) + " are baked");
  if (line && to && cords.to == cords.position)
    faults.add(to->place, owner + ": to is where it starts; its length would be 0");
  if (cords.shape == "knots" && knot_mass && table.find("mass") && cords.knots * cords.knot_mass >= cords.mass)
    faults.add(knot_mass->place, owner + ": its knots weigh " + number_text(cords.knots * cords.knot_mass) +
                                     " kg, and all of it only mass = " + number_text(cords.mass));
}

struct Secondary {
  std::string kind, name, on, coupling;
  std::string owner() const { return kind + " " + in_quotes(name); }
};

/// What a stand-in lacks to do anything; empty: nothing.
std::string_view lacks(const StandInKeys& s, const Value& table) {
  if (s.shape == "cone" && table.find("height") && !(s.height > 0 && s.radius_top + s.radius_bottom > 0))
    return "a cone with height and radius";
  if (s.kind == "damping" && !(s.damping + s.damping_quadratic + s.damping_spin > 0))
    return "damping, damping_quadratic or damping_spin";
  if ((s.kind == "mat" || s.kind == "spring") && table.find("stiffness") && !(s.stiffness + s.stiffness_cubic > 0))
    return "a stiffness";
  if (s.kind == "weight" && table.find("mass") && !(s.mass > 0)) return "a mass";
  return {};
}

/// It stands for a secondary, or for something that is not baked here; then `on` names who meets it.
void judge_whom_it_meets(const Value& root, const Value& table, std::span<const Secondary> secondaries,
                         StandInKeys& standin, Shot& shot, FaultList& faults) {
  const std::string owner = "standin " + in_quotes(standin.name);
  const Member *stands_for = table.find("for"), *on = table.find("on");
  if (on && stands_for) {
    faults.add(on->place, owner + ": has both for and on; on is for what no cloth or cords are there for");
    standin.on.clear();
    return;
  }
  std::vector<std::string> names, primaries;
  for (const Secondary& secondary : secondaries) names.push_back(secondary.name);
  for (const PrimarySpec& primary : shot.primaries) primaries.push_back(primary.name);
  if (on || (!stands_for && names.empty())) {
    if (!on && primaries.size() == 1) standin.on = primaries.front();
    if (primaries.empty() || std::find(primaries.begin(), primaries.end(), standin.on) != primaries.end()) return;
    if (!on)
      faults.add(table.place, owner + ": on is missing; it says who meets it (one of: " + joined(primaries) + ")");
    else
      faults.add(on->value.place, with_hint(owner + ": on = " + in_quotes(standin.on) + " names no primary",
                                            suggestion(standin.on, primaries)));
    return;
  }
  if (standin.stands_for.empty() && names.size() == 1) standin.stands_for = names.front();
  const auto found = std::find(names.begin(), names.end(), standin.stands_for);
  if (standin.stands_for.empty())
    faults.add(table.place, owner + ": for is missing; it says what it stands for (one of: " + joined(names) + ")");
  else if (found == names.end())
    faults.add(place_of(root, {"standin", standin.name, "for"}),
               with_hint(owner + ": for = " + in_quotes(standin.stands_for) + " names no cloth or cords",
                         suggestion(standin.stands_for, names)));
  else if (const Secondary& of = secondaries[static_cast<std::size_t>(found - names.begin())]; of.coupling != "hybrid")
    shot.notes.push_back(owner + " is not used: " + of.owner() + " has coupling = " + in_quotes(of.coupling));
}

void judge_standin(const Value& root, const Value& table, std::span<const Secondary> secondaries, StandInKeys& standin,
                   Shot& shot, FaultList& faults) {
  const std::string owner = "standin " + in_quotes(standin.name);
  judge_choice(owner, table, "kind", standin.kind, k_standin_kinds, faults);
  judge_choice(owner, table, "shape", standin.shape, k_volume_shapes, faults);
  if (const std::string_view what = lacks(standin, table); !what.empty())
    faults.add(table.place, owner + ": does nothing without " + std::string(what) + " above 0");
  if (const Member* until = table.find("until");
      until && standin.from && standin.until && !(*standin.from < *standin.until))
    faults.add(until->place, owner + ": until = " + number_text(*standin.until) +
                                 " is not after from = " + number_text(*standin.from) + ": it would never act");
  if (const Member* ratio = table.find("damping_ratio"); ratio && table.find("damping"))
    faults.add(ratio->place, owner + ": has both damping and damping_ratio; one of them says how it is damped");
  judge_whom_it_meets(root, table, secondaries, standin, shot, faults);
}

void judge_pair(const Value& root, const Shot& shot, const Secondary& pair, FaultList& faults) {
  const Place place = place_of(root, {pair.kind, pair.name, "coupling"});
  const std::string fault = pair.owner() + ": coupling = " + in_quotes(pair.coupling);
  if (pair.coupling == "hybrid" && std::none_of(shot.standins.begin(), shot.standins.end(),
                                                [&](const StandInKeys& s) { return s.stands_for == pair.name; }))
    faults.add(place, fault + " needs what the primary yields to: a [standin.NAME] with for = " + in_quotes(pair.name));
  if (pair.coupling != "two-way") return;
  if (pair.kind == "cloth")
    faults.add(place, fault +
                          " is for cords so far: cloth is not stepped together with a primary (hybrid or one-way "
                          "is)");
  for (const PrimarySpec& primary : shot.primaries)
    if (primary.name == pair.on && !primary.mass)
      faults.add(place_of(root, {"primary", primary.name}), "primary " + in_quotes(primary.name) +
                                                                ": mass is missing; the two-way coupling of " +
                                                                pair.owner() + " needs it");
}

}  // namespace

void judge_couplings(const Value& root, Shot& shot, FaultList& faults) {
  for (const PrimarySpec& primary : shot.primaries)
    if (const Value* table = section(root, "primary", primary.name)) judge_primary(*table, shot, primary, faults);
  std::vector<Secondary> secondaries;
  for (const ClothSpec& cloth : shot.cloths) secondaries.push_back({"cloth", cloth.name, cloth.on, cloth.coupling});
  for (CordsSpec& cords : shot.cords) {
    secondaries.push_back({"cords", cords.name, cords.on, cords.coupling});
    if (const Value* table = section(root, "cords", cords.name)) judge_cords(*table, cords, faults);
  }
  for (StandInKeys& standin : shot.standins)
    if (const Value* table = section(root, "standin", standin.name))
      judge_standin(root, *table, secondaries, standin, shot, faults);
  // A primary's path is adjusted before the secondaries are baked, or follows while they are: not both.
  std::map<std::string, const Secondary*> yields;
  for (const Secondary& pair : secondaries) {
    judge_pair(root, shot, pair, faults);
    if (pair.coupling == "one-way") continue;
    const Secondary* other = yields.emplace(pair.on, &pair).first->second;
    for (const StandInKeys& standin : shot.standins)
      if (pair.coupling == "two-way" && standin.on == pair.on)
        faults.add(place_of(root, {"standin", standin.name, "on"}),
                   "standin " + in_quotes(standin.name) + ": primary " + in_quotes(pair.on) +
                       " is coupled two-way with " + pair.owner() + ", and cannot yield before it is baked as well");
    if (other->coupling != pair.coupling)
      faults.add(place_of(root, {pair.kind, pair.name, "coupling"}),
                 pair.owner() + ": coupling = " + in_quotes(pair.coupling) + ", and " + other->owner() +
                     " on the same primary has " + in_quotes(other->coupling) + "; beside either, others are one-way");
  }
}

}  // namespace ft
