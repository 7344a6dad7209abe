#include <algorithm>

#include "baker/systems/cloth/cloth_kind.h"
#include "baker/systems/cords/cords_kind.h"
#include "baker/systems/follow/follow_kind.h"
#include "baker/systems/hair/hair_kind.h"
#include "baker/systems/interface/system.h"
#include "baker/systems/leaves/leaves_kind.h"
#include "baker/systems/water/water_kind.h"

namespace ft::inline baker {

namespace {

struct Registry {
  std::vector<const SystemKind*> kinds = {
      cloth_kind(), cords_kind(), follow_kind(), leaves_kind(), hair_kind(), water_kind(),
  };
  std::vector<Metric> metrics = metrics_of(kinds);

  static std::vector<Metric> metrics_of(std::span<const SystemKind* const> kinds) {
    std::vector<Metric> out;
    for (const SystemKind* kind : kinds) out.insert(out.end(), kind->metrics().begin(), kind->metrics().end());
    return out;
  }
};

Registry& registry() {
  static Registry all;
  return all;
}

}  // namespace

std::span<const SystemKind* const> system_kinds() {
  return registry().kinds;
}

AddedSystemKind::AddedSystemKind(const SystemKind& kind) : kind_(&kind) {
  CHECK(!find_system_kind(kind.name()));
  registry().kinds.push_back(kind_);
  registry().metrics = Registry::metrics_of(registry().kinds);
}

AddedSystemKind::~AddedSystemKind() {
  std::erase(registry().kinds, kind_);
  registry().metrics = Registry::metrics_of(registry().kinds);
}

Box SystemGroup::start() const {
  Box out;
  for (const SystemOutput& output : outputs)
    if (output.mesh) out.include(bounds(output.mesh->positions));
  return out;
}

FrameCounts SystemOutput::counts() const {
  return {.elements = static_cast<std::uint64_t>(shape ? shape->element_count() : mesh->vertex_count())};
}

std::span<const Metric> declared_metrics() {
  return registry().metrics;
}

const Metric* find_metric(std::string_view key) {
  for (const std::span<const Metric> metrics : {frame_metrics(), declared_metrics()})
    for (const Metric& metric : metrics)
      if (metric.key == key) return &metric;
  return nullptr;
}

const SystemKind* find_system_kind(std::string_view name) {
  const auto kinds = system_kinds();
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const SystemKind* k) { return k->name() == name; });
  return found == kinds.end() ? nullptr : *found;
}

}  // namespace ft::inline baker
