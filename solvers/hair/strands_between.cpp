#include "solvers/hair/strands_between.h"

#include <algorithm>
#include <cmath>

#include "baker/core/parallel.h"
#include "baker/core/smooth_step.h"

namespace ft::inline solvers {
namespace {

/// Share of the length from which on a strand goes with its nearest guide alone: mixtures of guides that part would be
/// shorter than any of them, and hair moves in locks [1].
constexpr double k_alone = 0.4;
/// Of what a strand has got away from where its guides have it, by lengths and by bodies, each segment goes back [1].
constexpr double k_back = 0.2;
constexpr double k_aside = 0.01;  ///< farther than this from its guide a strand is looked at with care [m]
constexpr int k_rounds = 3;       ///< of pushing out and giving the length back
/// Guides that part: where one would have a strand so far from where the nearest has it, it counts by a half [m].
constexpr double k_parted = 0.01;
constexpr int k_halvings = 3;    ///< of the way from a guide, until a strand is on it
constexpr double k_gap = 3e-4;   ///< to which strands are pushed out of bodies [m]
constexpr double k_look = 0.06;  ///< how far from a guide a body is looked for [m]

std::vector<Vec3> roots_of(std::span<const BetweenStrand> strands) {
  std::vector<Vec3> out;
  for (const BetweenStrand& strand : strands) out.push_back(strand.positions.front());
  return out;
}

double share_of_nearest(std::size_t i, std::size_t n) {
  return smooth_step(static_cast<double>(i) / (k_alone * static_cast<double>(n - 1)));
}

}  // namespace

std::vector<Mat3> frames_of(const GuidesNow& guides, std::size_t n) {
  std::vector<Mat3> out(guides.x.size());
  parallel_for(guides.x.size() / n, 32, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin * n; k < end * n; ++k) {
      const std::size_t i = k % n, before = i > 0 ? k - 1 : k, after = i + 1 < n ? k + 1 : k;
      const Vec3 t = (guides.x[after] - guides.x[before]).normalized();
      const Vec3 mean = guides.director[before] + guides.director[k], square = mean - t.dot(mean) * t;
      const Vec3 d = square.norm() > 1e-9 ? Vec3(square.normalized()) : t.unitOrthogonal();
      out[k].col(0) = t, out[k].col(1) = d, out[k].col(2) = t.cross(d);
    }
  });
  return out;
}

StrandsBetween::StrandsBetween(std::span<const BetweenStrand> strands, int vertices,
                               std::shared_ptr<const Trajectory> scalp, const GuidesNow& groom,
                               std::span<const HairBody> bodies)
    : n_(at(vertices)), scalp_(std::move(scalp)), roots_(*scalp_, roots_of(strands)), bodies_(bodies) {
  const std::vector<Mat3> frames = frames_of(groom, n_);
  const std::vector<Plane> planes = planes_near(groom);
  const std::size_t count = strands.size() * n_;
  offsets_.resize(count), lengths_.resize(count), keeps_.resize(count);
  for (const BetweenStrand& strand : strands) strands_.push_back({strand.guides, strand.share});
  parallel_for(strands.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      for (std::size_t i = 0; i < n_; ++i) {
        const Vec3& p = strands[s].positions[i];
        const std::size_t at_vertex = s * n_ + i;
        for (std::size_t k = 0; k < 3; ++k) {
          if (strands_[s].guides[k] < 0) continue;
          const std::size_t of_guide = at(strands_[s].guides[k]) * n_ + i;
          offsets_[at_vertex][k] = (frames[of_guide].transpose() * (p - groom.x[of_guide])).cast<float>();
        }
        lengths_[at_vertex] = i > 0 ? static_cast<float>((p - strands[s].positions[i - 1]).norm()) : 0.0f;
        // Where its guide was combed inside, it stays as deep.
        const std::size_t nearest = at(strands_[s].guides[0]) * n_ + i;
        const double gap = planes[nearest].gap < k_gap ? -bodies_.depth(p, k_look) : k_gap;
        keeps_[at_vertex] = static_cast<float>(std::min(gap, k_gap));
      }
  });
}

std::vector<StrandsBetween::Plane> StrandsBetween::planes_near(const GuidesNow& guides) const {
  std::vector<Plane> out(guides.x.size());
  parallel_for(out.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (const auto near = bodies_.nearest(guides.x[k], k_look)) out[k] = {near->place, near->normal, near->gap};
  });
  return out;
}

/// Whether it was inside. Where its guide is so far from all bodies that it cannot be, nothing is asked.
bool StrandsBetween::push_out(const Plane& of_guide, const Vec3& guide, double keeps, Vec3& p) const {
  const double aside = (p - guide).norm();
  if (of_guide.gap >= 1 ? aside < k_look - k_gap : of_guide.gap - aside > keeps) return false;
  // No farther than the place that is known.
  const double look = of_guide.gap < 1 ? std::min(k_look, 1.0001 * (p - of_guide.place).norm() + 1e-6) : k_look;
  const auto near = bodies_.nearest(p, look);
  if (!near || near->gap >= keeps) return false;
  p += (keeps - near->gap) * near->normal;
  return true;
}

/// Of a segment that goes through a sheet both ends go nearer to the nearest guide, by halves, and in the end onto it;
/// what that puts into a body, too. A guide that goes through the sheet itself keeps its strands there.
void StrandsBetween::clear_sheets(const GuidesNow& guides, std::span<const Plane> planes, std::size_t strand,
                                  std::span<Vec3> p) const {
  const std::size_t first = at(strands_[strand].guides[0]) * n_;
  const auto may_reach = [&](std::size_t i) {
    const double way = (p[i] - guides.x[first + i]).norm() + lengths_[strand * n_ + i];
    return planes[first + i].gap >= 1 ? way > k_look : planes[first + i].gap < way;
  };
  thread_local std::vector<int> halved;
  halved.assign(n_, 0);
  bool again = true;
  const auto nearer = [&](std::size_t k) {
    if (k == 0 || halved[k] > k_halvings) return;
    again = true;
    const double share = ++halved[k] > k_halvings ? 0 : 0.5;
    p[k] = guides.x[first + k] + share * (p[k] - guides.x[first + k]);
  };
  while (again) {
    again = false;
    for (std::size_t i = 1; i < n_; ++i) {
      if (may_reach(i) && bodies_.through_sheet(p[i - 1], p[i]))
        nearer(i - 1), nearer(i);
      else if (halved[i] > 0 && bodies_.depth(p[i], k_look) > 0)
        nearer(i);
    }
  }
}

void StrandsBetween::place(const GuidesNow& guides, double time, std::vector<Vec3f>& x, std::vector<Vec3f>& v) const {
  const std::lock_guard guard(busy_);
  bodies_.start_at(time);
  std::vector<Vec3> skin(at(scalp_->surface().vertex_count()));
  scalp_->sample(time, skin);
  std::vector<RootFrame> roots;
  roots_.frames(skin, roots);
  const std::vector<Mat3> frames = frames_of(guides, n_);
  const std::vector<Plane> planes = planes_near(guides);
  x.resize(offsets_.size()), v.resize(offsets_.size());
  const bool sheets = bodies_.has_sheets();
  parallel_for(strands_.size(), 32, [&](std::size_t begin, std::size_t end) {
    std::vector<Vec3> places(n_);
    for (std::size_t s = begin; s < end; ++s) {
      const Strand& strand = strands_[s];
      Vec3 before = Vec3::Zero(), before_free = Vec3::Zero();
      for (std::size_t i = 0; i < n_; ++i) {
        const std::size_t to = s * n_ + i;
        const double alone = share_of_nearest(i, n_);
        Vec3 free = Vec3::Zero(), speed = Vec3::Zero(), by_nearest = Vec3::Zero();
        double all = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          double share = (1 - alone) * strand.share[k] + (k == 0 ? alone : 0);
          if (share == 0) continue;
          const std::size_t of_guide = at(strand.guides[k]) * n_ + i;
          const Vec3 by_it = guides.x[of_guide] + frames[of_guide] * offsets_[to][k].cast<double>();
          if (k == 0) by_nearest = by_it;
          share /= 1 + (by_it - by_nearest).squaredNorm() / (k_parted * k_parted);
          free += share * by_it;
          speed += share * guides.v[of_guide];
          all += share;
        }
        free /= all, speed /= all;
        Vec3 p = roots[s].place;
        if (i > 0) {
          const double length = lengths_[to];
          const auto reached = [&](const Vec3& way) {
            return way.norm() > 1e-12 ? Vec3(before + length / way.norm() * way) : Vec3(before + Vec3(0, -length, 0));
          };
          p = reached(free - before_free + k_back * (before_free - before));
          const std::size_t nearest = at(strand.guides[0]) * n_ + i;
          // In the end rather outside than of its length.
          bool pushed = false;
          for (int round = 0; push_out(planes[nearest], guides.x[nearest], keeps_[to], p) && round < k_rounds; ++round)
            p = reached(p - before), pushed = true;
          // Where a body is inside of itself, as an arm in a trunk, the nearest surface says nothing: nearer to the
          // guide.
          const Vec3 off = p - guides.x[nearest];
          const double aside = off.norm();
          if (keeps_[to] > 0 && (pushed || aside > k_aside) && planes[nearest].gap < aside && bodies_.rays_inside(p)) {
            p = guides.x[nearest] + std::min(1.0, k_aside / aside) * off;
            if (bodies_.rays_inside(p)) p = guides.x[nearest];
          }
        }
        before = p, before_free = free;
        places[i] = p;
        v[to] = speed.cast<float>();
      }
      if (sheets) clear_sheets(guides, planes, s, places);
      for (std::size_t i = 0; i < n_; ++i) x[s * n_ + i] = places[i].cast<float>();
    }
  });
}

}  // namespace ft::inline solvers
