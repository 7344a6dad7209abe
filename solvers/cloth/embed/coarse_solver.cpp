#include "solvers/cloth/embed/coarse_solver.h"

#include <algorithm>

#include "baker/core/parallel.h"
#include "solvers/cloth/embed/coarse_garment.h"
#include "solvers/cloth/model/cloth_check.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_block = 4096;

struct Garment {
  std::string name;
  Mesh mesh;  ///< as given
  std::vector<int> kept;
  std::vector<CoarsenedMesh::Place> places;
};

class CoarseSolver final : public Solver {
 public:
  CoarseSolver(std::unique_ptr<Solver> inner, std::vector<Garment> garments)
      : inner_(std::move(inner)), garments_(std::move(garments)) {}

  int system_count() const override { return inner_->system_count(); }
  const Mesh& system_mesh(int system) const override { return garments_[at(system)].mesh; }
  void system_positions(const State& state, int system, std::span<Vec3> out) const override {
    const Garment& garment = garments_[at(system)];
    CHECK(out.size() == garment.places.size());
    std::vector<Vec3> coarse(garment.kept.size());
    inner_->system_positions(state, system, coarse);
    parallel_for(out.size(), k_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) out[i] = garment.places[i].of(coarse);
    });
  }
  std::span<const Triangle> collider_triangles() const override { return inner_->collider_triangles(); }
  void collider_positions(const State& state, std::vector<Vec3>& out) const override {
    inner_->collider_positions(state, out);
  }
  std::vector<char> collider_absent(const State& state, int system) const override {
    return inner_->collider_absent(state, system);
  }
  State initial_state() const override { return inner_->initial_state(); }
  FrameReport advance_frame(State& state) override { return to_given(inner_->advance_frame(state)); }
  Settling settling(const State& state) const override { return inner_->settling(state); }
  FrameReport settle_frame(State& state) override { return to_given(inner_->settle_frame(state)); }

 private:
  FrameReport to_given(FrameReport report) const {
    for (Incident& incident : report.incidents) {
      const auto garment =
          std::find_if(garments_.begin(), garments_.end(), [&](const Garment& g) { return g.name == incident.system; });
      if (garment != garments_.end() && incident.vertex >= 0) incident.vertex = garment->kept[at(incident.vertex)];
    }
    return report;
  }

  std::unique_ptr<Solver> inner_;
  std::vector<Garment> garments_;
};

}  // namespace

Result<std::unique_ptr<Solver>> make_coarse_solver(ClothSetup setup, const ClothSolverMaker& make_inner) {
  // What is wrong with a garment is said of the garment as it was given.
  if (Status status = check(setup); !status) return status.error();
  const double factor = setup.coarsen;
  setup.coarsen = 1;
  std::vector<Garment> garments;
  for (ClothGarment& garment : setup.garments) {
    CoarseGarment coarse = coarse_garment(garment, factor);
    garments.push_back({garment.name, std::move(garment.mesh), std::move(coarse.kept), std::move(coarse.places)});
    garment = std::move(coarse.garment);
  }
  auto inner = make_inner(std::move(setup));
  if (!inner) return inner.error();
  return std::unique_ptr<Solver>(std::make_unique<CoarseSolver>(std::move(*inner), std::move(garments)));
}

}  // namespace ft::inline solvers
