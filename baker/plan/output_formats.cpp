#include "baker/plan/output_formats.h"

#include <fmt/format.h>

#include <algorithm>

#include "baker/plan/located.h"
#include "baker/systems/interface/system.h"

namespace ft::inline baker {
namespace {

/// "abc": the formats that the program has and that take it.
std::string who_takes(const FrameContent& content) {
  std::string out;
  for (const CacheFormat& format : cache_formats())
    if (format.accepts(content)) out += (out.empty() ? "" : ", ") + std::string(format.name);
  return out;
}

std::string quoted_list(std::span<const std::string> names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + in_quotes(name);
  return out;
}

/// Whether the water that is to go out as volumes exists, and its caches.
Status check_volumes(const Shot& shot) {
  if (!shot.cache_volumes) return {};
  const auto is_water = [](const auto& secondary) {
    const SystemKind* kind = find_system_kind(secondary->kind());
    return kind && kind->is_liquid();
  };
  if (std::ranges::none_of(shot.secondaries, is_water))
    return located(usage_error("volumes are of water, and this shot has none"), shot, "cache");
  if (std::ranges::count(shot.cache_formats, "abc") == 0)
    return located(usage_error("volumes are made from Alembic caches", {}, "formats = [\"abc\"] under [cache]"), shot,
                   "cache");
  return {};
}

}  // namespace

std::vector<const CacheFormat*> formats_for(const Shot& shot, const FrameContent& content) {
  std::vector<const CacheFormat*> out;
  for (const std::string& name : shot.cache_formats) {
    const CacheFormat* format = find_cache_format(name);
    CHECK(format);
    if (format->accepts(content)) out.push_back(format);
  }
  return out;
}

Status check_output_formats(BakePlan& plan) {
  const Shot& shot = plan.shot();
  if (const Status volumes = check_volumes(shot); !volumes) return volumes;
  for (const auto& group : plan.groups)
    for (const SystemOutput& output : group->outputs) {
      const std::string owner = fmt::format("{} \"{}\"", group->role(), output.name());
      const auto taken = formats_for(shot, output.content());
      std::string refusals, names;
      for (const CacheFormat* format : taken) names += (names.empty() ? "" : " and ") + std::string(format->name);
      for (const std::string& name : shot.cache_formats)
        if (const Status accepted = find_cache_format(name)->accepts(output.content()); !accepted)
          refusals += (refusals.empty() ? "" : "; ") + accepted.error().what;
      if (taken.empty()) {
        const std::string others = who_takes(output.content());
        return located(usage_error("no cache would hold it: " + refusals, {},
                                   others.empty() ? std::string("no format takes it yet")
                                                  : fmt::format("take {} for {}: formats = [\"{}\"] under [cache]",
                                                                others, shape_name(output.content().shape), others)),
                       shot, owner);
      }
      for (const CacheFormat* format : taken)
        if (const auto lost = format->leaves_out(output.content()); !lost.empty())
          plan.notes.push_back(
              fmt::format("{}: its {} not in its {} cache, which cannot hold values of vertices by name", owner,
                          lost.size() == 1 ? quoted_list(lost) + " is" : quoted_list(lost) + " are", format->name));
      if (!refusals.empty())
        plan.notes.push_back(fmt::format("{}: {}; it is written as {} only", owner, refusals, names));
    }
  return {};
}

}  // namespace ft::inline baker
