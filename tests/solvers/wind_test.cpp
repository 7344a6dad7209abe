// Fields of moving air: contracts that all kinds keep, and each against its closed form.
#include "solvers/wind/wind.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "baker/core/parallel.h"
#include "baker/core/random.h"
#include "solvers/wind/body_paths.h"
#include "solvers/wind/log_profile.h"
#include "solvers/wind/registry.h"
#include "solvers/wind/surface_shelter.h"
#include "solvers/wind/velocity_grid.h"
#include "solvers/wind/wake.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

using std::numbers::pi;

constexpr double k_speed = 6, k_drag_area = 0.5;  ///< of the body that makes a wake

/// A body that goes straight along x, through the origin at time 0.
std::shared_ptr<const BodyPaths> straight_path(double speed = k_speed, double drag_area = k_drag_area) {
  BodyPath path;
  path.drag_area = drag_area;
  constexpr int k_samples = 481;
  constexpr double k_interval = 1.0 / 48, k_first = -8;
  for (int s = 0; s < k_samples; ++s) {
    path.centres.emplace_back(speed * (k_first + s * k_interval), 1, 0);
    path.velocities.emplace_back(speed, 0, 0);
  }
  return std::make_shared<BodyPaths>(std::vector<BodyPath>{path}, k_first, k_interval);
}

std::shared_ptr<const VelocityGrid> small_grid() {
  VelocityVoxels voxels;
  voxels.count = {4, 4, 4};
  voxels.to_world = Eigen::Scaling(0.5) * Eigen::Affine3d::Identity();
  for (int i = 0; i < 64; ++i) voxels.velocities.emplace_back(1.0f + 0.1f * static_cast<float>(i % 4), 0.5f, -1.0f);
  return std::make_shared<VelocityGrid>(std::vector<VelocityVoxels>{voxels}, 0, 24);
}

/// One of each kind, with numbers that a shot might have.
WindFieldSpec usual(std::string_view kind) {
  WindFieldSpec spec;
  spec.name = "test";
  spec.kind = kind;
  spec.velocity = Vec3(4, 0.5, -1);
  spec.gusts = 0.3;
  spec.position = Vec3(0.2, 0.7, -0.1);
  spec.axis = Vec3(0.2, 1, 0);
  spec.flow = 2;
  spec.circulation = 3;
  spec.radius = 0.3;
  spec.intensity = 1.5;
  spec.length = 0.8;
  spec.grid = small_grid();
  spec.bodies = straight_path();
  return spec;
}

std::unique_ptr<WindField> make(const WindFieldSpec& spec) {
  auto made = make_wind_field(spec);
  EXPECT_TRUE(made) << made.error().text();
  return std::move(*made);
}

Vec3 some_place(std::uint64_t i, double reach = 3) {
  const RandomKey key{7, 0, 0, i};
  return reach * Vec3(2 * random_uniform(key, 0) - 1, 2 * random_uniform(key, 1) - 1, 2 * random_uniform(key, 2) - 1);
}

class WindContract : public testing::TestWithParam<WindFieldKind> {
 protected:
  const std::unique_ptr<WindField> field_ = make(usual(GetParam().name));
};

TEST_P(WindContract, It_is_finite_everywhere_and_never_faster_than_it_says) {
  for (const double time : {-1e6, -1.0, 0.0, 0.37, 5.0, 1e6})
    for (std::uint64_t i = 0; i < 500; ++i) {
      const Vec3 place = i == 0 ? Vec3::Zero() : i == 1 ? field_->spec().position : some_place(i, i % 3 == 0 ? 1e5 : 3);
      const Vec3 v = field_->at_time(time)->velocity(place);
      ASSERT_TRUE(v.allFinite()) << place.transpose() << " at " << time;
      ASSERT_LE(v.norm(), field_->fastest() * (1 + 1e-12)) << place.transpose() << " at " << time;
    }
}

TEST_P(WindContract, It_is_continuous_in_time) {
  for (std::uint64_t i = 0; i < 40; ++i) {
    const Vec3 place = some_place(i, 2);
    for (double time = -0.5; time < 1.5; time += 0.0103) {
      const auto change = [&](double dt) {
        return (field_->at_time(time + dt)->velocity(place) - field_->at_time(time)->velocity(place)).norm();
      };
      ASSERT_LE(change(1e-7), 1e-4 * field_->fastest()) << "a jump at " << time << " in " << place.transpose();
    }
  }
}

TEST_P(WindContract, It_is_the_same_for_any_number_of_threads_and_any_order) {
  const auto all = [&](int threads) {
    const ThreadLimit limit(threads);
    const auto air = field_->at_time(0.6);
    std::vector<Vec3> out(2000);
    parallel_for(out.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) out[i] = air->velocity(some_place(i));
    });
    return out;
  };
  EXPECT_EQ(all(1), all(2));
}

/// Central differences of the sixth order.
double divergence(const AirNow& air, const Vec3& place, double d) {
  double sum = 0;
  for (int k = 0; k < 3; ++k)
    for (int s = 1; s <= 3; ++s) {
      constexpr double k_weight[] = {0, 0.75, -0.15, 1.0 / 60};
      const Vec3 off = s * d * Vec3::Unit(k);
      sum += k_weight[s] * (air.velocity(place + off)[k] - air.velocity(place - off)[k]) / d;
    }
  return sum;
}

TEST_P(WindContract, Its_divergence_is_zero_where_that_is_promised) {
  if (!field_->is_divergence_free()) GTEST_SKIP() << "it promises nothing";
  const auto air = field_->at_time(0.4);
  for (std::uint64_t i = 0; i < 300; ++i) {
    const Vec3 place = some_place(i);
    // Not across the sphere of a doublet.
    if (GetParam().name == "doublet" && std::abs((place - field_->spec().position).norm() - 0.3) < 0.01) continue;
    EXPECT_LT(std::abs(divergence(*air, place, 2e-3)), 1e-6 * field_->fastest() / 0.3) << place.transpose();
  }
}

TEST_P(WindContract, Gain_and_switches_are_those_of_the_shot) {
  WindFieldSpec spec = usual(GetParam().name);
  spec.gain = 2;
  spec.from = 1;
  spec.until = 3;
  spec.fade = 0.5;
  const auto field = make(spec);
  EXPECT_EQ(field->strength(0.99), 0);
  EXPECT_DOUBLE_EQ(field->strength(1.25), 1);
  EXPECT_EQ(field->strength(2), 2);
  EXPECT_DOUBLE_EQ(field->strength(3.25), 1);
  EXPECT_EQ(field->strength(3.51), 0);
  spec.fade = 0;
  EXPECT_EQ(make(spec)->strength(3.01), 0);
}

TEST_P(WindContract, Numbers_that_are_none_are_refused_by_name) {
  WindFieldSpec spec = usual(GetParam().name);
  spec.gain = std::nan("");
  const auto made = make_wind_field(spec);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().kind, ErrorKind::k_usage);
  EXPECT_NE(made.error().text().find("test"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Registry, WindContract,
                         testing::ValuesIn(wind_field_kinds().begin(), wind_field_kinds().end()),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST(Wind, What_has_no_direction_or_size_is_refused) {
  for (const auto& [kind, spoil, word] :
       {std::tuple<const char*, void (*)(WindFieldSpec&), const char*>{
            "uniform", [](WindFieldSpec& s) { s.velocity = Vec3::Zero(); }, "direction"},
        {"vortex", [](WindFieldSpec& s) { s.axis = Vec3::Zero(); }, "direction"},
        {"vortex", [](WindFieldSpec& s) { s.radius = 0; }, "radius"},
        {"turbulence", [](WindFieldSpec& s) { s.length = 0; }, "length"},
        {"grid", [](WindFieldSpec& s) { s.grid = nullptr; }, "file"},
        {"wake", [](WindFieldSpec& s) { s.bodies = nullptr; }, "body"},
        {"breeze", [](WindFieldSpec&) {}, "no wind is called"}}) {
    WindFieldSpec spec = usual(kind);
    spoil(spec);
    const auto made = make_wind_field(spec);
    ASSERT_FALSE(made) << kind;
    EXPECT_NE(made.error().text().find(word), std::string::npos) << made.error().text();
  }
}

TEST(Wind, Through_a_sphere_about_a_source_goes_its_flow) {
  const auto field = make(usual("source"));
  const auto air = field->at_time(0);
  for (const double radius : {0.3, 0.5, 2.0}) {
    double flow = 0;
    constexpr int k_rings = 200;
    for (int i = 0; i < k_rings; ++i) {
      const double up = 2 * (i + 0.5) / k_rings - 1;
      const Vec3 normal(std::sqrt(1 - up * up), up, 0);
      flow += 4 * pi * radius * radius / k_rings * air->velocity(field->spec().position + radius * normal).dot(normal);
    }
    EXPECT_NEAR(flow, 2, 1e-9) << radius;
  }
}

TEST(Wind, A_vortex_has_its_circulation_and_turns_right_handed) {
  WindFieldSpec spec = usual("vortex");
  spec.axis = Vec3::UnitY();
  const auto field = make(spec);
  const Vec3 v = field->at_time(0)->velocity(spec.position + Vec3(0, 3, 2));
  EXPECT_NEAR(v.x() * 2 * pi * 2, 3 * (1 - std::exp(-4 / 0.09)), 1e-12) << "z turns towards x about y";
  EXPECT_NEAR(v.y(), 0, 1e-15);
}

TEST(Wind, The_air_ahead_of_a_moving_sphere_makes_room) {
  WindFieldSpec spec = usual("doublet");
  spec.velocity = Vec3(2, 0, 0);
  const auto field = make(spec);
  const auto air = field->at_time(0);
  EXPECT_LT((air->velocity(spec.position + Vec3(0.3001, 0, 0)) - Vec3(2, 0, 0)).norm(), 3e-3) << "ahead with it";
  EXPECT_LT((air->velocity(spec.position + Vec3(0, 0.3001, 0)) - Vec3(-1, 0, 0)).norm(), 3e-3) << "beside against it";
}

TEST(Wind, Turbulence_has_the_intensity_that_it_is_given) {
  const auto field = make(usual("turbulence"));
  const auto air = field->at_time(0);
  Vec3 squares = Vec3::Zero();
  constexpr int k_places = 20000;
  for (int i = 0; i < k_places; ++i) squares += air->velocity(some_place(at(i), 200)).cwiseAbs2() / k_places;
  EXPECT_NEAR(std::sqrt(squares.sum() / 3), 1.5, 0.03);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(std::sqrt(squares[k]), 1.5, 0.4) << k;
}

TEST(Wind, Gusts_have_the_strength_that_they_are_given) {
  WindFieldSpec spec = usual("uniform");
  spec.gusts = 0.2;
  const auto field = make(spec);
  double sum = 0, squares = 0;
  constexpr int k_times = 20000;
  for (int i = 0; i < k_times; ++i) {
    const double speed = field->at_time(0.37 * i)->velocity(Vec3::Zero()).norm() / spec.velocity.norm();
    sum += speed / k_times;
    squares += (speed - 1) * (speed - 1) / k_times;
  }
  EXPECT_NEAR(sum, 1, 0.01);
  EXPECT_NEAR(std::sqrt(squares), 0.2, 0.02);
}

TEST(Wind, Over_level_ground_it_grows_with_the_logarithm_of_height) {
  const LogProfile profile{.roughness_length = 0.03, .reference_height = 10, .ground = -2};
  EXPECT_EQ(profile.share(-2), 0);
  EXPECT_EQ(profile.share(-3), 0) << "under the ground it is still";
  EXPECT_DOUBLE_EQ(profile.share(8), 1) << "ten metres above it";
  // From a height to its double, in the middle of the layer: always the same, by the roughness a little more low down.
  for (const double height : {0.5, 2.0, 20.0})
    EXPECT_NEAR(profile.share(2 * height - 2) - profile.share(height - 2), std::log(2) / std::log(10 / 0.03),
                std::log(2) * 0.03 / height);
  for (double y = -2; y < 150; y += 0.37) EXPECT_LE(profile.share(y), profile.share(y + 0.37));
  EXPECT_EQ(profile.share(profile.top() - 2), profile.share(1e6)) << "above the surface layer it is even";

  WindFieldSpec spec = usual("uniform");
  spec.velocity = Vec3(4, 0, -1);
  const auto even = make(spec);
  const ProfiledWind wind(make(spec), profile);
  EXPECT_TRUE(wind.is_divergence_free());
  EXPECT_EQ(wind.spec().gain, even->spec().gain);
  const auto air = wind.at_time(0.7), without = even->at_time(0.7);
  for (std::uint64_t i = 0; i < 300; ++i) {
    const Vec3 place = some_place(i, i % 2 == 0 ? 3 : 1e4);
    EXPECT_EQ(air->velocity(place), profile.share(place.y()) * without->velocity(place));
    EXPECT_LE(air->velocity(place).norm(), wind.fastest());
  }
  spec.velocity.y() = 0.5;
  EXPECT_FALSE(ProfiledWind(make(spec), profile).is_divergence_free()) << "what goes up becomes faster as it goes";
}

/// rho U times the flow is the momentum that a plane behind the body sees; C_d A U^2 / 2 times rho is its drag.
TEST(Wind, Through_every_plane_behind_a_body_goes_the_momentum_of_its_drag) {
  WindFieldSpec spec = usual("wake");
  for (const double turbulence : {0.0, 0.4}) {
    spec.turbulence = turbulence;
    const auto field = make(spec);
    const auto air = field->at_time(0);
    for (const double behind : {0.5, 1.0, 2.0, 4.0, 8.0}) {
      double flow = 0;
      constexpr double k_cell = 0.04, k_half = 4;
      for (double y = -k_half; y < k_half; y += k_cell)
        for (double z = -k_half; z < k_half; z += k_cell)
          flow += k_cell * k_cell * air->velocity(Vec3(-behind, 1 + y, z)).x();
      EXPECT_NEAR(k_speed * flow / (0.5 * k_speed * k_speed * k_drag_area), 1, 0.1) << behind << " m behind";
    }
  }
}

TEST(Wind, A_wake_is_never_faster_than_its_body_spreads_and_turns_two_ways) {
  WindFieldSpec spec = usual("wake");
  spec.turbulence = 0;
  const auto field = make(spec);
  const auto air = field->at_time(0);
  double last = k_speed;
  for (const double behind : {0.8, 1.5, 3.0, 6.0}) {
    const double middle = air->velocity(Vec3(-behind, 1, 0)).x();
    EXPECT_LT(middle, 0.9 * last) << behind;
    EXPECT_GT(middle, 0);
    last = middle;
  }
  const double width = Wake::width(k_drag_area, 3);
  EXPECT_LT(air->velocity(Vec3(-3, 1, 0)).y(), 0) << "down in the middle";
  for (const double side : {-1.7, 1.7}) EXPECT_GT(air->velocity(Vec3(-3, 1, side * width)).y(), 0) << "up at the sides";
  EXPECT_LT(air->velocity(Vec3(-3, 3.5, 0)).norm(), 0.01) << "far above there is nothing";
  EXPECT_GT(air->velocity(Vec3(0.6, 1, 0)).x(), 0.1) << "ahead it is pushed";
}

std::shared_ptr<const Trajectory> standing_box(const Vec3& size) {
  Surface surface;
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(0.5 * size.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  surface.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                       {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return std::make_shared<ScriptedBody>(surface, corners, 0, [](double, std::span<Vec3>) {});
}

TEST(Wind, A_wall_shelters_what_is_behind_it_and_that_recovers) {
  auto wind = std::make_shared<Wind>();
  WindFieldSpec spec;
  spec.kind = "uniform";
  spec.velocity = Vec3(8, 0, 0);
  wind->add(make(spec));
  wind->add(std::make_shared<SurfaceShelter>(standing_box(Vec3(0.2, 2, 2))));
  const auto air = wind->at_time(0);
  EXPECT_NEAR(air->velocity(Vec3(-1, 0, 0)).x(), 8, 1e-12) << "in front";
  EXPECT_LT(air->velocity(Vec3(0.3, 0, 0)).x(), 0.5) << "behind";
  EXPECT_NEAR(air->velocity(Vec3(0.3, 0, 2)).x(), 8, 1e-12) << "beside";
  double last = 0;
  for (const double behind : {0.3, 2.0, 5.0, 12.0}) {
    const double speed = air->velocity(Vec3(behind, 0, 0)).x();
    EXPECT_GT(speed, last);
    last = speed;
  }
}

}  // namespace
}  // namespace ft
