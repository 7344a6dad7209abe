// Where a vertex may be during an interval, for the pair search: the extents along seven axes, x, y, z and the four
// diagonals of a cube, which keep features apart that lie slanted (k-DOPs: Klosowski et al. 1998). In steps of some
// tens of micrometres, so that a box is one register of sixteen short numbers: a join is one instruction, a test five.
//
// Rounded outwards, and what is outside of the frame is taken to be anywhere there: nothing is ever lost, and a pair
// search that is coarse finds too many pairs.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <span>
#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "baker/core/types.h"

namespace ft::inline collision {

constexpr std::size_t k_box_axes = 7;

/// Along axis k < k_box_axes: x, y, z, x + y + z, x + y - z, x - y + z, -x + y + z.
double along_box_axis(std::size_t k, const Vec3& p);

/// Steps along each axis; the eighth lane is 0.
using BoxMargin = std::array<std::int16_t, 8>;

struct alignas(32) VertexBox {
  /// In steps; the least of both makes a join. The eighth lanes count for nothing.
  std::array<std::int16_t, 8> lo, minus_hi;

  static constexpr std::int16_t k_nowhere = 32767;
  /// What lies so many steps or more from the origin is anywhere from there on.
  static constexpr std::int16_t k_endless = 32766;
  /// Holds nothing.
  static VertexBox nowhere();
  bool is_nowhere() const { return lo[0] == k_nowhere; }
  void include(const VertexBox& other);
  bool operator==(const VertexBox&) const = default;
};

/// What the steps of boxes are counted from, and how long they are.
class BoxFrame {
 public:
  /// Steps that are fine between lo and hi [m], and around. Empty or endless bounds are a cube of one metre.
  BoxFrame(const Vec3& lo, const Vec3& hi);
  BoxFrame() : BoxFrame(Vec3::Zero(), Vec3::Zero()) {}

  /// Holds the segment a..b grown by r on every side [m].
  VertexBox swept(const Vec3& a, const Vec3& b, double r) const;
  /// No more than what a ball of radius r >= 0 reaches [m].
  BoxMargin margin(double r) const;
  /// What a box holds along an axis, where it is not endless [m].
  double lo(const VertexBox& box, std::size_t axis) const { return origin_[axis] + box.lo[axis] * step_[axis]; }
  double hi(const VertexBox& box, std::size_t axis) const { return origin_[axis] - box.minus_hi[axis] * step_[axis]; }
  double step(std::size_t axis) const { return step_[axis]; }  ///< m

 private:
  std::array<double, 8> origin_, step_, per_step_;
};

/// For what is at x and moves by d (or not, where that is empty), and a margin around [m].
BoxFrame frame_around(std::span<const Vec3> x, std::span<const Vec3> d, double margin);

/// A box, or a join of some, in a register.
struct BoxLanes {
#ifdef __AVX2__
  __m256i lanes;
  static BoxLanes load(const VertexBox& box) {
    return {_mm256_load_si256(reinterpret_cast<const __m256i*>(&box))};
  }
  BoxLanes join(const BoxLanes& b) const {
    return {_mm256_min_epi16(lanes, b.lanes)};
  }
  /// Smaller by the margin on every side, but for those that are endless.
  BoxLanes shrunk(const BoxMargin& margin) const {
    const __m128i m = _mm_loadu_si128(reinterpret_cast<const __m128i*>(margin.data()));
    const __m256i limited = _mm256_cmpgt_epi16(_mm256_set1_epi16(VertexBox::k_endless), _mm256_abs_epi16(lanes));
    return {_mm256_adds_epi16(lanes, _mm256_and_si256(limited, _mm256_broadcastsi128_si256(m)))};
  }
  bool overlaps(const BoxLanes& b) const {
    // lo - hi of the other, either way round: above 0 where they are apart. Sums stay at the limits instead of turning.
    const __m256i apart = _mm256_adds_epi16(lanes, _mm256_permute2x128_si256(b.lanes, b.lanes, 1));
    const __m256i counts = _mm256_setr_epi16(-1, -1, -1, -1, -1, -1, -1, 0, -1, -1, -1, -1, -1, -1, -1, 0);
    return _mm256_testz_si256(_mm256_cmpgt_epi16(apart, _mm256_setzero_si256()), counts) != 0;
  }
  /// All but the eighth lanes.
  void store_axes(VertexBox& box) const {
    _mm256_store_si256(reinterpret_cast<__m256i*>(&box), _mm256_blend_epi16(lanes, load(box).lanes, 0x80));
  }
#else
  VertexBox box;
  static BoxLanes load(const VertexBox& b) {
    return {b};
  }
  BoxLanes join(const BoxLanes& b) const {
    BoxLanes out = *this;
    out.box.include(b.box);
    return out;
  }
  BoxLanes shrunk(const BoxMargin& margin) const {
    BoxLanes out = *this;
    const auto add = [](int a, int b) {
      return static_cast<std::int16_t>(std::abs(a) < VertexBox::k_endless ? std::min(a + b, 32767) : a);
    };
    for (std::size_t k = 0; k < k_box_axes; ++k) {
      out.box.lo[k] = add(box.lo[k], margin[k]);
      out.box.minus_hi[k] = add(box.minus_hi[k], margin[k]);
    }
    return out;
  }
  bool overlaps(const BoxLanes& b) const {
    bool all = true;
    for (std::size_t k = 0; k < k_box_axes; ++k)
      all = all & (box.lo[k] + b.box.minus_hi[k] <= 0) & (b.box.lo[k] + box.minus_hi[k] <= 0);
    return all;
  }
  void store_axes(VertexBox& out) const {
    std::copy_n(box.lo.begin(), k_box_axes, out.lo.begin());
    std::copy_n(box.minus_hi.begin(), k_box_axes, out.minus_hi.begin());
  }
#endif
};

}  // namespace ft::inline collision
