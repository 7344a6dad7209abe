#include <algorithm>

#include "baker/systems/cloth/cloth_kind.h"
#include "baker/systems/cords/cords_kind.h"
#include "baker/systems/follow/follow_kind.h"
#include "baker/systems/interface/system.h"

namespace ft::inline baker {

std::span<const SystemKind* const> system_kinds() {
  static const SystemKind* const kinds[] = {
      cloth_kind(),
      cords_kind(),
      follow_kind(),
  };
  return kinds;
}

std::span<const Metric> declared_metrics() {
  static const std::vector<Metric> all = [] {
    std::vector<Metric> out;
    for (const SystemKind* kind : system_kinds()) out.insert(out.end(), kind->metrics().begin(), kind->metrics().end());
    return out;
  }();
  return all;
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
