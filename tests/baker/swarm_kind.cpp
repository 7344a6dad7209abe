#include "tests/baker/swarm_kind.h"

#include <algorithm>
#include <cmath>

#include "baker/core/output_frame.h"
#include "baker/plan/plan.h"
#include "baker/systems/interface/section_of.h"

namespace ft::test {
namespace {

constexpr std::size_t k_numbers = 7;  ///< of a token in the state: place, and quaternion x y z w

/// It flies in circles about the box, the faster the higher it is, and turns about an axis of its own.
class SwarmSolver final : public Solver {
 public:
  SwarmSolver(std::shared_ptr<const SystemShape> shape, const SwarmSpec& spec, const Shot& shot)
      : shape_(std::move(shape)), spec_(spec), first_(shot.first_frame), preroll_(shot.preroll), fps_(shot.fps) {}

  int system_count() const override { return 1; }
  const SystemShape* system_shape(int) const override { return shape_.get(); }
  void system_frame(const State& state, int, FrameData& out) const override {
    out = {};
    const std::span<const double> x = *state.find("tokens");
    for (std::size_t i = 0; i < shape_->instances.ids.size(); ++i) {
      const Vec3 place(x[k_numbers * i], x[k_numbers * i + 1], x[k_numbers * i + 2]);
      out.positions.push_back(place.cast<float>());
      if (spec_.spoilt > 0 && state.frame == spec_.spoilt && i == 1) out.positions.back().x() = std::nanf("");
      out.velocities.push_back(velocity(place).cast<float>());
      out.orientations.push_back(turn(x, i).cast<float>().normalized());
      out.angular_velocities.push_back(spin(i).cast<float>());
      out.scales.push_back(state.frame < first_ + static_cast<int>(shape_->instances.ids[i] % 4) ? Vec3f::Zero()
                                                                                                 : Vec3f(1, 1, 0.5f));
    }
  }
  std::span<const Triangle> collider_triangles() const override { return {}; }
  void collider_positions(const State&, std::vector<Vec3>& positions) const override { positions.clear(); }
  State initial_state() const override {
    State state;
    state.frame = first_ - preroll_;
    state.time = -preroll_ / fps_;
    std::vector<double> x;
    for (const std::uint64_t id : shape_->instances.ids) {
      const double a = 0.7 * static_cast<double>(id);
      const bool nudged = id == static_cast<std::uint64_t>(spec_.first_id);
      x.insert(x.end(), {1.5 * std::cos(a) + (nudged ? spec_.nudge : 0), 0.4 + 0.1 * static_cast<double>(id % 9),
                         1.5 * std::sin(a), 0, 0, 0, 1});
    }
    state.set("tokens", std::move(x));
    return state;
  }
  FrameReport advance_frame(State& state) override {
    ++state.frame;
    state.time = (state.frame - first_) / fps_;
    std::vector<double> x = *state.find("tokens");
    for (std::size_t i = 0; i < shape_->instances.ids.size(); ++i) {
      double* token = x.data() + k_numbers * i;
      Eigen::Map<Vec3> place(token);
      const Quat turned = Quat(Eigen::AngleAxisd(spin(i).norm() / fps_, spin(i).normalized())) * turn(x, i);
      place += velocity(place) / fps_;
      Eigen::Map<Eigen::Vector4d>(token + 3) = turned.normalized().coeffs();
    }
    state.set("tokens", std::move(x));
    FrameReport report;
    report.frame = state.frame;
    report.smallest_gap = 0.25;
    return report;
  }

 private:
  static Vec3 velocity(const Vec3& place) { return (1 + place.y()) * Vec3(-place.z(), 0.1, place.x()); }
  Vec3 spin(std::size_t i) const {
    const auto id = static_cast<double>(shape_->instances.ids[i]);
    return 3 * Vec3(std::sin(id), 1, std::cos(id));
  }
  static Quat turn(std::span<const double> x, std::size_t i) {
    const double* q = x.data() + k_numbers * i + 3;
    return {q[3], q[0], q[1], q[2]};
  }

  std::shared_ptr<const SystemShape> shape_;
  SwarmSpec spec_;
  int first_, preroll_;
  double fps_;
};

class SwarmGroup final : public SystemGroup {
 public:
  SwarmGroup(std::size_t whom, const SwarmSpec& spec, const Shot& shot) : SystemGroup(whom), spec_(spec), shot_(shot) {
    shape_ = std::make_shared<const SystemShape>(swarm_shape(spec));
    outputs.emplace_back();
    outputs.back().primary = whom;
    outputs.back().shape = shape_;
  }
  std::string_view role() const override { return "swarm"; }
  Result<std::unique_ptr<Solver>> make_solver() override {
    return std::unique_ptr<Solver>(std::make_unique<SwarmSolver>(shape_, spec_, shot_));
  }
  std::vector<std::string> lines(const BakePlan&) const override {
    return {"swarm \"" + spec_.name + "\": " + std::to_string(spec_.count) + " tokens"};
  }

 private:
  SwarmSpec spec_;
  Shot shot_;
  std::shared_ptr<const SystemShape> shape_;
};

std::span<const ShotKey<SwarmSpec>> swarm_keys() {
  static const ShotKey<SwarmSpec> keys[] = {
      {"count", &SwarmSpec::count, 1, 100000, "", "", false, "", "Tokens"},
      {"spoilt", &SwarmSpec::spoilt, 0, 100000, "", "", false, "", "Frame in which a token has no place"},
      {"nudge", &SwarmSpec::nudge, -10, 10, "m", "", false, "", "Of the first token"},
      {"turned", &SwarmSpec::turned, 0, 0, "", "", false, "", "In the opposite order"},
      {"first_id", &SwarmSpec::first_id, 0, 100000, "", "", false, "", "Of the tokens"},
      {"on", &SwarmSpec::on, 0, 0, "", "@name of a primary", false, "", "The primary"},
  };
  return keys;
}

class SwarmSection final : public SectionOf<SwarmSpec> {
 public:
  SwarmSection() : SectionOf("swarm", swarm_keys()) {}
  std::vector<std::pair<std::string, std::filesystem::path>> files(const SecondarySpec&) const override { return {}; }
  std::string_view whom() const override { return "whom they fly about"; }
  std::string_view why_no_carrier() const override { return "nothing stands on what flies"; }
  std::string_view why_not_two_way() const override { return "weighs nothing"; }
};

class SwarmKind final : public SystemKind {
 public:
  const SecondarySection& section() const override {
    static const SwarmSection section;
    return section;
  }
  Result<SystemGroups> plan(const Shot& shot, BakePlan& plan) const override {
    SystemGroups out;
    for (const SwarmSpec* spec : specs_of<SwarmSpec>(shot.secondaries))
      for (std::size_t p = 0; p < plan.primaries.size(); ++p)
        if (plan.primaries[p].name == spec->on) out.push_back(std::make_unique<SwarmGroup>(p, *spec, shot));
    return out;
  }
  Result<std::vector<std::unique_ptr<JudgedGroup>>> judge(const CachedBake&) const override {
    return std::vector<std::unique_ptr<JudgedGroup>>();
  }
};

}  // namespace

SystemShape swarm_shape(const SwarmSpec& spec) {
  SystemShape out;
  out.name = spec.name;
  out.content.shape = OutputShape::k_instances;
  out.content.angular_velocities = out.content.scales = true;
  for (int i = 0; i < spec.count; ++i) {
    out.instances.ids.push_back(static_cast<std::uint64_t>(spec.first_id + spec.count - 1 - i));
    out.instances.prototypes.push_back(static_cast<int>(out.instances.ids.back() % 2));
  }
  if (spec.turned) {
    std::reverse(out.instances.ids.begin(), out.instances.ids.end());
    std::reverse(out.instances.prototypes.begin(), out.instances.prototypes.end());
  }
  out.instances.prototype_names = {"card", "wedge"};
  const std::vector<Vec3> square = {{0, 0, 0}, {0.06, 0.01, 0}, {0.06, 0.01, 0.06}, {0, 0, 0.06}};
  const std::vector<Vec3> corner = {{0, 0, 0}, {0.08, 0, 0}, {0, 0, 0.04}};
  out.prototypes.push_back(make_triangle_mesh("card", square, std::vector<Triangle>{{0, 2, 1}, {0, 3, 2}}));
  out.prototypes.push_back(make_triangle_mesh("wedge", corner, std::vector<Triangle>{{0, 2, 1}}));
  return out;
}

const SystemKind& swarm_kind() {
  static const SwarmKind kind;
  return kind;
}

}  // namespace ft::test
