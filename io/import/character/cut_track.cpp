#include "io/import/character/cut_track.h"

#include <algorithm>

#include "io/import/character/pose.h"

namespace ft::inline io {
namespace {

/// (slope, value, slope) of a cubic track between its keys k and k + 1; its part on either side is then the same cubic.
std::vector<double> cubic_key(const Track& track, std::size_t k, double time) {
  const auto width = at(track.width), stride = track.stride();
  const double dt = track.times[k + 1] - track.times[k], u = (time - track.times[k]) / dt, u2 = u * u, u3 = u2 * u;
  const double* a = track.values.data() + k * stride;
  const double* b = a + stride;
  std::vector<double> out(stride);
  for (std::size_t i = 0; i < width; ++i) {
    const double p = a[width + i], m = dt * a[2 * width + i], q = b[width + i], n = dt * b[i];
    out[width + i] = (2 * u3 - 3 * u2 + 1) * p + (u3 - 2 * u2 + u) * m + (3 * u2 - 2 * u3) * q + (u3 - u2) * n;
    out[i] = out[2 * width + i] =
        ((6 * u2 - 6 * u) * p + (3 * u2 - 4 * u + 1) * m + (6 * u - 6 * u2) * q + (3 * u2 - 2 * u) * n) / dt;
  }
  return out;
}

std::vector<double> key_at(const Track& track, double time, bool rotation) {
  const auto after = std::upper_bound(track.times.begin(), track.times.end(), time);
  if (track.interpolation == KeyInterpolation::k_cubic) {
    const auto width = at(track.width);
    if (after != track.times.begin() && after != track.times.end())
      return cubic_key(track, static_cast<std::size_t>(after - track.times.begin()) - 1, time);
    std::vector<double> out(track.stride(), 0.0);
    const std::size_t held = after == track.times.begin() ? 0 : track.times.size() - 1;
    std::copy_n(track.values.data() + held * track.stride() + width, width, out.data() + width);
    return out;
  }
  std::vector<double> out(at(track.width));
  sample_track(track, time, rotation, out);
  return out;
}

}  // namespace

Track cut_track(const Track& track, double begin, double end, bool rotation) {
  if (!(track.times.front() < begin) && !(track.times.back() > end)) return track;
  Track out;
  out.interpolation = track.interpolation, out.width = track.width;
  const auto push = [&](double time, const std::vector<double>& values) {
    out.times.push_back(time);
    out.values.insert(out.values.end(), values.begin(), values.end());
  };
  const auto stride = static_cast<std::ptrdiff_t>(track.stride());
  bool at_end = false;
  if (track.times.front() < begin) push(begin, key_at(track, begin, rotation));
  for (std::size_t k = 0; k < track.times.size(); ++k) {
    const double time = track.times[k];
    if (time < begin || time > end || (!out.times.empty() && !(time > out.times.back()))) continue;
    const auto from = track.values.begin() + static_cast<std::ptrdiff_t>(k) * stride;
    push(time, std::vector<double>(from, from + stride));
    at_end = time == end;
  }
  if (!at_end && track.times.back() > end && (out.times.empty() || end > out.times.back()))
    push(end, key_at(track, end, rotation));
  return out;
}

}  // namespace ft::inline io
