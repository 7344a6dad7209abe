#include "tests/baker/tress_kind.h"

#include "baker/core/output_frame.h"
#include "baker/plan/plan.h"
#include "baker/systems/interface/section_of.h"

namespace ft::test {
namespace {

class TressSolver final : public Solver {
 public:
  TressSolver(std::shared_ptr<const SystemShape> shape, const TressSpec& spec, const Shot& shot)
      : shape_(std::move(shape)),
        ball_(spec.ball()),
        first_(shot.first_frame),
        preroll_(shot.preroll),
        fps_(shot.fps) {}

  int system_count() const override { return 1; }
  const SystemShape* system_shape(int) const override { return shape_.get(); }
  void system_frame(const State& state, int, FrameData& out) const override {
    out = {};
    const double phase = state.find("phase")->front();
    for (const Vec3& p : combed_places(ball_, phase)) out.positions.push_back(p.cast<float>());
    constexpr double k_little = 1e-4;  // of phase, to both sides
    const std::vector<Vec3> before = combed_places(ball_, phase - k_little);
    const std::vector<Vec3> after = combed_places(ball_, phase + k_little);
    for (std::size_t i = 0; i < before.size(); ++i)
      out.velocities.push_back(((after[i] - before[i]) * (k_tress_step * fps_ / (2 * k_little))).cast<float>());
  }
  std::span<const Triangle> collider_triangles() const override { return {}; }
  void collider_positions(const State&, std::vector<Vec3>& positions) const override { positions.clear(); }
  State initial_state() const override {
    State state;
    state.frame = first_ - preroll_;
    state.time = -preroll_ / fps_;
    state.set("phase", {0});
    return state;
  }
  FrameReport advance_frame(State& state) override {
    ++state.frame;
    state.time = (state.frame - first_) / fps_;
    state.set("phase", {state.find("phase")->front() + k_tress_step});
    FrameReport report;
    report.frame = state.frame;
    report.smallest_gap = 0.25;
    return report;
  }

 private:
  std::shared_ptr<const SystemShape> shape_;
  CombedBall ball_;
  int first_, preroll_;
  double fps_;
};

class TressGroup final : public SystemGroup {
 public:
  TressGroup(std::size_t whom, const TressSpec& spec, const Shot& shot) : SystemGroup(whom), spec_(spec), shot_(shot) {
    SystemShape shape;
    shape.name = spec.name;
    shape.content.shape = OutputShape::k_curves;
    shape.curves = combed_curves(spec.ball());
    shape_ = std::make_shared<const SystemShape>(std::move(shape));
    outputs.emplace_back();
    outputs.back().primary = whom;
    outputs.back().shape = shape_;
  }
  std::string_view role() const override { return "tress"; }
  Result<std::unique_ptr<Solver>> make_solver() override {
    return std::unique_ptr<Solver>(std::make_unique<TressSolver>(shape_, spec_, shot_));
  }
  std::vector<std::string> lines(const BakePlan&) const override {
    return {"tress \"" + spec_.name + "\": " + std::to_string(spec_.strands) + " strands"};
  }

 private:
  TressSpec spec_;
  Shot shot_;
  std::shared_ptr<const SystemShape> shape_;
};

std::span<const ShotKey<TressSpec>> tress_keys() {
  static const ShotKey<TressSpec> keys[] = {
      {"strands", &TressSpec::strands, 1, 100000, "", "", false, "", "Strands"},
      {"vertices", &TressSpec::vertices, 2, 1000, "", "", false, "", "Of each strand"},
      {"turned", &TressSpec::turned, 0, 0, "", "", false, "", "In the opposite order"},
      {"swing", &TressSpec::swing, 0, 3, "rad", "", false, "", "Of the tips"},
      {"on", &TressSpec::on, 0, 0, "", "@name of a primary", false, "", "The primary"},
  };
  return keys;
}

class TressSection final : public SectionOf<TressSpec> {
 public:
  TressSection() : SectionOf("tress", tress_keys()) {}
  std::vector<std::pair<std::string, std::filesystem::path>> files(const SecondarySpec&) const override { return {}; }
  std::string_view whom() const override { return "whom it swings beside"; }
  std::string_view why_no_carrier() const override { return "nothing stands on hair"; }
  std::string_view why_not_two_way() const override { return "weighs nothing"; }
};

class TressKind final : public SystemKind {
 public:
  const SecondarySection& section() const override {
    static const TressSection section;
    return section;
  }
  Result<SystemGroups> plan(const Shot& shot, BakePlan& plan) const override {
    SystemGroups out;
    for (const TressSpec* spec : specs_of<TressSpec>(shot.secondaries))
      for (std::size_t p = 0; p < plan.primaries.size(); ++p)
        if (plan.primaries[p].name == spec->on) out.push_back(std::make_unique<TressGroup>(p, *spec, shot));
    return out;
  }
  Result<std::vector<std::unique_ptr<JudgedGroup>>> judge(const CachedBake&) const override {
    return std::vector<std::unique_ptr<JudgedGroup>>();
  }
};

}  // namespace

CombedBall TressSpec::ball() const {
  CombedBall out;
  out.strands = strands, out.vertices = vertices, out.swing = swing, out.turned = turned;
  return out;
}

const SystemKind& tress_kind() {
  static const TressKind kind;
  return kind;
}

}  // namespace ft::test
