#include "io/volume/vdb_choice.h"

#include <algorithm>
#include <optional>

namespace ft::inline io {
namespace {

using Choice = std::vector<std::size_t>;

constexpr const char* k_usual[] = {"v", "vel", "velocity", "Velocity"};

bool is_vector(const VdbGridName& g) {
  return g.holds == "vec3s" || g.holds == "vec3d";
}

bool is_number(const VdbGridName& g) {
  return g.holds == "float" || g.holds == "double";
}

std::optional<std::size_t> find(std::span<const VdbGridName> grids, const std::string& name) {
  for (std::size_t i = 0; i < grids.size(); ++i)
    if (grids[i].name == name) return i;
  return {};
}

/// vel.x vel.y vel.z, vel_x, velx. Of one kind of number.
Choice three_of(std::span<const VdbGridName> grids, const std::string& name) {
  for (const char* between : {".", "_", ""}) {
    Choice out;
    for (const char* axis : {"x", "y", "z"})
      if (const auto i = find(grids, name + between + axis); i && is_number(grids[*i])) out.push_back(*i);
    if (out.size() == 3 && grids[out[0]].holds == grids[out[1]].holds && grids[out[0]].holds == grids[out[2]].holds)
      return out;
  }
  return {};
}

Choice named(std::span<const VdbGridName> grids, const std::string& name) {
  if (const auto i = find(grids, name); i && is_vector(grids[*i])) return {*i};
  return three_of(grids, name);
}

std::string list(std::span<const VdbGridName> grids) {
  if (grids.empty()) return "it has none at all";
  std::string out = "it has ";
  for (std::size_t i = 0; i < grids.size() && i < 12; ++i)
    out += (i > 0 ? ", " : "") + grids[i].name + " (" + grids[i].holds + ")";
  return grids.size() > 12 ? out + " and more" : out;
}

}  // namespace

Result<std::vector<std::size_t>> choose_velocity(std::span<const VdbGridName> grids, const std::string& name) {
  if (!name.empty()) {
    Choice out = named(grids, name);
    if (!out.empty()) return out;
    if (find(grids, name)) return input_error("grid \"" + name + "\" holds no velocities; " + list(grids));
    return input_error("no grid \"" + name + "\"; " + list(grids));
  }
  for (const char* usual : k_usual)
    if (const auto i = find(grids, usual); i && is_vector(grids[*i])) return Choice{*i};
  Choice vectors;
  for (std::size_t i = 0; i < grids.size(); ++i)
    if (is_vector(grids[i])) vectors.push_back(i);
  if (vectors.size() == 1) return vectors;
  if (vectors.size() > 1) return input_error("several grids could be the velocities, name one; " + list(grids));
  for (const char* usual : k_usual)
    if (Choice out = three_of(grids, usual); !out.empty()) return out;
  std::vector<Choice> threes;
  for (const VdbGridName& g : grids) {
    if (!g.name.ends_with('x')) continue;
    std::string stem = g.name.substr(0, g.name.size() - 1);
    if (stem.ends_with('.') || stem.ends_with('_')) stem.pop_back();
    Choice out = three_of(grids, stem);
    if (!out.empty() && std::find(threes.begin(), threes.end(), out) == threes.end()) threes.push_back(out);
  }
  if (threes.size() == 1) return threes.front();
  if (threes.size() > 1) return input_error("several grids could be the velocities, name them; " + list(grids));
  return input_error("no grid of velocities; " + list(grids));
}

}  // namespace ft::inline io
