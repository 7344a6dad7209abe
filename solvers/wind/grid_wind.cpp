#include "solvers/wind/grid_wind.h"

namespace ft::inline solvers {
namespace {

class GridAt final : public AirNow {
 public:
  GridAt(const VelocityGrid& grid, const Vec3& offset, double time) : grid_(grid), offset_(offset), time_(time) {}
  Vec3 velocity(const Vec3& place) const override { return grid_.velocity(place - offset_, time_); }

 private:
  const VelocityGrid& grid_;
  Vec3 offset_;
  double time_;
};

}  // namespace

Result<std::unique_ptr<WindField>> GridWind::make(const WindFieldSpec& spec) {
  if (!spec.grid) return usage_error("a grid needs the file with its velocities", spec.name);
  return std::unique_ptr<WindField>(std::make_unique<GridWind>(spec));
}

std::unique_ptr<AirNow> GridWind::at_time(double time) const {
  return std::make_unique<GridAt>(*spec().grid, spec().position, time);
}

}  // namespace ft::inline solvers
