// Whether two features can come near each other in a piece of a substep: the test that thins out candidate pairs.
//
// Every vertex goes straight from x to x + d, and is then anywhere in a ball. A plane that moves at constant speed
// across a fixed normal n proves that two features keep apart if it does at both ends of the way, since n . x is linear
// in time; so the normal decides how many pairs are left. Distances alone, which ask how far the features move relative
// to each other, would keep all that cloth glides past.
#pragma once

#ifdef __AVX__
#include <immintrin.h>
#endif

#include "collision/broad_phase/contact_pairs.h"
#include "collision/geometry/pair_geometry.h"

namespace ft::inline collision {

/// Of all vertices: places and ways [m]; balls around x + centre [m], of the first vertices alone, the others stop
/// where their centre is.
struct VertexWays {
  std::span<const Vec3> x;
  std::span<const Vec3f> d, centre;
  std::span<const float> slack;
};

class SweptMotion {
 public:
  enum class Verdict {
    k_open,   ///< nothing is proved
    k_clear,  ///< at least `keep` apart all along the way
    k_apart   ///< and at least `radius` apart wherever they are in their balls
  };

  /// radius, keep: [m], >= 0.
  SweptMotion(PairKind kind, const Stencil& pair, const VertexWays& ways, double radius, double keep)
      : kind_(kind),
        start_(kind, pair, ways.x),
        way_(kind, pair, ways.d),
        last_(kind, pair, ways.centre),
        radius_(radius),
        keep_(keep) {
    std::array<double, 4> s;
    for (std::size_t k = 0; k < 4; ++k) s[k] = at(pair.v[k]) < ways.slack.size() ? ways.slack[at(pair.v[k])] : 0;
    slack_ = kind == PairKind::k_vertex_face ? Lanes{s[0] + s[1], s[0] + s[2], s[0] + s[3], s[0] + s[3]}
                                             : Lanes{s[0] + s[2], s[0] + s[3], s[1] + s[2], s[1] + s[3]};
  }

  /// By planes across n, of any length.
  Verdict judge(const Vec3& n) const {
    const Lanes start = start_.along(n);
    const double side = start[0] > 0 ? 1 : -1, squared = n.squaredNorm();
    const Lanes end = start + way_.along(n);
    if (!above(side * start, keep_, squared) || !above(side * end, keep_, squared)) return Verdict::k_open;
    const Lanes last = start + last_.along(n);
    return above(side * last, slack_ + radius_, squared) ? Verdict::k_apart : Verdict::k_clear;
  }

  /// Along the way between the middles of the features, at the start and where the balls are; of any length.
  Vec3 between_centres() const { return start_.sum(kind_); }
  Vec3 between_last_centres() const { return start_.sum(kind_) + last_.sum(kind_); }
  /// flat_normal(), at the start.
  Vec3 flat() const {
    const auto less = [&](int i, int j) -> Vec3 {
      return {start_.x[i] - start_.x[j], start_.y[i] - start_.y[j], start_.z[i] - start_.z[j]};
    };
    return (kind_ == PairKind::k_vertex_face ? less(0, 1) : less(2, 0))
        .cross(less(0, kind_ == PairKind::k_vertex_face ? 2 : 1));
  }

 private:
  /// One number for each pair of a vertex of the first and one of the second feature; a vertex and a face have three,
  /// the last of them twice.
  using Lanes = double __attribute__((vector_size(32)));

  /// Whether all numbers along a normal of this squared length are more than the least, which is not negative [m].
  template <class Least>
  static bool above(const Lanes& values, const Least& least, double squared) {
    const auto no = (values <= 0) | (values * values <= least * least * squared) | (values != values);
#ifdef __AVX__
    return _mm256_testz_si256(reinterpret_cast<__m256i>(no), reinterpret_cast<__m256i>(no)) != 0;
#else
    return (no[0] | no[1] | no[2] | no[3]) == 0;
#endif
  }

  /// What the first feature's vertices have of `from`, less what the second's have.
  struct Differences {
    Lanes x, y, z;

#ifdef __AVX__
    static __m256d load(const Vec3& v) {
      return _mm256_maskload_pd(v.data(), _mm256_setr_epi64x(-1, -1, -1, 0));
    }
    static __m256d load(const Vec3f& v) {
      return _mm256_cvtps_pd(_mm_maskload_ps(v.data(), _mm_setr_epi32(-1, -1, -1, 0)));
    }
#endif

    template <class Vector>
    Differences(PairKind kind, const Stencil& pair, std::span<const Vector> from) {
      const bool face = kind == PairKind::k_vertex_face;
#ifdef __AVX__
      const __m256d v0 = load(from[at(pair.v[0])]), v1 = load(from[at(pair.v[1])]);
      const __m256d v2 = load(from[at(pair.v[2])]), v3 = load(from[at(pair.v[3])]);
      const __m256d a = _mm256_sub_pd(v0, face ? v1 : v2), b = _mm256_sub_pd(v0, face ? v2 : v3);
      const __m256d c = _mm256_sub_pd(face ? v0 : v1, face ? v3 : v2), d = _mm256_sub_pd(face ? v0 : v1, v3);
      const __m256d low_ab = _mm256_unpacklo_pd(a, b), low_cd = _mm256_unpacklo_pd(c, d);
      const __m256d high_ab = _mm256_unpackhi_pd(a, b), high_cd = _mm256_unpackhi_pd(c, d);
      x = reinterpret_cast<Lanes>(_mm256_permute2f128_pd(low_ab, low_cd, 0x20));
      y = reinterpret_cast<Lanes>(_mm256_permute2f128_pd(high_ab, high_cd, 0x20));
      z = reinterpret_cast<Lanes>(_mm256_permute2f128_pd(low_ab, low_cd, 0x31));
#else
      std::array<Vec3, 4> v;
      for (std::size_t k = 0; k < 4; ++k) v[k] = from[at(pair.v[k])].template cast<double>();
      const auto component = [&](Eigen::Index k) {
        return face ? Lanes{v[0][k], v[0][k], v[0][k], v[0][k]} - Lanes{v[1][k], v[2][k], v[3][k], v[3][k]}
                    : Lanes{v[0][k], v[0][k], v[1][k], v[1][k]} - Lanes{v[2][k], v[3][k], v[2][k], v[3][k]};
      };
      x = component(0), y = component(1), z = component(2);
#endif
    }
    Lanes along(const Vec3& n) const {
      return n[0] * x + n[1] * y + n[2] * z;
    }
    Vec3 sum(PairKind kind) const {
      const double last = kind == PairKind::k_vertex_face ? 0 : 1;
      const auto of = [&](const Lanes& l) { return l[0] + l[1] + l[2] + last * l[3]; };
      return {of(x), of(y), of(z)};
    }
  };

  PairKind kind_;
  Differences start_, way_, last_;
  Lanes slack_;
  double radius_, keep_;
};

}  // namespace ft::inline collision
