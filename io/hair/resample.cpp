#include "io/hair/resample.h"

#include <algorithm>

#include "baker/core/check.h"

namespace ft::inline io {

double length_of(std::span<const Vec3> line) {
  double out = 0;
  for (std::size_t i = 1; i < line.size(); ++i) out += (line[i] - line[i - 1]).norm();
  return out;
}

std::vector<Vec3> resampled(std::span<const Vec3> line, int vertices) {
  CHECK(!line.empty() && vertices >= 2);
  const double length = length_of(line);
  std::vector<Vec3> out{line.front()};
  std::size_t i = 0;  // the place is between i and i + 1
  double behind = 0;  // length of the line up to i [m]
  for (int k = 1; k + 1 < vertices; ++k) {
    const double place = length * k / (vertices - 1);
    double step = i + 1 < line.size() ? (line[i + 1] - line[i]).norm() : 0;
    while (i + 2 < line.size() && behind + step < place) {
      behind += step, ++i;
      step = (line[i + 1] - line[i]).norm();
    }
    const double share = step > 0 ? std::clamp((place - behind) / step, 0.0, 1.0) : 0;
    out.push_back(i + 1 < line.size() ? ((1 - share) * line[i] + share * line[i + 1]).eval() : line[i]);
  }
  out.push_back(line.back());
  return out;
}

std::vector<Vec3> cut_to(std::span<const Vec3> line, double length) {
  std::vector<Vec3> out;
  double left = length;
  for (const Vec3& p : line) {
    const double step = out.empty() ? 0 : (p - out.back()).norm();
    if (step >= left && step > 0) {
      out.push_back(out.back() + left / step * (p - out.back()));
      return out;
    }
    left -= step;
    out.push_back(p);
  }
  return out;
}

}  // namespace ft::inline io
