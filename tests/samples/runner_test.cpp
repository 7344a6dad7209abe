// The samples' runner, from the BVH's own text: feet on the ground stand still, and between the steps there is a
// flight.
#include "samples/tools/runner.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "baker/core/types.h"

namespace ft::sets {
namespace {

/// Where the joints are in every sample [m]: offsets, then channels as make_set writes them (Z, X, Y).
std::vector<std::map<std::string, Vec3>> joints_of(const std::string& bvh) {
  struct Joint {
    std::string name;
    int parent;
    Vec3 offset;
  };
  std::vector<Joint> joints;
  std::vector<int> open;
  std::istringstream in(bvh);
  bool site = false;
  for (std::string word; in >> word && word != "MOTION";) {
    if (word == "ROOT" || word == "JOINT") {
      in >> word;
      joints.push_back({word, open.empty() ? -1 : open.back(), Vec3::Zero()});
      open.push_back(static_cast<int>(joints.size()) - 1);
    } else if (word == "End") {
      site = true, open.push_back(-1);
    } else if (word == "OFFSET") {
      Vec3 p;
      in >> p.x() >> p.y() >> p.z();
      if (!site) joints.back().offset = p;
    } else if (word == "}") {
      site = false, open.pop_back();
    }
  }
  std::string word;
  std::size_t samples = 0;
  double step = 0;
  in >> word >> samples >> word >> word >> step;
  std::vector<std::map<std::string, Vec3>> out(samples);
  for (auto& places : out) {
    Vec3 root;
    in >> root.x() >> root.y() >> root.z();
    std::vector<Eigen::Isometry3d> turned;
    for (const Joint& joint : joints) {
      double z = 0, x = 0, y = 0;
      in >> z >> x >> y;
      const double rad = std::numbers::pi / 180;
      Eigen::Isometry3d at = Eigen::Isometry3d::Identity();
      if (joint.parent >= 0) at = turned[static_cast<std::size_t>(joint.parent)];
      at.translate(joint.parent < 0 ? root : joint.offset);
      at.rotate(Eigen::AngleAxisd(z * rad, Vec3::UnitZ()) * Eigen::AngleAxisd(x * rad, Vec3::UnitX()) *
                Eigen::AngleAxisd(y * rad, Vec3::UnitY()));
      turned.push_back(at);
      places[joint.name] = at.translation();
    }
  }
  return out;
}

/// Samples of `foot`'s first whole time on the ground after `from` [s].
std::vector<Vec3> supported(const std::vector<std::map<std::string, Vec3>>& samples, const RunnerSettings& settings,
                            const char* ball, double from) {
  std::vector<Vec3> out;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double t = static_cast<double>(k) / settings.fps - from;
    if (t >= 0 && t < settings.support * settings.stride) out.push_back(samples[k].at(ball));
  }
  return out;
}

TEST(Runner, The_ball_of_a_foot_on_the_ground_stands_still_and_the_knee_is_not_torn) {
  for (const double height : {1.2, 1.7}) {
    RunnerSettings settings;
    settings.height = height;
    settings.speed = 2.9 * height / 1.7;
    settings.seconds = 3;
    const auto samples = joints_of(runner_bvh(settings));
    ASSERT_EQ(samples.size(), 361U);
    for (const bool left : {true, false})
      for (const int stride : {0, 1, 2}) {
        const double from = settings.stride * (stride + (left ? 0.0 : 0.5));
        const auto balls = supported(samples, settings, left ? "LeftToeBase" : "RightToeBase", from);
        ASSERT_GT(balls.size(), 25U);
        for (const Vec3& ball : balls) {
          EXPECT_NEAR(ball.y(), balls[0].y(), 1e-4);
          EXPECT_NEAR(ball.z(), balls[0].z(), 1e-4);
        }
      }
  }
}

TEST(Runner, Runs_at_its_speed_with_a_flight_between_the_steps) {
  const RunnerSettings settings;
  const auto samples = joints_of(runner_bvh(settings));
  const double lowest = samples[0].at("LeftToeBase").y();
  double flights = 0;
  for (const auto& places : samples)
    flights += std::min(places.at("LeftToeBase").y(), places.at("RightToeBase").y()) > lowest + 1e-4;
  EXPECT_NEAR(flights / static_cast<double>(samples.size()), 1 - 2 * settings.support, 0.02);
  EXPECT_NEAR(samples.back().at("Hips").z() - samples.front().at("Hips").z(), settings.speed * settings.seconds, 1e-6);
}

}  // namespace
}  // namespace ft::sets
