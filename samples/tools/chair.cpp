#include "samples/tools/chair.h"

#include <algorithm>

#include "samples/tools/solids.h"

namespace ft::sets {
namespace {

constexpr double k_behind = 0.085;  ///< m, of the seat's front edge behind the origin

}  // namespace

Mesh make_chair(const ChairSettings& settings) {
  constexpr double k_leg = 0.036, k_seat = 0.03, k_board = 0.016;  // m, how thick they are
  const double side = 0.5 * settings.width - 0.5 * k_leg, front = -k_leg, hind = -settings.depth + 0.5 * k_leg;
  Mesh out;
  out.name = "chair";
  const auto bar = [&](const Vec3& from, const Vec3& to, double width, double depth) {
    add(out, bevelled_box({width, (to - from).norm(), depth}, 0.2 * std::min(width, depth)), between(from, to));
  };
  // Parts stand a millimetre apart, so that each is a closed piece that touches no other.
  const double gap = 1e-3, below = settings.seat - k_seat - gap;
  add(out, bevelled_box({settings.width, k_seat, settings.depth - k_leg - gap}, 0.009),
      Eigen::Isometry3d(Eigen::Translation3d(0, settings.seat - 0.5 * k_seat, -0.5 * (settings.depth - k_leg - gap))));
  for (const double x : {-side, side}) {
    bar({x, 0, front}, {x, below, front}, k_leg, k_leg);
    bar({x, 0, hind}, {x, settings.back, hind}, k_leg, k_leg);
  }
  const double reach = settings.width - 2 * k_leg - 2 * gap;
  for (const double share : {0.38, 0.85}) {
    const double y = settings.seat + share * (settings.back - settings.seat);
    add(out, bevelled_box({reach, 0.09, k_board}, 0.004), Eigen::Isometry3d(Eigen::Translation3d(0, y, hind)));
  }
  const double strut = below - 0.04;
  add(out, bevelled_box({reach, 0.04, k_board}, 0.004), Eigen::Isometry3d(Eigen::Translation3d(0, strut, front)));
  add(out, bevelled_box({reach, 0.04, k_board}, 0.004), Eigen::Isometry3d(Eigen::Translation3d(0, strut, hind)));
  for (Vec3& p : out.positions) p.z() -= k_behind;
  return out;
}

}  // namespace ft::sets
