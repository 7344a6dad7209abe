// See hair_solver.h: what is known before the first frame: groom, rest shapes, gaps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "baker/core/parallel.h"
#include "collision/check/penetration.h"
#include "solvers/hair/hair_group.h"
#include "solvers/hair/rest_shape.h"

namespace ft::inline solvers {
namespace {

/// A root that is farther from its scalp is a mistake [m].
constexpr double k_root_off = 0.05;
/// Neighbours of a stiffened strand are stiffened with it within so far of its root, fading outwards. Guessed [m].
constexpr double k_alike = 0.02;

/// Of the grid on which strands feel one another, by the distance of their roots [1].
constexpr double k_crowd_cell = 1.5;
constexpr std::size_t k_asked = 500;  ///< strands that are asked for that distance, of all

/// Length [m].
double mean_segment(const HairSetup& setup) {
  double sum = 0, count = 0;
  for (const HairStrand& strand : setup.strands)
    for (std::size_t i = 1; i < strand.positions.size(); ++i, ++count)
      sum += (strand.positions[i] - strand.positions[i - 1]).norm();
  return sum / count;
}

}  // namespace

Result<std::unique_ptr<HairSolver>> HairSolver::make(HairSetup setup) {
  const auto refuse = [&](const std::string& what) {
    return usage_error(fmt::format("hair \"{}\": {}", setup.name, what));
  };
  const HairMaterial& m = setup.material;
  if (!(setup.fps > 0) || setup.least_steps < 1 || setup.most_steps < setup.least_steps)
    return refuse("fps must be positive, least_steps 1 or more, and most_steps no less than that");
  if (!(m.radius > 0 && m.young > 0 && m.shear > 0 && m.density > 0 && m.stiffness > 0 && m.thickness > 0))
    return refuse("a material's numbers must be positive");
  if (!(m.damping >= 0 && m.drag >= 0 && m.air_drag >= 0 && m.friction >= 0))
    return refuse("a material's losses must not be negative");
  if (!(setup.hairs >= 0)) return refuse("it stands for a number of hairs that is not negative");
  if (!(m.pressure >= 0 && m.mutual_drag >= 0)) return refuse("pressure and mutual drag must not be negative");
  if (!setup.scalp) return refuse("has no scalp");
  if (setup.strands.empty()) return refuse("has no strand");
  if (setup.riders.size() != setup.ridden.positions.size())
    return refuse(
        fmt::format("its mesh has {} vertices, and {} riders", setup.ridden.positions.size(), setup.riders.size()));
  for (std::size_t s = 0; s < setup.strands.size(); ++s) {
    const std::vector<Vec3>& x = setup.strands[s].positions;
    if (x.size() < 3 || x.size() != setup.strands[0].positions.size())
      return refuse(fmt::format("strand {} has {} vertices, and the first {}; all have as many, 3 or more", s, x.size(),
                                setup.strands[0].positions.size()));
    if (setup.strands[s].held < 1) return refuse(fmt::format("strand {} is not held at its root", s));
    for (std::size_t i = 0; i < x.size(); ++i)
      if (!x[i].allFinite() || (i > 0 && !((x[i] - x[i - 1]).norm() > 1e-6)))
        return refuse(fmt::format("strand {} has an edge without length", s));
  }
  std::unique_ptr<HairSolver> solver(new HairSolver(std::move(setup)));
  if (solver->farthest_root() > k_root_off)
    return usage_error(
        fmt::format("hair \"{}\": a root is {:.0f} mm from the surface that it should grow on; scale and "
                    "position of the guides, or what it is on, may be wrong",
                    solver->setup_.name, 1e3 * solver->farthest_root()));
  return solver;
}

HairSolver::HairSolver(HairSetup setup) : setup_(std::move(setup)), bodies_(setup_.bodies, mean_segment(setup_)) {
  n_ = static_cast<int>(setup_.strands[0].positions.size()) + 1;
  const double counted = static_cast<double>(setup_.between.empty() ? setup_.strands.size() : setup_.between.size());
  hairs_ = (setup_.hairs > 0 ? setup_.hairs : counted) / static_cast<double>(setup_.strands.size());
  std::vector<Vec3> roots;
  for (const HairStrand& strand : setup_.strands) roots.push_back(strand.positions.front());
  roots_ = std::make_unique<HairRoots>(*setup_.scalp, roots);
  shape_ = curves_of(setup_);
  for (const HairStrand& strand : setup_.strands) {
    auto& groom = groom_.emplace_back();
    groom.push_back(2 * strand.positions[0] - strand.positions[1]);
    groom.insert(groom.end(), strand.positions.begin(), strand.positions.end());
    double length = 0;
    Vec3 director = (groom[1] - groom[0]).unitOrthogonal(), before = (groom[1] - groom[0]).normalized();
    for (std::size_t j = 0; j + 1 < groom.size(); ++j) {
      const Vec3 t = (groom[j + 1] - groom[j]).normalized();
      director = plain(carried_director(plain(director), plain(before), plain(t)));
      before = t;
      directors_.push_back(director);
      if (j > 0) length += (groom[j + 1] - groom[j]).norm();
    }
    lengths_.push_back(length);
  }
  measure_gaps();
  make_groups();
  make_crowd();
  std::vector<Vec3> x, d;
  for (std::size_t s = 0; s < groom_.size(); ++s) {
    x.insert(x.end(), groom_[s].begin() + 1, groom_[s].end());
    add_directors(std::span(directors_).subspan(s * at(n_ - 1), at(n_ - 1)), d);
  }
  const GuidesNow groom{x, x, d};
  if (!setup_.between.empty()) {
    between_shape_ = curves_between(setup_);
    between_ = std::make_unique<StrandsBetween>(setup_.between, vertices(), setup_.scalp, groom, setup_.bodies);
    setup_.between.clear();  // as large as a frame
  }
  if (!setup_.ridden.positions.empty())
    ridden_ = std::make_unique<RiddenMesh>(setup_.ridden, setup_.riders, vertices(), groom, roots_->bind());
}

/// How near each vertex was combed; bodies_ stands in its bind pose.
void HairSolver::measure_gaps() {
  const std::size_t n = at(n_), count = setup_.strands.size();
  gaps_.assign(count * n, 1.0);
  segment_gaps_.assign(count * n, 1.0);
  const double reach = 4 * setup_.material.thickness;
  parallel_for(count, 16, [&](std::size_t begin, std::size_t end) {
    std::vector<std::pair<int, int>> candidates;
    for (std::size_t s = begin; s < end; ++s) {
      find_candidates(bodies_, bounds(groom_[s]), reach, candidates);
      for (std::size_t i = 1; i < n; ++i) {
        NearSurface near;
        if (find_nearest(bodies_, candidates, groom_[s][i], reach, 1, &near) > 0) gaps_[s * n + i] = near.gap;
        if (i < 2) continue;
        if (const auto edge = find_nearest_edge(bodies_, groom_[s][i - 1], groom_[s][i], reach))
          segment_gaps_[s * n + i] = edge->surface.gap;
        if (find_nearest(bodies_, candidates, 0.5 * (groom_[s][i - 1] + groom_[s][i]), reach, 1, &near) > 0)
          segment_gaps_[s * n + i] = std::min(segment_gaps_[s * n + i], near.gap);
      }
    }
  });
  combed_through_ = 0;
  for (std::size_t s = 0; s < count && bodies_.has_sheets(); ++s)
    for (std::size_t i = at(std::max(2, setup_.strands[s].held + 1)); i < n; ++i)
      combed_through_ += bodies_.through_sheet(groom_[s][i - 1], groom_[s][i]) ? 1 : 0;
  // What is deep inside, too.
  std::vector<Vec3> all;
  for (const std::vector<Vec3>& strand : groom_) all.insert(all.end(), strand.begin(), strand.end());
  for (int b = 0; b < bodies_.count(); ++b) {
    if (bodies_.sheet(b)) continue;
    for (const Penetration& p : penetrations(all, bodies_.before(b), bodies_.triangles(b), 0))
      gaps_[at(p.vertex)] = std::min(gaps_[at(p.vertex)], -p.depth);
  }
}

/// Some hundred strands say how far apart roots are in the middle; a cell holds some of them.
void HairSolver::make_crowd() {
  const HairMaterial& m = setup_.material;
  if ((m.pressure == 0 && m.mutual_drag == 0) || setup_.strands.size() < 2) return;
  std::vector<Vec3> x;
  std::vector<double> mass;
  std::vector<double> nearest;
  const auto bind = roots_->bind();
  const std::size_t every = (groom_.size() + k_asked - 1) / k_asked;
  for (std::size_t s = 0; s < groom_.size(); s += every) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < groom_.size(); ++k)
      if (k != s) least = std::min(least, (bind[k].place - bind[s].place).norm());
    nearest.push_back(least);
  }
  for (std::size_t s = 0; s < groom_.size(); ++s) {
    for (std::size_t i = 1; i < at(n_); ++i) {
      x.push_back(groom_[s][i]);
      mass.push_back(rods_[s / k_lanes].mass[i][static_cast<int>(s % k_lanes)]);
    }
  }
  std::nth_element(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2), nearest.end());
  CrowdSettings settings;
  settings.pressure = m.pressure;
  settings.cell = std::max({settings.cell, k_crowd_cell * nearest[nearest.size() / 2], 1.5 * mean_segment(setup_)});
  crowd_.emplace(settings, x, mass);
}

std::size_t HairSolver::strand_of(std::size_t group, int lane) const {
  return std::min(k_lanes * group + at(lane), setup_.strands.size() - 1);
}

/// Neighbours on the scalp swing alike: each is as stiff as the stiffest near it asks for, less with distance.
void HairSolver::stiffen_alike(std::vector<double>& factors) const {
  std::vector<double> logs(factors.size());
  const auto bind = roots_->bind();
  parallel_for(factors.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      double largest = std::log(factors[s]), sum = 0, weight = 0;
      for (std::size_t k = 0; k < factors.size(); ++k) {
        const double r = (bind[k].place - bind[s].place).norm() / k_alike;
        if (r >= 1) continue;
        const double w = (1 - r) * (1 - r);
        sum += w * std::log(factors[k]), weight += w;
      }
      logs[s] = std::max(largest, sum / weight);
    }
  });
  for (std::size_t s = 0; s < factors.size(); ++s) factors[s] = std::exp(logs[s]);
}

CombedInside HairSolver::combed_inside() const {
  CombedInside out;
  for (std::size_t s = 0; s < setup_.strands.size(); ++s)
    for (std::size_t i = at(setup_.strands[s].held) + 1; i < at(n_); ++i) {
      const double gap = gaps_[s * at(n_) + i];
      if (gap >= 0) {
        out.segments += segment_gaps_[s * at(n_) + i] < 0 ? 1 : 0;
        continue;
      }
      ++out.vertices;
      out.deepest = std::max(out.deepest, -gap);
    }
  return out;
}

void HairSolver::make_groups() {
  const HairMaterial& m = setup_.material;
  const double area = std::numbers::pi * m.radius * m.radius;
  const std::size_t n = at(n_), count = setup_.strands.size();
  std::vector<Rod<double>> rods(count);
  const auto pose_of = [&](std::size_t s) {
    RodPose<double> pose;
    for (const Vec3& p : groom_[s]) pose.x.push_back(plain(p));
    for (std::size_t j = 0; j + 1 < n; ++j) pose.director.push_back(plain(directors_[s * (n - 1) + j]));
    return pose;
  };
  const auto forces_of = [&](std::size_t s) {
    std::vector<Vec3> out;
    for (const double mass : rods[s].mass) out.push_back(mass * setup_.combed_gravity.value_or(setup_.gravity));
    return out;
  };
  stiffened_.assign(count, 1.0);
  parallel_for(count, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      Rod<double>& rod = rods[s];
      rod.n = n_;
      rod.stretch = m.young * area;
      rod.bend = m.stiffness * m.young * area * m.radius * m.radius / 4;
      rod.twist = m.stiffness * m.shear * area * m.radius * m.radius / 2;
      for (std::size_t j = 0; j + 1 < n; ++j) rod.length.push_back((groom_[s][j + 1] - groom_[s][j]).norm());
      rod.voronoi.assign(n, rod.length[1]);
      rod.mass.assign(n, 0.0);
      for (std::size_t i = 1; i < n; ++i) {
        const double before = i > 1 ? rod.length[i - 1] : 0.0, after = i + 1 < n ? rod.length[i] : 0.0;
        rod.mass[i] = m.density * area * 0.5 * (before + after);
        if (i + 1 < n) rod.voronoi[i] = 0.5 * (before + after);
      }
      rod.k1.assign(n, 0), rod.k2 = rod.tw = rod.k1;
      Rod<double> trial = rod;
      const int held = setup_.strands[s].held;
      double free = 1e-3;  // length that can swing
      for (std::size_t j = at(held); j + 1 < n; ++j) free += rod.length[j];
      stiffened_[s] = stand_still(trial, pose_of(s), forces_of(s),
                                  slowest_wanted(free, setup_.combed_gravity.value_or(setup_.gravity).norm()), held);
    }
  });
  stiffen_alike(stiffened_);
  parallel_for(count, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) stand_still_at(stiffened_[s], rods[s], pose_of(s), forces_of(s));
  });
  rods_.resize((count + k_lanes - 1) / k_lanes);
  for (std::size_t g = 0; g < rods_.size(); ++g) {
    Rod<Lanes>& all = rods_[g];
    all.n = n_;
    all.length.resize(n - 1), all.voronoi.resize(n), all.mass.resize(n), all.k1.resize(n), all.k2.resize(n),
        all.tw.resize(n);
    for (int lane = 0; lane < k_lanes; ++lane) {
      const Rod<double>& one = rods[strand_of(g, lane)];
      for (std::size_t i = 0; i < n; ++i) {
        if (i + 1 < n) all.length[i][lane] = one.length[i];
        all.voronoi[i][lane] = one.voronoi[i], all.mass[i][lane] = one.mass[i];
        all.k1[i][lane] = one.k1[i], all.k2[i][lane] = one.k2[i], all.tw[i][lane] = one.tw[i];
      }
      all.stretch[lane] = one.stretch, all.bend[lane] = one.bend, all.twist[lane] = one.twist;
    }
  }
}

}  // namespace ft::inline solvers
