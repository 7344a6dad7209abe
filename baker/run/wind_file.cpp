#include "baker/run/wind_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/shot/shot.h"

namespace ft::inline baker {
namespace {

constexpr double k_margin = 0.4;    ///< around what moves [m]
constexpr double k_widest = 40;     ///< a set that is larger is not what the shot is about [m]
constexpr double k_places = 1500;   ///< about so many, but not nearer to each other than
constexpr double k_nearest = 0.25;  ///< m
constexpr int k_most_samples = 120;

Box scene_of(const BakePlan& plan, int every) {
  const Shot& shot = plan.shot();
  Box out;
  for (std::size_t p = 0; p < shot.primaries.size(); ++p) {
    if (shot.primaries[p].shape == k_ground) continue;
    const Trajectory& body = *plan.primaries[p].trajectory;
    std::vector<Vec3> x(static_cast<std::size_t>(body.surface().vertex_count()));
    Box own;
    for (int frame = shot.first_frame; frame <= shot.last_frame; frame += every) {
      body.sample((frame - shot.first_frame) / shot.fps, x);
      own.include(bounds(x));
    }
    if (own.size().maxCoeff() < k_widest) out.include(own);
  }
  for (const auto& group : plan.groups) out.include(group->start());
  if (out.empty()) out.include(Vec3::Zero());
  out.inflate(k_margin);
  return out;
}

}  // namespace

std::string wind_samples(const BakePlan& plan) {
  const Shot& shot = plan.shot();
  const int frames = plan.written_count(), every = std::max(2, (frames + k_most_samples - 1) / k_most_samples);
  const Box scene = scene_of(plan, every);
  const double reach = std::max(k_nearest, std::cbrt(scene.size().prod() / k_places));
  std::vector<Vec3> places;
  std::array<int, 3> count{};
  for (int k = 0; k < 3; ++k)
    count[at(k)] = std::clamp(static_cast<int>(std::ceil(scene.size()[k] / reach)), 1, 100) + 1;
  for (int i = 0; i < count[0]; ++i)
    for (int j = 0; j < count[1]; ++j)
      for (int k = 0; k < count[2]; ++k) places.emplace_back(scene.lo + reach * Vec3(i, j, k));
  const auto whole = [](double value) { return static_cast<std::int64_t>(std::lround(value)); };
  nlohmann::json out{{"every", every}, {"reach", reach}, {"places", nlohmann::json::array()}};
  for (const Vec3& p : places) out["places"].push_back({whole(1e3 * p.x()), whole(1e3 * p.y()), whole(1e3 * p.z())});
  out["velocities"] = nlohmann::json::array();
  for (int frame = 0; frame < frames; frame += every) {
    const auto air = plan.wind->at_time((plan.first_written() + frame - shot.first_frame) / shot.fps);
    nlohmann::json row = nlohmann::json::array();
    for (const Vec3& p : places) {
      const Vec3 v = air->velocity(p);
      for (int k = 0; k < 3; ++k) row.push_back(whole(100 * v[k]));
    }
    out["velocities"].push_back(std::move(row));
  }
  return out.dump() + "\n";
}

}  // namespace ft::inline baker
