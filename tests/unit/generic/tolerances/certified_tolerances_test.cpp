// Certified tolerances of mechanism files whose largest tolerances are known in closed form.
#include "engine/generic/tolerances/certified_tolerances.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/math/random.hpp"
#include "engine/motion/motion_factories.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm::generic {
namespace {

/// Two crossed slides that move a point within a disc of radius r around (c, 0).
constexpr const char* kSlides = R"(
[mechanism]
name = "slides"
[parameters]
r = { default = "1 m", min = "0.1 m", max = "10 m" }
c = { default = "0.1 m", min = "-1 m", max = "1 m" }
idle = { default = "1 m", min = 0, max = "10 m" }
stop = { default = "0.9 m", min = 0, max = "10 m" }
[platform]
coordinates = { x = "along x", y = "along y" }
[survey]
sweep = ["x", "y"]
box = { x = ["-r", "r"], y = ["-r", "r"] }
[[limb]]
name = "X"
drive = "formula"
joint = "x"
[[limb]]
name = "Y"
drive = "formula"
joint = "y"
[[limit]]
name = "stop"
meaning = "largest y"
[[margin]]
name = "disc"
formula = "r^2 - (x - c)^2 - y^2"
[[margin]]
name = "stop"
formula = "stop - y"
)";

struct Tolerances {
  explicit Tolerances(const std::string& text) : mechanism(read_mechanism_toml(text, "test.toml")) {
    for (const Parameter& parameter : mechanism->info().parameters) parameters.push_back(parameter.nominal);
  }
  CertifiedTolerances of(const PoseSet& poses, const ToleranceProportions& proportions,
                         const BoundsOptions& options = {.gap = 1e-3}) const {
    return certified_tolerances(*mechanism, parameters, no_limits(mechanism->info()), "", poses, proportions, options);
  }
  std::shared_ptr<const Mechanism> mechanism;
  std::vector<double> parameters;
};

void expect_scale(const CertifiedTolerances& found, double scale) {
  EXPECT_LE(found.scale, scale);
  EXPECT_GE(found.scale, scale * (1 - 1.1e-3));
  ASSERT_TRUE(found.violation);
  EXPECT_NEAR(found.violation->scale, scale, 1e-6 * scale);
}

TEST(CertifiedTolerances, OfABoxOfPoses) {
  const Tolerances slides(kSlides);
  // the farthest pose is (-0.5, 0.6), at a distance of 0.6 * sqrt(2) from the centre
  const PoseSet box{.ranges = {{-0.5, 0.5}, {0, 0.6}}};
  const CertifiedTolerances radius = slides.of(box, {{0}, {1}});
  expect_scale(radius, 1 - 0.6 * std::sqrt(2));
  EXPECT_EQ(radius.violation->constraint, "disc");
  EXPECT_NEAR(radius.violation->parameters[0], 0.6 * std::sqrt(2), 1e-6);
  EXPECT_NEAR(radius.violation->pose[0], -0.5, 1e-9);
  EXPECT_FALSE(radius.violation->time);
  // r = 1 - 2 t, c = 0.1 + t: (1 - 2 t)^2 = (0.6 + t)^2 + 0.36, t = (5.2 - sqrt(5.2^2 - 4 * 3 * 0.28)) / 6
  expect_scale(slides.of(box, {{0, 1}, {2, 1}}), (5.2 - std::sqrt(5.2 * 5.2 - 3.36)) / 6);
}

TEST(CertifiedTolerances, OfAThresholdThatIsAParameter) {
  const Tolerances slides(kSlides);
  EXPECT_THAT(affects_poses(*slides.mechanism, no_limits(slides.mechanism->info())),
              ::testing::ElementsAre(true, true, false, true));
  expect_scale(slides.of({.ranges = {{0, 0.1}, {0, 0.8}}}, {{3}, {0.5}}), 0.2);
  LimitSpec given = no_limits(slides.mechanism->info());
  given.given[0] = 0.85;
  EXPECT_FALSE(affects_poses(*slides.mechanism, given)[3]);
}

TEST(CertifiedTolerances, OfAMotion) {
  const Tolerances slides(kSlides);
  const auto along = [](const std::string& x, double duration) {
    return motion_from_formulas({Formula(x, time_name()), Formula("0", time_name())}, duration);
  };
  const auto straight = along("0.1 + t", 0.75);
  const CertifiedTolerances at_end = slides.of({.ranges = {}, .motion = straight.get()}, {{0}, {1}});
  expect_scale(at_end, 0.25);
  ASSERT_TRUE(at_end.violation->time);
  EXPECT_NEAR(*at_end.violation->time, 0.75, 1e-6);
  EXPECT_NEAR(at_end.violation->pose[0], 0.85, 1e-6);
  const auto turning = along("0.1 + t*(1.5 - t)", 1.5);  // x - c <= 0.5625
  expect_scale(slides.of({.ranges = {}, .motion = turning.get()}, {{0}, {1}}), 0.4375);
}

TEST(CertifiedTolerances, EndWhereAParameterIsZero) {
  const Tolerances slides(kSlides);
  const CertifiedTolerances found = slides.of({.ranges = {{0, 0.1}, {0, 0.1}}}, {{1}, {1}});
  EXPECT_FALSE(found.violation);  // the centre of the disc stays between 0 and 0.2
  EXPECT_EQ(found.scale, 0.1);
  EXPECT_EQ(found.largest_scale, 0.1);
}

TEST(CertifiedTolerances, OfFreeProportions) {
  const Tolerances slides(kSlides);
  // Costs 1/t_r + 4/t_stop, constraints t_r <= 1 - 0.6 sqrt(2) and t_stop <= 0.1 (a tenth of the parameter: 0.09)
  const PoseSet box{.ranges = {{-0.5, 0.5}, {0, 0.6}}};
  const ToleranceProportions free =
      cheapest_proportions(*slides.mechanism, slides.parameters, no_limits(slides.mechanism->info()), "", box,
                           {{0, 3}, {1, 4}}, [] { return false; });
  EXPECT_NEAR(free.sizes[0], 0.1, 1e-6);
  EXPECT_NEAR(free.sizes[1], 0.09, 1e-6);
}

TEST(CertifiedTolerances, OfMechanismFilesHoldForRandomRobots) {
  int certified = 0, violated = 0;
  for (const std::string& name : test::mechanism_files()) {
    SCOPED_TRACE(name);
    const Mechanism& mechanism = *test::described(name);
    const MechanismInfo& info = mechanism.info();
    const LimitSpec limits = no_limits(info);
    const std::vector<double> design = test::design_with(info, nlohmann::json::object());
    const auto reached = *mechanism.ranges(design);
    const auto inspect = [&](std::span<const double> robot, const Pose<double>& pose) {
      return mechanism.inspect(robot, pose, info.modes.front(), limits);
    };
    Stream random(7, 0, 0, Stream::Use::start);
    Pose<double> centre(info.coordinates.size());
    do
      for (std::size_t i = 0; i < centre.size(); ++i)
        centre[i] = reached[i][0] + random.u01() * (reached[i][1] - reached[i][0]);
    while (!inspect(design, centre).feasible);
    PoseSet box;
    for (std::size_t i = 0; i < centre.size(); ++i) {
      const double half = 1e-3 * (reached[i][1] - reached[i][0]);
      box.ranges.push_back({centre[i] - half, centre[i] + half});
    }
    ToleranceProportions proportions;
    const std::vector<bool> affects = affects_poses(mechanism, limits);
    for (std::size_t i = 0; i < affects.size(); ++i)
      if (affects[i] && info.parameters[i].unit == "m") {
        proportions.parameters.push_back(i);
        proportions.sizes.push_back(1);
      }
    const CertifiedTolerances found =
        certified_tolerances(mechanism, design, limits, "", box, proportions, {.gap = 0.1, .max_boxes = 5000});
    certified += found.scale > 0;
    for (int robot = 0; robot < 300; ++robot) {
      std::vector<double> parameters = design;
      for (const std::size_t i : proportions.parameters) {
        const double share = 2 * random.u01() - 1;
        parameters[i] += found.scale * (robot % 2 == 0 ? share : std::copysign(1, share));
      }
      Pose<double> pose = centre;
      for (std::size_t i = 0; i < pose.size(); ++i)
        pose[i] = box.ranges[i][0] + random.u01() * (box.ranges[i][1] - box.ranges[i][0]);
      ASSERT_TRUE(inspect(parameters, pose).feasible) << robot;
    }
    if (!found.violation || found.violation->constraint.find("singularity") != std::string::npos) continue;
    ++violated;
    EXPECT_FALSE(inspect(found.violation->parameters, found.violation->pose).feasible) << found.violation->constraint;
  }
  EXPECT_GE(certified, 6);
  EXPECT_GE(violated, 4);
}

}  // namespace
}  // namespace pkm::generic
