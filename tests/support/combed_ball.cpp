#include "tests/support/combed_ball.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ft::test {
namespace {

constexpr double k_golden = 0.6180339887498949;  ///< multiples of it, without their whole part, fill [0, 1) evenly

/// Of strand i, from 0 to 1.
double chance(int i, int salt) {
  const double x = k_golden * (i + 1) * (2 * salt + 1) + 0.37 * salt;
  return x - std::floor(x);
}

int strand_at(const CombedBall& ball, int place) {
  return ball.turned ? ball.strands - 1 - place : place;
}

void add_strand(const CombedBall& ball, int i, double phase, std::vector<Vec3>& out) {
  const double around = 2 * std::numbers::pi * chance(i, 0);
  const double top = 1 - 1.1 * (i + 0.5) / ball.strands;  // cosine of the angle from the top
  const double start = std::acos(top);
  const Vec3 side(std::cos(around), 0, std::sin(around)), across(-side.z(), 0, side.x()), up(0, 1, 0);
  const Vec3 normal = std::sin(start) * side + top * up;
  Vec3 x = ball.centre + ball.radius * normal;
  out.push_back(x);
  const double length = ball.length * (0.75 + 0.25 * chance(i, 1)), piece = length / (ball.vertices - 1);
  const double layer = 1.04 + 0.22 * chance(i, 2), curl = 3 * std::sin(2 * around) + 5 * start + 0.8 * chance(i, 3);
  for (int j = 1; j < ball.vertices; ++j) {
    const double s = (j - 0.5) * piece, u = s / length;
    // Along the ball to its side, then down.
    const double angle = std::min(start + s / (layer * ball.radius), 0.5 * std::numbers::pi + 0.1 * u);
    Vec3 d = std::cos(angle) * side - std::sin(angle) * up;
    d += 0.9 * std::exp(-s / (0.06 * ball.radius)) * normal;
    const double wave = 0.16 * std::min(1.0, 2 * u);
    d += wave * (std::cos(curl + 60 * s) * across + std::sin(curl + 60 * s) * side);
    d.normalize();
    const double turn = ball.swing * u * u * std::sin(phase - 1.5 * u + 0.4 * chance(i, 4));
    x += piece * (Eigen::AngleAxisd(turn, Vec3::UnitZ()) * d);
    out.push_back(x);
  }
}

}  // namespace

CurveSet combed_curves(const CombedBall& ball) {
  CurveSet out;
  out.rest = combed_places(ball, 0);
  for (int k = 0; k < ball.strands; ++k) {
    out.vertices_per_curve.push_back(ball.vertices);
    out.ids.push_back(1000 + 2 * static_cast<std::uint64_t>(strand_at(ball, k)));
    for (int j = 0; j < ball.vertices; ++j)
      out.widths.push_back(static_cast<float>(ball.root_width * (1 - 2.0 / 3 * j / (ball.vertices - 1))));
  }
  return out;
}

std::vector<Vec3> combed_places(const CombedBall& ball, double phase) {
  std::vector<Vec3> out;
  for (int k = 0; k < ball.strands; ++k) add_strand(ball, strand_at(ball, k), phase, out);
  return out;
}

}  // namespace ft::test
