#include "collision/broad_phase/flat_patches.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "baker/core/parallel.h"
#include "collision/broad_phase/patch_builder.h"

namespace ft::inline collision {
namespace {

constexpr std::size_t k_block = 256;
/// Of its distance at rest, what a pair keeps at least; contact's radius of neighbours is the same half.
constexpr double k_kept = 0.5;
constexpr double k_rounding = 1e-3;  ///< of m, of an evaluation in single precision of triangles that are no slivers
constexpr float k_spare = 0.1f;      ///< of m: what a step may turn and strain before a patch that begins flat is none

constexpr float k_infinity = std::numeric_limits<float>::infinity();

using Frame = std::array<float, 6>;

/// The two orthonormal vectors nearest to the columns of g (polar decomposition); zero where there are none.
Frame nearest_frame(const Eigen::Matrix<double, 3, 2>& g) {
  const Eigen::Matrix2d c = g.transpose() * g;
  const double root = std::sqrt(std::max(0.0, c.determinant())), trace = std::sqrt(c.trace() + 2 * root);
  if (!(root > 1e-6 * c.trace())) return {};
  const Eigen::Matrix2d stretch = (c + root * Eigen::Matrix2d::Identity()) / trace;
  const Eigen::Matrix<float, 3, 2> r = (g * stretch.inverse()).cast<float>();
  return {r(0, 0), r(1, 0), r(2, 0), r(0, 1), r(1, 1), r(2, 1)};
}

inline float dot(const float* a, const std::array<float, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

FlatPatches::FlatPatches(std::span<const Vec3> rest, std::span<const Triangle> triangles, double reach)
    : rest_(rest), triangles_(triangles) {
  by_sides_.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Sides s = sides(rest, t);
    const Vec3f a(s.a.data()), b(s.b.data());
    // Of the sides' matrix on a plane that faces the triangle by k_facing at least: its norm by its determinant.
    const float area = PatchBuilder::k_facing * a.cross(b).norm();
    by_sides_.push_back(std::sqrt(a.squaredNorm() + b.squaredNorm()) / std::max(area, 1e-30f));
  }
  const PatchBuilder builder(rest, triangles, reach);
  const std::vector<int> seeds = builder.seeds();
  std::vector<SpreadPatch> patches(seeds.size());
  parallel_for(seeds.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) patches[k] = builder.spread(seeds[k]);
  });
  std::erase_if(patches, [](const SpreadPatch& p) { return p.members.size() < 2; });
  for (SpreadPatch& p : patches)
    std::erase_if(p.cover, [&](int t) { return std::binary_search(p.members.begin(), p.members.end(), t); });
  for (const SpreadPatch& p : patches) {
    members_.push_back(p.members);
    beside_.push_back(p.cover);
  }
  members_.shrink_to_fit();
  beside_.shrink_to_fit();
  plane_.reserve(patches.size());
  least_.reserve(patches.size());
  for (const SpreadPatch& p : patches) {
    plane_.push_back({});
    for (std::size_t k = 0; k < 6; ++k) plane_.back()[k] = static_cast<float>(p.axes[k / 3][static_cast<int>(k % 3)]);
    least_.push_back(static_cast<float>((k_kept + k_rounding) * p.stretch));
  }
  frame_.resize(patches.size());
  first_flatness_.resize(patches.size());
  flat_.assign(patches.size(), 0);
}

FlatPatches::Sides FlatPatches::sides(std::span<const Vec3> x, std::size_t triangle) const {
  const Triangle& t = triangles_[triangle];
  const Vec3f a = (x[at(t[1])] - x[at(t[0])]).cast<float>(), b = (x[at(t[2])] - x[at(t[0])]).cast<float>();
  return {{a.x(), a.y(), a.z()}, {b.x(), b.y(), b.z()}};
}

/// m of a patch, from the sides of its triangles. With D = those at rest on the plane and Q = R^T times those now it is
/// the smallest eigenvalue of sym(Q adj D) / det D.
template <class RestOf, class NowOf>
float FlatPatches::flatness(std::size_t patch, RestOf&& rest_of, NowOf&& now_of) const {
  const float* axes = plane_[patch].data();
  const float* r = frame_[patch].data();
  float least = k_infinity;
  bool finite = true;
  const auto look = [&](int t) {
    const Sides &rest = rest_of(at(t)), &now = now_of(at(t));
    const float d00 = dot(axes, rest.a), d01 = dot(axes, rest.b), d10 = dot(axes + 3, rest.a),
                d11 = dot(axes + 3, rest.b);
    const float q00 = dot(r, now.a), q01 = dot(r, now.b), q10 = dot(r + 3, now.a), q11 = dot(r + 3, now.b);
    const float first = q00 * d11 - q01 * d10, second = q11 * d00 - q10 * d01;
    const float twice_shear = q01 * d00 - q00 * d01 + q10 * d11 - q11 * d10;
    const float root = std::sqrt((first - second) * (first - second) + twice_shear * twice_shear);
    const float m = 0.5f * (first + second - root) / (d00 * d11 - d01 * d10);
    finite = finite && m > -k_infinity;
    least = std::min(least, m);
  };
  for (const AscendingRows* rows : {&members_, &beside_}) rows->for_each(static_cast<int>(patch), look);
  return finite ? least : -k_infinity;
}

void FlatPatches::begin(std::span<const Vec3> x) {
  first_ = x;
  // Patches overlap: measured once, and forgotten.
  std::vector<Sides> rest_sides(triangles_.size()), now_sides(triangles_.size());
  parallel_for(triangles_.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) rest_sides[t] = sides(rest_, t), now_sides[t] = sides(x, t);
  });
  const auto rest_of = [&](std::size_t t) -> const Sides& { return rest_sides[t]; };
  const auto now_of = [&](std::size_t t) -> const Sides& { return now_sides[t]; };
  parallel_for(flat_.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Eigen::Map<const Eigen::Matrix<float, 3, 2>> plane(plane_[p].data());
      Eigen::Matrix<double, 3, 2> sum = Eigen::Matrix<double, 3, 2>::Zero();
      members_.for_each(static_cast<int>(p), [&](int t) {
        const Sides &rest = rest_of(at(t)), &now = now_of(at(t));
        Eigen::Matrix2d d;
        d << dot(plane_[p].data(), rest.a), dot(plane_[p].data(), rest.b), dot(plane_[p].data() + 3, rest.a),
            dot(plane_[p].data() + 3, rest.b);
        Eigen::Matrix2d adjugate;
        adjugate << d(1, 1), -d(0, 1), -d(1, 0), d(0, 0);
        Eigen::Matrix<double, 3, 2> sides;
        for (int i = 0; i < 3; ++i) sides.row(i) << now.a[at(i)], now.b[at(i)];
        sum += sides * adjugate;  // weighted by area
      });
      frame_[p] = nearest_frame(sum);
      first_flatness_[p] = flatness(p, rest_of, now_of);
      flat_[p] = first_flatness_[p] >= least_[p] + k_spare ? 1 : 0;
    }
  });
}

bool FlatPatches::keep(std::span<const Vec3> x, bool to_spare, std::vector<int>& lost) {
  std::vector<float> changes(triangles_.size());  // per triangle: how much its m can have changed, at most
  parallel_for(triangles_.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Sides first = sides(first_, t), now = sides(x, t);
      float squared = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const float a = now.a[k] - first.a[k], b = now.b[k] - first.b[k];
        squared += a * a + b * b;
      }
      changes[t] = squared < k_infinity ? by_sides_[t] * std::sqrt(squared) : k_infinity;
    }
  });
  std::vector<char> still(flat_.size(), 0);
  const auto rest_of = [&](std::size_t t) { return sides(rest_, t); };
  const auto now_of = [&](std::size_t t) { return sides(x, t); };
  parallel_for(flat_.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      if (flat_[p] == 0) continue;
      const float least = least_[p] + (to_spare ? k_spare : 0.f);
      float change = 0;
      for (const AscendingRows* rows : {&members_, &beside_})
        rows->for_each(static_cast<int>(p), [&](int t) { change = std::max(change, changes[at(t)]); });
      // m is a Lipschitz function of the gradient, with constant 1: most patches are known to be flat by that.
      still[p] = first_flatness_[p] - change >= least || flatness(p, rest_of, now_of) >= least ? 1 : 0;
    }
  });
  const std::size_t before = lost.size();
  for (std::size_t p = 0; p < flat_.size(); ++p)
    if (flat_[p] != still[p]) lost.push_back(static_cast<int>(p));
  flat_.swap(still);
  return lost.size() == before;
}

}  // namespace ft::inline collision
