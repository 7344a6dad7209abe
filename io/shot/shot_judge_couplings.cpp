// Props, cords, stand-ins: which keys go with which shape or kind, and what their couplings ask for.
#include <algorithm>
#include <map>

#include "io/shot/choice_keys.h"
#include "io/shot/secondary.h"
#include "io/shot/shot_judge.h"
#include "io/shot/words.h"

namespace ft::inline io {
namespace {

constexpr ChoiceKeys k_primary_shapes[] = {
    {"", "file",
     "animation topology clip clip_start speed loop repeat unit_scale up source_fps body height meshes surface ignore "
     "teleports "
     "limbs position rotation"},
    {"sphere", "radius", "position rotation velocity spin hollow"},
    {"box", "size", "position rotation velocity spin hollow"},
    {"capsule", "radius length", "position rotation velocity spin hollow"},
    {"ground", "", "size position"},
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
  if (const Member* loop = table.find("loop"); loop && primary.loop && primary.repeat > 1)
    faults.add(loop->place,
               owner + ": has both loop and repeat; loop = true repeats the whole clip as often as needed");
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
void judge_whom_it_meets(const Value& root, const Value& table, const Secondaries& secondaries, StandInKeys& standin,
                         Shot& shot, FaultList& faults) {
  const std::string owner = "standin " + in_quotes(standin.name);
  const Member *stands_for = table.find("for"), *on = table.find("on");
  if (on && stands_for) {
    faults.add(on->place, owner + ": has both for and on; on is for what no secondary is there for");
    standin.on.clear();
    return;
  }
  std::vector<std::string> names, primaries;
  for (const auto& secondary : secondaries) names.push_back(secondary->name);
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
               with_hint(owner + ": for = " + in_quotes(standin.stands_for) + " names no secondary",
                         suggestion(standin.stands_for, names)));
  else if (const SecondarySpec& of = *secondaries[at(found - names.begin())]; of.coupling != "hybrid")
    shot.notes.push_back(owner + " is not used: " + of.owner() + " has coupling = " + in_quotes(of.coupling));
}

void judge_standin(const Value& root, const Value& table, const Secondaries& secondaries, StandInKeys& standin,
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

void judge_pair(const Value& root, const Shot& shot, const SecondarySpec& pair, FaultList& faults) {
  const Place place = place_of(root, {pair.kind(), pair.name, "coupling"});
  const std::string fault = pair.owner() + ": coupling = " + in_quotes(pair.coupling);
  if (pair.coupling == "hybrid" && std::none_of(shot.standins.begin(), shot.standins.end(),
                                                [&](const StandInKeys& s) { return s.stands_for == pair.name; }))
    faults.add(place, fault + " needs what the primary yields to: a [standin.NAME] with for = " + in_quotes(pair.name));
  if (pair.coupling != "two-way") return;
  if (const std::string_view why = pair.section->why_not_two_way(); !why.empty())
    faults.add(place, fault + " " + std::string(why));
  for (const PrimarySpec& primary : shot.primaries)
    if (primary.name == pair.on && !primary.mass)
      faults.add(place_of(root, {"primary", primary.name}), "primary " + in_quotes(primary.name) +
                                                                ": mass is missing; the two-way coupling of " +
                                                                pair.owner() + " needs it");
}

}  // namespace

void judge_couplings(const Value& root, Shot& shot, FaultList& faults) {
  for (const PrimarySpec& primary : shot.primaries)
    if (const Value* table = section_of(root, "primary", primary.name)) judge_primary(*table, shot, primary, faults);
  for (StandInKeys& standin : shot.standins)
    if (const Value* table = section_of(root, "standin", standin.name))
      judge_standin(root, *table, shot.secondaries, standin, shot, faults);
  // A primary's path is adjusted before the secondaries are baked, or follows while they are: not both.
  std::map<std::string, const SecondarySpec*> yields;
  for (const auto& secondary : shot.secondaries) {
    const SecondarySpec& pair = *secondary;
    judge_pair(root, shot, pair, faults);
    if (pair.coupling == "one-way") continue;
    const SecondarySpec* other = yields.emplace(pair.on, &pair).first->second;
    for (const StandInKeys& standin : shot.standins)
      if (pair.coupling == "two-way" && standin.on == pair.on)
        faults.add(place_of(root, {"standin", standin.name, "on"}),
                   "standin " + in_quotes(standin.name) + ": primary " + in_quotes(pair.on) +
                       " is coupled two-way with " + pair.owner() + ", and cannot yield before it is baked as well");
    if (other->coupling != pair.coupling)
      faults.add(place_of(root, {pair.kind(), pair.name, "coupling"}),
                 pair.owner() + ": coupling = " + in_quotes(pair.coupling) + ", and " + other->owner() +
                     " on the same primary has " + in_quotes(other->coupling) + "; beside either, others are one-way");
  }
}

}  // namespace ft::inline io
