// Four strands at once: a number of each in one register, and vectors of such numbers. All formulas of rods are
// templates of their number, which is Lanes where many strands move and double where one is looked at.
//
// Groups of four are fixed by index, and a lane never mixes with another: a strand's bits do not depend on its
// neighbours but through the number of iterations, which each lane has for itself.
#pragma once

#include <algorithm>
#include <cmath>

#include "baker/core/types.h"

namespace ft::inline solvers {

inline constexpr int k_lanes = 4;
using Lanes = double __attribute__((vector_size(32)));

inline double root_of(double a) {
  return std::sqrt(a);
}
inline Lanes root_of(const Lanes& a) {
  return Lanes{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
}
inline double log_of(double a) {
  return std::log(a);
}
inline Lanes log_of(const Lanes& a) {
  return Lanes{std::log(a[0]), std::log(a[1]), std::log(a[2]), std::log(a[3])};
}
/// Where `condition`, lane by lane.
template <class C, class T>
T choose(const C& condition, const T& yes, const T& no) {
  return condition ? yes : no;
}
template <class T>
T smaller(const T& a, const T& b) {
  return choose(a < b, a, b);
}
template <class T>
T larger(const T& a, const T& b) {
  return choose(a > b, a, b);
}
template <class T>
T absolute(const T& a) {
  return choose(a < T{} + 0.0, T(-a), a);
}
inline double largest_lane(const Lanes& a) {
  return std::max(std::max(a[0], a[1]), std::max(a[2], a[3]));
}
inline double largest_lane(double a) {
  return a;
}
template <class T>
T all_lanes(double a) {
  return T{} + a;
}

template <class T>
struct V3 {
  T x{}, y{}, z{};
  V3& operator+=(const V3& b) { return x += b.x, y += b.y, z += b.z, *this; }
  V3& operator-=(const V3& b) { return x -= b.x, y -= b.y, z -= b.z, *this; }
};
template <class T>
V3<T> operator+(V3<T> a, const V3<T>& b) {
  return a += b;
}
template <class T>
V3<T> operator-(V3<T> a, const V3<T>& b) {
  return a -= b;
}
template <class T>
V3<T> operator-(const V3<T>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class T>
V3<T> operator*(const T& s, const V3<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
T dot(const V3<T>& a, const V3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
V3<T> cross(const V3<T>& a, const V3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
T norm(const V3<T>& a) {
  return root_of(dot(a, a));
}

inline V3<double> plain(const Vec3& a) {
  return {a.x(), a.y(), a.z()};
}
inline Vec3 plain(const V3<double>& a) {
  return {a.x, a.y, a.z};
}
inline void set_lane(V3<Lanes>& a, int lane, const Vec3& b) {
  a.x[lane] = b.x(), a.y[lane] = b.y(), a.z[lane] = b.z();
}
inline Vec3 lane_of(const V3<Lanes>& a, int lane) {
  return {a.x[lane], a.y[lane], a.z[lane]};
}

/// Rows.
template <class T>
struct M3 {
  V3<T> r[3];
  T& operator()(int i, int j) { return j == 0 ? r[i].x : j == 1 ? r[i].y : r[i].z; }
  const T& operator()(int i, int j) const { return j == 0 ? r[i].x : j == 1 ? r[i].y : r[i].z; }
  M3& operator+=(const M3& b) { return r[0] += b.r[0], r[1] += b.r[1], r[2] += b.r[2], *this; }
  M3& operator-=(const M3& b) { return r[0] -= b.r[0], r[1] -= b.r[1], r[2] -= b.r[2], *this; }
};
template <class T>
M3<T> operator+(M3<T> a, const M3<T>& b) {
  return a += b;
}
template <class T>
M3<T> operator-(M3<T> a, const M3<T>& b) {
  return a -= b;
}
template <class T>
M3<T> operator*(const T& s, const M3<T>& a) {
  return {{s * a.r[0], s * a.r[1], s * a.r[2]}};
}
template <class T>
M3<T> outer(const V3<T>& a, const V3<T>& b) {
  return {{a.x * b, a.y * b, a.z * b}};
}
template <class T>
M3<T> transposed(const M3<T>& a) {
  return {{{a.r[0].x, a.r[1].x, a.r[2].x}, {a.r[0].y, a.r[1].y, a.r[2].y}, {a.r[0].z, a.r[1].z, a.r[2].z}}};
}
template <class T>
M3<T> diagonal(const T& a) {
  const T zero{};
  return {{{a, zero, zero}, {zero, a, zero}, {zero, zero, a}}};
}
/// v -> a x v.
template <class T>
M3<T> cross_matrix(const V3<T>& a) {
  const T zero{};
  return {{{zero, -a.z, a.y}, {a.z, zero, -a.x}, {-a.y, a.x, zero}}};
}

}  // namespace ft::inline solvers
