#include "baker/systems/cloth/vertex_maps.h"

#include <algorithm>

#include "baker/systems/cloth/cloth_maps.h"
#include "io/shot/vertex_values.h"
#include "io/shot/words.h"

namespace ft::inline baker {
namespace {

/// "colour.r", "Color.Red", "r" -> "red"; empty for what is no channel.
std::string channel_of(const std::string& word) {
  const std::string last = word.substr(word.find_last_of('.') == std::string::npos ? 0 : word.find_last_of('.') + 1);
  for (const char* channel : {"red", "green", "blue"})
    if (edit_distance(last, channel) == 0 || edit_distance(last, std::string(channel, 1)) == 0) return channel;
  return {};
}

const VertexGroup* find_group(const Mesh& mesh, const std::string& name) {
  const auto found =
      std::find_if(mesh.groups.begin(), mesh.groups.end(), [&](const VertexGroup& g) { return g.name == name; });
  return found == mesh.groups.end() ? nullptr : &*found;
}

Result<std::vector<double>> weights_of(const std::string& from, const Mesh& mesh) {
  std::vector<double> out(mesh.positions.size(), 0.0);
  const std::string channel = channel_of(from);
  const VertexGroup* group = find_group(mesh, from);
  if (!group && !channel.empty()) group = find_group(mesh, channel);
  if (!group) {
    // A channel that is 0 everywhere makes no group; where another has colour, the mesh is painted.
    const bool painted = find_group(mesh, "red") || find_group(mesh, "green") || find_group(mesh, "blue");
    if (!channel.empty() && painted) return out;
    std::vector<std::string> names;
    for (const VertexGroup& g : mesh.groups) names.push_back(g.name);
    return usage_error(
        "from = " + in_quotes(from) + " names no vertex group and no colour of the mesh", {},
        names.empty() ? "the mesh has neither: it needs `v x y z r g b` or `g` lines" : suggestion(from, names));
  }
  for (std::size_t i = 0; i < group->vertices.size(); ++i)
    out[at(group->vertices[i])] = i < group->weights.size() ? group->weights[i] : 1.0;
  return out;
}

Result<std::vector<double>> values_of(const MapSpec& map, const Mesh& mesh) {
  const MapKind* kind = find_map_kind(map.of);
  if (!kind)
    return usage_error("of = " + in_quotes(map.of) + " is nothing that can vary", {}, suggestion(map.of, map_words()));
  const bool as_weights = map.low && map.high;
  if (map.file.empty() && !as_weights) return usage_error("a map of a group needs low and high");
  auto values = map.file.empty() ? weights_of(map.from, mesh)
                : as_weights
                    ? vertex_column(map.file, map.column, mesh.vertex_count(), 0, 1, "1")
                    : vertex_column(map.file, map.column, mesh.vertex_count(), kind->lowest, kind->highest, kind->unit);
  if (values && as_weights)
    for (double& value : *values)
      value = std::clamp(*map.low + value * (*map.high - *map.low), std::min(*map.low, *map.high),
                         std::max(*map.low, *map.high));
  return values;
}

/// A kind of the shot file is the solver's map of that name.
std::vector<double> VertexMaps::*member_of(const std::string& kind) {
  const auto found =
      std::find_if(k_vertex_maps.begin(), k_vertex_maps.end(), [&](const NamedMap& map) { return map.name == kind; });
  CHECK(found != k_vertex_maps.end());
  return found->values;
}

}  // namespace

Result<VertexMaps> resolve_maps(std::span<const MapSpec> maps, const Mesh& mesh) {
  VertexMaps out;
  for (const MapSpec& map : maps) {
    auto values = values_of(map, mesh);
    if (!values) {
      Error error = values.error();
      error.where = "map of " + map.of + (error.where.empty() ? "" : ": " + error.where);
      return error;
    }
    out.*member_of(map.of) = std::move(*values);
  }
  return out;
}

VertexMaps on_joined(const VertexMaps& maps, std::span<const int> joined_of, int joined_count) {
  VertexMaps out;
  for (const NamedMap& map : k_vertex_maps) {
    const std::vector<double>& values = maps.*map.values;
    if (values.empty()) continue;
    std::vector<double>& joined = out.*map.values;
    std::vector<int> count(at(joined_count), 0);
    joined.assign(at(joined_count), 0.0);
    // Running means: what agrees stays exactly what it is.
    for (std::size_t i = 0; i < values.size(); ++i) {
      double& mean = joined[at(joined_of[i])];
      mean += (values[i] - mean) / ++count[at(joined_of[i])];
    }
  }
  return out;
}

}  // namespace ft::inline baker
