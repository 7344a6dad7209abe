#include "solvers/cloth/embed/riding_solver.h"

#include <algorithm>
#include <mutex>

#include "baker/core/edge_strain.h"
#include "collision/check/crossings.h"
#include "solvers/cloth/embed/coarse_garment.h"
#include "solvers/cloth/embed/riders.h"
#include "solvers/cloth/model/cloth_check.h"

namespace ft::inline solvers {
namespace {

/// Which riders are drawn in: 1, or 0.
constexpr std::string_view k_block = "drawn_in";
/// At most so many crossings with what rides are told of in a frame.
constexpr std::size_t k_told = 4;

class RidingSolver final : public Solver {
 public:
  RidingSolver(std::unique_ptr<Solver> inner, AllRiders riders, bool certified)
      : inner_(std::move(inner)),
        riders_(std::move(riders)),
        collider_(inner_->collider_triangles()),
        certified_(certified) {}

  int system_count() const override { return inner_->system_count(); }
  const Mesh& system_mesh(int system) const override { return riders_.garment(system).mesh; }
  void system_positions(const State& state, int system, std::span<Vec3> out) const override {
    const Riders& garment = riders_.garment(system);
    std::vector<Vec3> moved(garment.kept.size());
    inner_->system_positions(state, system, moved);
    const auto* drawn_in = state.find(k_block);
    CHECK(drawn_in);
    garment.place(moved, std::span(*drawn_in).subspan(garment.first_group, garment.group_count()), out);
  }
  std::span<const Triangle> collider_triangles() const override { return inner_->collider_triangles(); }
  void collider_positions(const State& state, std::vector<Vec3>& out) const override {
    inner_->collider_positions(state, out);
  }
  std::vector<char> collider_absent(const State& state, int system) const override {
    return inner_->collider_absent(state, system);
  }
  State initial_state() const override {
    State state = inner_->initial_state();
    state.set(k_block, std::vector<double>(riders_.group_count(), 0.0));
    return state;
  }
  FrameReport advance_frame(State& state) override {
    return carry_along(state, [&] { return inner_->advance_frame(state); });
  }
  Settling settling(const State& state) const override { return inner_->settling(state); }
  FrameReport settle_frame(State& state) override {
    return carry_along(state, [&] { return inner_->settle_frame(state); });
  }

 private:
  template <class Advance>
  FrameReport carry_along(State& state, Advance&& advance);
  void certify(State& state, FrameReport& report);
  void tell(std::span<const Crossing> crossings, std::span<const Vec3> x, const char* text, FrameReport& report) const;

  std::unique_ptr<Solver> inner_;
  AllRiders riders_;
  CheckedSurface collider_;  // scratch: its box tree is kept from frame to frame
  std::mutex one_at_a_time_;
  bool certified_;
};

/// What rides, after what moves has gone on by a frame.
template <class Advance>
FrameReport RidingSolver::carry_along(State& state, Advance&& advance) {
  const std::lock_guard lock(one_at_a_time_);
  FrameReport report = advance();
  for (Incident& incident : report.incidents) riders_.to_given(incident);
  state.set(k_block, std::vector<double>(riders_.group_count(), 0.0));
  if (certified_) certify(state, report);
  return report;
}

/// Draws in what crosses, then counts what crosses nevertheless.
void RidingSolver::certify(State& state, FrameReport& report) {
  std::vector<Vec3> x(riders_.vertex_count()), body;
  inner_->collider_positions(state, body);
  collider_.move(body);
  const auto place = [&] {
    for (int s = 0; s < system_count(); ++s)
      system_positions(state, s, std::span(x).subspan(riders_.first_vertex(s), riders_.garment(s).places.size()));
  };
  place();
  std::vector<std::vector<char>> absent;
  for (int s = 0; s < system_count(); ++s) absent.push_back(inner_->collider_absent(state, s));
  // Returns how many were with what is absent for the garment.
  const auto without_absent = [&](RidingCrossings& all) {
    return static_cast<int>(std::erase_if(all.with_body, [&](const Crossing& c) {
      const int v = c.edge_of_first ? c.edge[0] : c.triangle[0];
      return second_is_marked(c, absent[at(riders_.garment_of(v))]);
    }));
  };
  RidingCrossings found = riders_.crossings(x, collider_);
  int left_out = without_absent(found);
  if (!found.empty()) {
    riders_.draw_in(found, state.block(k_block));
    place();
    found = riders_.crossings(x, collider_);
    left_out = without_absent(found);
  }
  if (report.crossings_body + report.crossings_self > 0) {  // some are of triangles that only what moves has
    RidingCrossings all = riders_.all_crossings(x, collider_);
    report.crossings_absent = without_absent(all);
    report.crossings_body = static_cast<int>(all.with_body.size());
    report.crossings_self = static_cast<int>(all.own.size());
  } else {
    report.crossings_absent += left_out;
    report.crossings_body = static_cast<int>(found.with_body.size());
    report.crossings_self = static_cast<int>(found.own.size());
  }
  collider_.forget_boxes();
  tell(found.with_body, x, "a vertex that rides on the cloth crosses the collider", report);
  tell(found.own, x, "a vertex that rides on the cloth crosses cloth", report);
  const StrainSummary strain = summary(edge_strains(riders_.rest_edges(), x));
  report.strain_mean = strain.mean;
  report.strain_p99 = strain.p99;
  report.strain_max = strain.max;
}

void RidingSolver::tell(std::span<const Crossing> crossings, std::span<const Vec3> x, const char* text,
                        FrameReport& report) const {
  for (std::size_t k = 0; k < std::min(k_told, crossings.size()); ++k) {
    const int v = crossings[k].edge_of_first ? crossings[k].edge[0] : crossings[k].triangle[0];
    Incident incident;
    incident.kind = Incident::Kind::k_crossing;
    incident.frame = report.frame;
    incident.system = riders_.garment(riders_.garment_of(v)).name;
    incident.vertex = v - static_cast<int>(riders_.first_vertex(riders_.garment_of(v)));
    incident.place = x[at(v)];
    incident.text = text;
    report.incidents.push_back(std::move(incident));
  }
}

}  // namespace

Result<std::unique_ptr<Solver>> make_riding_solver(const ClothSetup& given, const ClothSolverMaker& make_inner) {
  // What is wrong with a garment is said of the garment as it was given.
  if (Status status = check(given); !status) return status.error();
  std::vector<std::optional<CoarseGarment>> coarse;
  for (const ClothGarment& garment : given.garments) coarse.push_back(without_short_edges(garment));
  if (std::none_of(coarse.begin(), coarse.end(), [](const auto& c) { return c.has_value(); }))
    return std::unique_ptr<Solver>();
  ClothSetup setup = given;
  setup.keep_short_edges = true;
  AllRiders riders;
  for (std::size_t g = 0; g < coarse.size(); ++g) {
    riders.add(given.garments[g], coarse[g] ? &*coarse[g] : nullptr);
    if (coarse[g]) setup.garments[g] = std::move(coarse[g]->garment);
  }
  riders.finish();
  auto inner = make_inner(std::move(setup));
  if (!inner) return inner.error();
  return std::unique_ptr<Solver>(
      std::make_unique<RidingSolver>(std::move(*inner), std::move(riders), !(given.coarsen > 1)));
}

}  // namespace ft::inline solvers
