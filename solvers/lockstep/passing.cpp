#include "solvers/lockstep/passing.h"

#include <algorithm>

#include "collision/check/penetration.h"

namespace ft::inline solvers {
namespace {

std::uint64_t bits(double through) {
  return static_cast<std::uint64_t>(through);
}

/// Points of cords that are inside a body of the setup; of those that `asked` (per point) is not 0 for.
void add_inside(const LockstepModel& model, std::size_t body, double time, std::span<const Vec3> points,
                std::span<const char> asked, std::vector<std::uint64_t>& out) {
  const MetBody& met = model.setup.bodies[body];
  std::vector<Vec3> some, surface(at(met.trajectory->surface().vertex_count()));
  std::vector<int> which;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (asked[i] != 0) some.push_back(points[i]), which.push_back(static_cast<int>(i));
  if (some.empty()) return;
  met.trajectory->sample(time, surface);
  for (const Penetration& p : penetrations(some, surface, met.trajectory->surface().triangles))
    out[at(which[at(p.vertex)])] |= met_bit(static_cast<int>(body) + 1);
}

}  // namespace

bool let_blocking_through(std::span<const LockstepContact::Blocked> blocking, std::vector<double>& through) {
  for (const auto& b : blocking)
    through[at(b.point)] = static_cast<double>(bits(through[at(b.point)]) | met_bit(b.met));
  return !blocking.empty();
}

void let_all_through(const LockstepModel& model, std::vector<double>& through) {
  std::uint64_t all = 0;
  for (std::size_t b = 0; b < model.setup.bodies.size(); ++b)
    if (!model.setup.bodies[b].fixed) all |= met_bit(static_cast<int>(b) + 1);
  for (double& of_point : through) of_point = static_cast<double>(bits(of_point) | all);
}

void let_start_through(const LockstepModel& model, double time, std::vector<double>& through) {
  if (model.setup.bodies.empty()) return;
  std::vector<std::uint64_t> found(through.size(), 0);
  LockstepContact contact(model);
  contact.begin_step(time, time);
  std::vector<Vec3> x = model.start;
  x.resize(at(model.node_count()), Vec3::Zero());
  for (const auto& c : contact.crossings(x))
    for (const int v : c.cord)
      if (c.met > 0) found[at(v)] |= met_bit(c.met);
  for (std::size_t b = 0; b < model.setup.bodies.size(); ++b) {
    std::vector<char> asked(through.size());
    for (std::size_t i = 0; i < asked.size(); ++i)
      asked[i] = static_cast<char>(model.meets(model.system_of[i], static_cast<int>(b) + 1));
    add_inside(model, b, time, model.start, asked, found);
  }
  for (std::size_t i = 0; i < through.size(); ++i) through[i] = static_cast<double>(bits(through[i]) | found[i]);
}

void hold_again(const LockstepModel& model, LockstepContact& contact, double time, std::span<const Vec3> x,
                std::vector<double>& through) {
  std::vector<std::uint64_t> near = contact.near_at(x);
  const std::span<const Vec3> points = x.first(through.size());
  for (std::size_t b = 0; b < model.setup.bodies.size(); ++b) {
    std::vector<char> asked(through.size());
    for (std::size_t i = 0; i < asked.size(); ++i)
      asked[i] = (bits(through[i]) & ~near[i] & met_bit(static_cast<int>(b) + 1)) != 0;
    add_inside(model, b, time, points, asked, near);
  }
  for (std::size_t i = 0; i < through.size(); ++i) through[i] = static_cast<double>(bits(through[i]) & near[i]);
}

std::string passed_text(const LockstepModel& model, std::span<const double> through) {
  std::uint64_t all = 0;
  for (const double of_point : through) all |= bits(of_point);
  std::string moving, still;
  for (std::size_t met = model.has_prop() ? 0 : 1; met < model.met_count(); ++met) {
    if ((all & met_bit(static_cast<int>(met))) == 0) continue;
    std::string& list = met == 0 || !model.setup.bodies[met - 1].fixed ? moving : still;
    list.append(list.empty() ? "" : ", ").append("\"").append(model.name_of_met(met)).append("\"");
  }
  if (!moving.empty()) moving += ", which goes its way whatever stands in it";
  if (!still.empty()) still += ", in which they started";
  return moving + (moving.empty() || still.empty() ? "" : "; ") + still;
}

}  // namespace ft::inline solvers
