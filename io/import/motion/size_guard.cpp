#include "io/import/motion/size_guard.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "baker/core/mesh.h"

namespace ft::inline io {
namespace {

constexpr double k_widest_figure = 2.5;  ///< of its height: arms to the sides span 1.05, all fours 2
constexpr double k_grown = 2.5;          ///< of the bind pose's diagonal: a figure of any pose has up to 1.6
constexpr double k_absurd = 6;
constexpr int k_most_samples = 24;

std::string format(const char* how, double a, double b, double c = 0) {
  char text[240];
  std::snprintf(text, sizeof text, how, a, b, c);
  return text;
}

}  // namespace

Status check_shape(const Box& bind, const SizedBody& body, const std::string& file, std::vector<std::string>& notes) {
  const Vec3 size = bind.size();
  const double wide = std::max(size.x(), size.z());
  if (!body.figure || !(wide > k_widest_figure * size.y())) return {};
  const std::string what =
      format("the bind pose is %.3g m tall and %.3g m wide, which no figure with arms and legs is", size.y(), wide);
  const std::string hint = "see whether up = ... is right, and whether its joints rest as a figure";
  if (body.built) return input_error(what, file, hint);
  notes.push_back(what + "; " + hint);
  return {};
}

Status check_growth(const Trajectory& trajectory, const ImportRequest& request, const SizedBody& body,
                    std::vector<std::string>& notes) {
  std::vector<Vec3> positions(static_cast<std::size_t>(trajectory.surface().vertex_count()));
  trajectory.bind_pose(positions);
  const double bind = bounds(positions).size().norm();
  const int frames = static_cast<int>(std::lround(request.duration * request.shot_fps));
  const int step = std::max(1, frames / k_most_samples);
  double largest = 0;
  int frame = 0;
  for (int f = 0; f <= frames; f += step) {
    trajectory.sample(f / request.shot_fps, positions);
    if (const double now = bounds(positions).size().norm(); now > largest) largest = now, frame = f;
  }
  if (!(largest > k_grown * bind)) return {};
  const std::string what = format("at frame %.0f it is %.3g m from corner to corner, and %.3g m in the bind pose",
                                  request.first_frame + frame, largest, bind);
  if (body.built && body.figure && largest > k_absurd * bind)  // two who walk apart are no figure
    return input_error(what + ": the positions in the motion are not those of this skeleton",
                       (request.animation.empty() ? request.file : request.animation).string(),
                       "export skeleton and motion in the same units");
  notes.push_back(what + ": see whether skeleton and motion are in the same units");
  return {};
}

}  // namespace ft::inline io
