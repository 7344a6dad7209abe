#include "io/shot/chains.h"

#include <algorithm>

#include "io/shot/words.h"

namespace ft::inline io {
namespace {

/// Indices of those that can only be solved together with it; what it is on is none of them, its section says why.
std::vector<std::size_t> together_with(const SecondarySpec& one, const Secondaries& all) {
  std::vector<std::size_t> out;
  const std::vector<std::string> names = one.section->solved_with(one);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i]->section == one.section && all[i]->reference() != one.on &&
        std::find(names.begin(), names.end(), all[i]->name) != names.end())
      out.push_back(i);
  return out;
}

/// Raises stages until they agree; false: they never do.
bool settle(const Secondaries& all, std::vector<int>& stages) {
  stages.assign(all.size(), 0);
  for (std::size_t round = 0; round <= 2 * all.size() + 1; ++round) {
    bool changed = false;
    const auto raise = [&](std::size_t i, int least) {
      if (stages[i] < least) stages[i] = least, changed = true;
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (const std::size_t r : references_of(*all[i], all)) raise(i, stages[r] + 1);
      for (const std::size_t w : together_with(*all[i], all)) raise(i, stages[w]), raise(w, stages[i]);
    }
    if (!changed) return true;
  }
  return false;
}

/// A circle that `path` leads into; empty: none. done: those from which no circle is reached.
std::vector<std::size_t> circle_from(std::vector<std::size_t>& path, const Secondaries& all, std::vector<char>& done) {
  const std::size_t last = path.back();
  for (const std::size_t next : references_of(*all[last], all)) {
    if (done[next] != 0) continue;
    if (const auto seen = std::find(path.begin(), path.end(), next); seen != path.end()) return {seen, path.end()};
    path.push_back(next);
    if (auto found = circle_from(path, all, done); !found.empty()) return found;
    path.pop_back();
  }
  done[last] = 1;
  return {};
}

Place place_of_reference(const Value& root, const SecondarySpec& from, const SecondarySpec& to) {
  return place_of(root, {from.kind(), from.name, from.on == to.reference() ? "on" : "meets"});
}

/// Returns whether there are any.
bool judge_circles(const Value& root, const Secondaries& all, FaultList& faults) {
  std::vector<char> done(all.size(), 0);
  bool any = false;
  for (std::size_t start = 0; start < all.size(); ++start) {
    if (done[start] != 0) continue;
    std::vector<std::size_t> path{start};
    std::vector<std::size_t> circle = circle_from(path, all, done);
    if (circle.empty()) continue;
    any = true;
    // From its first member in the file on, whoever led into it.
    std::rotate(circle.begin(), std::min_element(circle.begin(), circle.end()), circle.end());
    std::string members;
    for (const std::size_t i : circle) members += all[i]->reference() + " -> ", done[i] = 1;
    for (const std::size_t i : path) done[i] = 1;
    const SecondarySpec& first = *all[circle.front()];
    const SecondarySpec& next = *all[circle[circle.size() > 1 ? 1 : 0]];
    const Place place = place_of_reference(root, first, next);
    if (circle.size() == 1)
      faults.add(place, first.owner() + (first.on == first.reference() ? ": is on itself" : ": meets itself anyway"));
    else
      faults.add(place, first.owner() + ": what it refers to leads back to itself: " + members + first.reference() +
                            "; each has to be baked before the one that refers to it");
  }
  return any;
}

}  // namespace

std::vector<std::size_t> references_of(const SecondarySpec& secondary, const Secondaries& all) {
  const std::vector<std::string> met = secondary.section->meets(secondary);
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string name = all[i]->reference();
    if (secondary.on == name || std::find(met.begin(), met.end(), name) != met.end()) out.push_back(i);
  }
  return out;
}

void judge_chains(const Value& root, const Shot& shot, FaultList& faults) {
  const Secondaries& all = shot.secondaries;
  for (const auto& secondary : all)
    for (const std::size_t r : references_of(*secondary, all)) {
      const SecondarySpec &own = *secondary, &carrier = *all[r];
      const bool is_on = own.on == carrier.reference();
      const std::string fault = own.owner() + (is_on ? ": on" : ": meets") + " = " + in_quotes(carrier.reference());
      const Place place = place_of_reference(root, own, carrier);
      if (const std::string_view why = carrier.section->why_no_carrier(); !why.empty())
        faults.add(place, fault + ": " + std::string(why));
      if (carrier.section->is_liquid() && !own.section->floats())
        faults.add(place, fault + " is a liquid, and " + std::string(own.kind()) + " does not float");
      if (!is_on) continue;
      if (own.section->needs_rigid_primary())
        faults.add(place, fault + " bends, and " + std::string(own.kind()) + " need a primary that is rigid");
      if (own.section->needs_character())
        faults.add(place, fault + " has no joints or vertices of a character to follow");
      if (own.coupling != "one-way")
        faults.add(place_of(root, {own.kind(), own.name, "coupling"}),
                   own.owner() + ": coupling = " + in_quotes(own.coupling) + " goes with a primary; " +
                       in_quotes(carrier.reference()) + " is baked before and feels nothing of it (one-way)");
    }
  std::vector<int> stages;
  if (!judge_circles(root, all, faults) && !settle(all, stages))
    faults.add({},
               "some secondaries refer to each other and are held to each other by pins, too: they would have to be "
               "solved together and one after the other");
}

std::vector<int> stages_of(const Secondaries& all) {
  std::vector<int> out;
  CHECK(settle(all, out));
  return out;
}

}  // namespace ft::inline io
