#include "baker/systems/cloth/cloth_kind.h"

#include "baker/record/cache_track.h"
#include "baker/systems/cloth/cloth_check.h"
#include "baker/systems/cloth/cloth_section.h"
#include "baker/systems/cloth/plan_cloths.h"

namespace ft::inline baker {
namespace {

class ClothKind final : public SystemKind {
 public:
  const SecondarySection& section() const override { return cloth_section(); }
  Result<SystemGroups> plan(const Shot& shot, BakePlan& plan) const override {
    auto cloths = plan_cloths(shot, plan);
    if (!cloths) return cloths.error();
    SystemGroups out;
    for (auto& group : *cloths) out.push_back(std::move(group));
    return out;
  }
  Result<std::vector<std::unique_ptr<JudgedGroup>>> judge(const CachedBake& bake) const override {
    return judge_cloths(bake);
  }
  std::optional<RestEdges> rest_edges(const CacheTrack& track) const override {
    return rest_edges_of(track.rest, track.triangles, track.pattern_scale);
  }
  bool is_sheet() const override { return true; }
};

}  // namespace

const SystemKind* cloth_kind() {
  static const ClothKind kind;
  return &kind;
}

}  // namespace ft::inline baker
