// What intervals say of described mechanisms, beside volumes proven otherwise.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/config/built_in_mechanisms.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/team.hpp"
#include "engine/geometry/singular.hpp"
#include "engine/math/eigen_solvers.hpp"
#include "engine/math/random.hpp"
#include "engine/motion/motion_factories.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "tests/unit/contracts/catalogue_problem.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm {
namespace {

using Kind = PropertyResult::Kind;

WorkspacePlan plain_plan(const MechanismInfo& info) {
  WorkspacePlan plan;
  plan.limits = no_limits(info);
  return plan;
}
std::vector<double> defaults(const MechanismInfo& info) { return test::design_with(info, nlohmann::json::object()); }

std::shared_ptr<const Mechanism> read(const std::string& text) { return read_mechanism_toml(text, "test.toml"); }

VolumeBounds bounds_of(const Mechanism& mechanism, double gap) {
  return mechanism.bounds()->volume(defaults(mechanism.info()), plain_plan(mechanism.info()), "", {.gap = gap});
}

/// A mechanism of margins alone, over x, y and z.
std::string by_margins(const std::string& parameters, const std::string& box, const std::vector<std::string>& margins) {
  std::string text = "[mechanism]\nname = \"margins\"\n[parameters]\n" + parameters +
                     "\n[platform]\ncoordinates = { x = \"along x\", y = \"along y\", z = \"along z\" }\n[survey]\n"
                     "sweep = [\"x\", \"y\", \"z\"]\nbox = { " +
                     box + " }\n";
  for (const std::string name : {"x", "y", "z"})
    text += "[[limb]]\nname = \"q" + name + "\"\ndrive = \"formula\"\njoint = \"" + name + "\"\nunit = \"m\"\n";
  for (std::size_t i = 0; i < margins.size(); ++i)
    text +=
        "[[margin]]\nname = \"margin " + std::to_string(i) + "\"\nformula = \"" + margins[i] + "\"\nunit = \"m^2\"\n";
  return text;
}

std::string three_cylinders(double r_1, double r_2, double r_3, double dx, double dy, double dz) {
  const auto parameter = [](const std::string& name, double value) {
    return name + " = { default = " + std::to_string(value) +
           ", min = -9, max = 9, unit = \"m\", meaning = \"length\" }\n";
  };
  return by_margins(parameter("r_1", r_1) + parameter("r_2", r_2) + parameter("r_3", r_3) + parameter("dx", dx) +
                        parameter("dy", dy) + parameter("dz", dz),
                    "x = [-1.2, 1.2], y = [-1.2, 1.2], z = [-1.2, 1.2]",
                    {"r_1^2 - (x - dx)^2 - y^2", "r_2^2 - (y - dy)^2 - z^2", "r_3^2 - x^2 - (z - dz)^2"});
}

void expect_holds(const VolumeBounds& found, double truth, double gap) {
  EXPECT_LE(found.lower, truth);
  EXPECT_GE(found.upper, truth);
  EXPECT_LE(found.gap(), gap);
}

/// A limit that is given in place of a parameter may be weaker: the workspace then reaches further than the box of the
/// parameters.
TEST(RigorousBounds, LookAsFarAsGivenLimitsAllow) {
  const Mechanism& hybrid = *test::described("2t1r-p-hybrid");
  const MechanismInfo& info = hybrid.info();
  WorkspacePlan plan = test::columns(info);
  plan.limits = test::limits_with(info, {{"tau_s", 1e-3}});
  const std::vector<double> design = test::design_with(info, {{"tau_s", 0.4}, {"psiA_max", 1.5}});
  const WorkspaceResult<double> exact = test::survey(hybrid, design, plan);
  expect_holds(hybrid.bounds()->volume(design, plan, "", {.gap = 1e-2}), exact.volume, 1e-2);
  plan.method = VoxelOptions{.cells = {100, 100, 100}};
  EXPECT_NEAR(test::survey(hybrid, design, plan).volume / exact.volume, 1, 2e-2);
  EXPECT_LT(test::survey(hybrid, design, test::columns(info)).volume, 0.95 * exact.volume);
}

TEST(RigorousBounds, HoldVolumesThatTwoOtherRoutesProve) {
  const VolumeBounds equal = bounds_of(*read(three_cylinders(1, 1, 1, 0, 0, 0)), 1e-2);
  expect_holds(equal, 8 * (2 - std::sqrt(2.0)), 1e-2);
  EXPECT_LE(equal.boxes, 130'000U);
  expect_holds(bounds_of(*read(three_cylinders(1, 0.9, 0.8, 0.05, 0.1, -0.07)), 1e-2), 3.06083756014132, 1e-2);
}

/// Reference values made by two other programs, of 3-RPR over (x, y, phi) and Gough at fixed orientations.
TEST(RigorousBounds, HoldReferenceVolumesOfFiles) {
  expect_holds(bounds_of(*test::described("3-rpr"), 3e-2), 0.228794315997323, 3e-2);
  const Mechanism& gough = *test::described("gough");
  const auto at = [&](const nlohmann::json& design, double tilt, double yaw) {
    WorkspacePlan plan = plain_plan(gough.info());
    plan.fixed = {{3, FixedCoordinate::Kind::value, tilt}, {5, FixedCoordinate::Kind::value, yaw}};
    return gough.bounds()->volume(test::design_with(gough.info(), design), plan, "", {.gap = 5e-2});
  };
  expect_holds(at(nlohmann::json::object(), 0.15, 0.1), 0.272714271224695, 5e-2);
  expect_holds(at({{"r", 0.5}, {"l_min", 1.15}, {"l_max", 1.75}}, 0.07, -0.2), 0.250842061521403, 5e-2);
}

/// A length is compared with a threshold of 0, and its root has a condition by itself: one, not two with one root.
TEST(RigorousBounds, AreOfSecondOrderWhereALimitIsInactive) {
  const Mechanism& file = *test::described("4ppa-2par");
  const double volume = test::survey(file, test::nominal(file.info()), test::columns(file.info())).volume;
  const VolumeBounds found = bounds_of(file, 1e-2);
  expect_holds(found, volume, 1e-2);
  EXPECT_LE(found.boxes, 12'000U);  // 109 000 with both
}

TEST(RigorousBounds, OfABallAndOfWhatIsEmpty) {
  const std::string box = "x = [-1, 1], y = [-1, 1], z = [-1, 1]",
                    radius = "r = { default = 0.5, min = 0, max = 9, unit = \"m\", meaning = \"radius\" }";
  expect_holds(bounds_of(*read(by_margins(radius, box, {"r^2 - x^2 - y^2 - z^2"})), 1e-3), 4.0 / 3 * kPi * 0.125, 1e-3);
  // roots that are undefined over most of the box
  expect_holds(bounds_of(*read(by_margins(radius, box, {"sqrt(r^2 - x^2 - y^2) - abs(z)"})), 1e-2),
               4.0 / 3 * kPi * 0.125, 1e-2);
  const VolumeBounds none = bounds_of(*read(by_margins(radius, box, {"-r^2 - x^2 - y^2 - z^2"})), 1e-2);
  EXPECT_EQ(none.upper, 0);
  EXPECT_EQ(none.gap(), 0);
  const VolumeBounds all = bounds_of(*read(by_margins(radius, box, {"r + x^2"})), 1e-2);
  EXPECT_NEAR(all.lower, 8, 1e-12);
}

TEST(RigorousBounds, SayWhyThereAreNone) {
  const auto refusal = [](const Mechanism& mechanism, const WorkspacePlan& plan) -> std::string {
    try {
      mechanism.bounds()->volume(defaults(mechanism.info()), plan, "", {});
      return "";
    } catch (const std::invalid_argument& reason) {
      return reason.what();
    }
  };
  std::vector<std::string> margins;  // beside them, three joints have to have values
  for (int i = 0; i < 126; ++i) margins.push_back("r - x*" + std::to_string(i));
  const auto many = read(by_margins("r = { default = 0.5, min = 0, max = 9, unit = \"m\", meaning = \"radius\" }",
                                    "x = [-1, 1], y = [-1, 1], z = [-1, 1]", margins));
  EXPECT_EQ(refusal(*many, plain_plan(many->info())),
            "certified bounds support at most 128 constraints, but mechanism margins has 129");
  const Mechanism& gough = *test::described("gough");
  WorkspacePlan listed = plain_plan(gough.info());
  listed.fixed = {{.coordinate = 3, .kind = FixedCoordinate::Kind::listed, .values = {0, 0.1}}};
  EXPECT_EQ(
      refusal(gough, listed),
      "certified bounds need a single value of alpha, but the workspace analysis has several; fix it at one value");
}

TEST(RigorousBounds, AreTheSameForAnyNumberOfThreads) {
  VolumeBounds one, three;
  const Mechanism& gough = *test::described("gough");
  with_team(1, [&] { one = bounds_of(gough, 0.1); });
  with_team(3, [&] { three = bounds_of(gough, 0.1); });
  EXPECT_EQ(one.lower, three.lower);
  EXPECT_EQ(one.upper, three.upper);
  EXPECT_EQ(one.boxes, three.boxes);
}

/// Of every file: voxels, as far as a grid of 40 cells along each axis is right.
class BoundsOfFile : public ::testing::TestWithParam<std::string> {};

TEST_P(BoundsOfFile, HoldWhatVoxelsCountAlmost) {
  const Mechanism& mechanism = *test::described(GetParam());
  WorkspacePlan plan = plain_plan(mechanism.info());
  const VolumeBounds found =
      mechanism.bounds()->volume(defaults(mechanism.info()), plan, "", {.gap = 0.3, .max_boxes = 3000});
  VoxelOptions voxels;
  const std::size_t swept = sweep_of(mechanism.info(), plan).swept.size();
  std::fill_n(voxels.cells.begin(), swept, 40);
  plan.method = voxels;
  WorkspaceResult<double> counted;
  evaluate_once<double>(*prepare_workspace(mechanism, plan, {}), defaults(mechanism.info()), counted);
  EXPECT_GT(found.upper, 0);
  EXPECT_LE(found.lower, counted.volume * 1.05);
  EXPECT_GE(found.upper, counted.volume * 0.95);
}

INSTANTIATE_TEST_SUITE_P(EveryFile, BoundsOfFile, ::testing::ValuesIn(test::mechanism_files()), [](const auto& of) {
  std::string name = of.param;
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST(RigorousBounds, OfABoxOfPoses) {
  const Mechanism& orthoglide = *test::described("orthoglide");
  const MechanismInfo& info = orthoglide.info();
  const auto certified = [&](double from, double to) {
    return orthoglide.bounds()->solid(defaults(info), plain_plan(info), "",
                                      {std::vector<std::array<double, 2>>(3, {from, to})}, {.max_boxes = 20000});
  };
  const PoseCertificate inside = certified(-0.05, 0.03);
  EXPECT_EQ(inside.feasible.kind, Kind::holds);
  EXPECT_EQ(inside.regular.kind, Kind::holds);

  const PoseCertificate across = certified(-0.1, 0.12);
  ASSERT_EQ(across.feasible.kind, Kind::fails);
  const PoseReport report =
      orthoglide.inspect(defaults(info), *across.feasible.pose, info.modes.front(), no_limits(info));
  EXPECT_FALSE(report.feasible);
  EXPECT_EQ(across.regular.kind, Kind::not_examined);
}

std::shared_ptr<const Motion> straight(const AxisVector<double>& from, const AxisVector<double>& to) {
  return point_to_point(from, {{0.1, to, 0.5}}, 0.1, TimeLaw::quintic);
}

/// Every verdict beside many samples.
TEST(RigorousBounds, OfMotions) {
  int holds = 0, fails = 0;
  for (const std::string name : {"orthoglide", "five-bar", "gough", "rotary-delta"}) {
    SCOPED_TRACE(name);
    const Mechanism& mechanism = *test::described(name);
    const MechanismInfo& info = mechanism.info();
    const std::vector<double> p = defaults(info);
    const auto feasible = [&](const Motion& motion, double t) {
      return mechanism.inspect(p, motion.at(t).pose, info.modes.front(), no_limits(info)).feasible;
    };
    const auto ranges = *mechanism.ranges(p);
    const auto within = [&](double share, Stream& random) {
      AxisVector<double> pose(info.coordinates.size());
      for (std::size_t i = 0; i < pose.size(); ++i)
        pose[i] = 0.5 * (ranges[i][0] + ranges[i][1]) + share * (random.u01() - 0.5) * (ranges[i][1] - ranges[i][0]);
      return pose;
    };
    for (unsigned k = 0; k < 20; ++k) {
      Stream random(3, 0, k, Stream::Use::start);
      const double share = k % 4 < 2 ? 0.2 : 0.6;
      const auto motion = straight(within(share, random), within(share, random));
      const PoseCertificate found = mechanism.bounds()->motion(p, no_limits(info), "", *motion, {.max_boxes = 20000});
      ASSERT_NE(found.feasible.kind, Kind::undecided) << k;
      const double T = motion->duration();
      if (found.feasible.kind == Kind::holds) {
        ++holds;
        for (int i = 0; i <= 200; ++i) EXPECT_TRUE(feasible(*motion, T * i / 200)) << k;
        continue;
      }
      ++fails;
      const double t = *found.feasible.time;
      EXPECT_FALSE(feasible(*motion, t)) << k;
      EXPECT_EQ((*found.feasible.pose)[0], motion->at(t).pose[0]);
      for (int i = 0; i < 200; ++i) EXPECT_TRUE(feasible(*motion, (t - 1e-5 * T) * i / 200) || t < 1e-5 * T) << k;
    }
  }
  EXPECT_GE(holds, 5);
  EXPECT_GE(fails, 20);
}

TEST(RigorousBounds, OfMotionsThatEndWhereTheyMay) {
  const Mechanism& five_bar = *test::described("five-bar");
  const auto certified = [&](double y) {
    return five_bar.bounds()->motion(defaults(five_bar.info()), no_limits(five_bar.info()), "",
                                     *straight({0.0, 0.3}, {0.0, y}), {.max_boxes = 20000});
  };
  EXPECT_EQ(certified(1e-9).feasible.kind, Kind::holds);
  const PoseCertificate touches = certified(0);
  EXPECT_EQ(touches.feasible.kind, Kind::undecided) << "exactly 0 at the end";
  EXPECT_NEAR(*touches.feasible.time, 0.6, 1e-3);
  const PoseCertificate leaves = certified(-1e-6);
  EXPECT_EQ(leaves.feasible.kind, Kind::fails);
  EXPECT_EQ(leaves.feasible.detail, "on its side of the pivots");
}

TEST(RigorousBounds, FindASingularityBetweenTwoSignsOfTheDeterminant) {
  // two telescopes in a plane, singular where both are in line
  const auto legs = read(
      "[mechanism]\nname = \"legs\"\n[parameters]\nb = { default = 1, min = 0, max = 9, unit = \"m\", meaning = "
      "\"width\" }\n[platform]\ncoordinates = { x = \"along "
      "x\", y = \"along y\" }\n[survey]\nbox = { x = [-1, 2], y = [-1, 1] }\n[[limb]]\nname = \"left\"\ndrive = "
      "\"telescope\"\nbase = [0, 0, 0]\nplatform = [0, 0, 0]\n[[limb]]\nname = \"right\"\ndrive = "
      "\"telescope\"\nbase = [\"b\", 0, 0]\nplatform = [0, 0, 0]\n");
  const auto regular = [&](double from, double to) {
    return legs->bounds()
        ->solid(defaults(legs->info()), plain_plan(legs->info()), "", {{{0.2, 0.8}, {from, to}}}, {.max_boxes = 2000})
        .regular;
  };
  EXPECT_EQ(regular(0.1, 0.9).kind, Kind::holds);
  const PropertyResult across = regular(-0.1, 0.9);
  EXPECT_EQ(across.kind, Kind::fails);
  EXPECT_THAT(across.detail, ::testing::HasSubstr("parallel"));
  EXPECT_NEAR((*across.pose)[1], 0, 1e-12);
  const auto along = [&](double from, double to) {
    return legs->bounds()
        ->motion(defaults(legs->info()), no_limits(legs->info()), "", *straight({0.4, from}, {0.6, to}),
                 {.max_boxes = 20000})
        .regular;
  };
  EXPECT_EQ(along(0.1, 0.9).kind, Kind::holds);
  const PropertyResult through = along(0.5, -0.5);
  EXPECT_EQ(through.kind, Kind::fails);
  EXPECT_NEAR(*through.time, 0.35, 1e-9);
}

/// A file of tests/data/redundant.
std::shared_ptr<const Mechanism> redundant(const std::string& name) {
  std::ostringstream text;
  text << std::ifstream(PKM_TEST_DATA "/redundant/" + name).rdbuf();
  return read_mechanism_toml(text.str(), name);
}

using PoseRanges = std::vector<std::array<double, 2>>;

PoseCertificate over(const Mechanism& mechanism, const std::vector<double>& design, const PoseRanges& box) {
  return mechanism.bounds()->solid(design, plain_plan(mechanism.info()), "", {box}, {.max_boxes = 20000});
}

TEST(RigorousBounds, OfRedundantDrives) {
  const auto cables = redundant("four-cables.toml");
  std::vector<double> design = defaults(cables->info());
  // the plate is the frame made smaller: no cable turns it at phi = 0
  for (const double x : {-0.3, 0.2}) {
    const PoseCertificate found = over(*cables, design, PoseRanges{{x, x + 0.1}, {-0.2, 0.1}, {0, 0}});
    EXPECT_EQ(found.feasible.kind, Kind::holds);
    EXPECT_EQ(found.regular.kind, Kind::fails);
    EXPECT_EQ(found.regular.detail, "the parallel singularity (det(G^T G) = 0), to working precision");
    EXPECT_LT(found.boxes, 10u) << "any pose shows it";
  }
  EXPECT_EQ(over(*cables, design, PoseRanges{{-0.2, 0.2}, {-0.2, 0.2}, {0.1, 0.2}}).regular.kind, Kind::holds);
  design[3] = 0.2;  // h: another shape
  EXPECT_EQ(over(*cables, design, PoseRanges{{-0.2, 0.2}, {-0.2, 0.2}, {0, 0}}).regular.kind, Kind::holds);

  const auto rrr = redundant("4-rrr.toml");
  const PoseRanges box = {{0.01, 0.03}, {0.01, 0.03}, {-0.02, 0.02}};
  const PoseCertificate regular = over(*rrr, defaults(rrr->info()), box);
  EXPECT_EQ(regular.feasible.kind, Kind::holds);
  EXPECT_EQ(regular.regular.kind, Kind::holds);
}

/// Verdicts on random boxes beside singular values of samples.
TEST(RigorousBounds, OfRedundantDrivesBesideSingularValues) {
  const auto cables = redundant("four-cables.toml");
  int holds = 0, singular = 0;
  for (unsigned k = 0; k < 60; ++k) {
    Stream random(5, 0, k, Stream::Use::start);
    std::vector<double> design = defaults(cables->info());
    for (double& p : design) p *= 0.8 + 0.4 * random.u01();
    PoseRanges box(3);
    for (auto& side : box) {
      side[0] = 0.6 * (random.u01() - 0.5);
      side[1] = side[0] + 0.2 * random.u01();
    }
    if (k % 3 == 0) {  // through a pose at which G is singular, by its symmetry
      design[3] = design[2] * design[1] / design[0];
      box[2] = {-0.1, 0.1};
    }
    const PoseCertificate found = over(*cables, design, box);
    double least = 1;
    for (int i = 0; i <= 20; ++i) {
      Pose<double> pose(3);
      for (std::size_t axis = 0; axis < 3; ++axis)
        pose[axis] = box[axis][0] + (box[axis][1] - box[axis][0]) * (axis == 2 ? i / 20.0 : random.u01());
      const auto J = *cables->inspect(design, pose, "", no_limits(cables->info())).J;
      Eigen::MatrixXd of(J.rows(), J.cols());
      for (std::size_t r = 0; r < J.rows(); ++r)
        for (std::size_t c = 0; c < J.cols(); ++c)
          of(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = J(r, c);
      const auto values = Eigen::JacobiSVD<Eigen::MatrixXd>(of).singularValues();
      least = std::fmin(least, values[2] / values[0]);
    }
    if (found.regular.kind == Kind::holds) {
      ++holds;
      EXPECT_GT(least, 1e-6) << k;
    }
    if (found.regular.kind == Kind::fails) {
      ++singular;
      const auto J = *cables->inspect(design, *found.regular.pose, "", no_limits(cables->info())).J;
      EXPECT_TRUE(is_rank_deficient(J)) << k;
    }
    if (k % 3 == 0) {
      EXPECT_EQ(found.regular.kind, Kind::fails) << k;
    }
  }
  EXPECT_GE(holds, 10);
  EXPECT_GE(singular, 20);
}

TEST(RigorousBounds, DoNotTakeAPoleForASingularity) {
  // q = b/x^2: G = -2 b/x^3 has both signs, and no root between them
  const auto poles = read(
      "[mechanism]\nname = \"poles\"\n[parameters]\nb = { default = 1, min = 0, max = 9 }\n[platform]\n"
      "coordinates = { x = \"along x\" }\n[survey]\nbox = { x = [-1, 1] }\n[[limb]]\nname = \"q\"\ndrive = "
      "\"formula\"\njoint = \"b/x^2\"\nunit = \"m\"\n");
  const PoseCertificate found = over(*poles, defaults(poles->info()), PoseRanges{{-0.3, 0.4}});
  EXPECT_NE(found.regular.kind, Kind::fails);
  EXPECT_NE(found.regular.kind, Kind::holds);
}

TEST(RigorousBounds, OfMotionsOfRedundantDrives) {
  const auto cables = redundant("four-cables.toml");
  const auto along = [&](const AxisVector<double>& from, const AxisVector<double>& to) {
    return cables->bounds()->motion(defaults(cables->info()), no_limits(cables->info()), "", *straight(from, to),
                                    {.max_boxes = 20000});
  };
  EXPECT_EQ(along({0.1, 0.1, 0.1}, {-0.2, 0.1, 0.2}).regular.kind, Kind::holds);
  const PoseCertificate flat = along({0.1, 0.1, 0}, {-0.2, 0.1, 0});
  EXPECT_EQ(flat.regular.kind, Kind::fails);
  EXPECT_TRUE(flat.regular.time);
}

}  // namespace
}  // namespace pkm
