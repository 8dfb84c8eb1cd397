// Cables with limited tensions: comparison with linear programs (tests/data/cables), published values, statistics,
// derivatives, certified bounds and messages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "engine/mechanism/redundant_drives.hpp"
#include "engine/mechanism/trajectory.hpp"
#include "engine/motion/motion.hpp"
#include "tests/unit/generic/files.hpp"
#include "tests/unit/generic/performance_fixtures.hpp"

namespace pkm::test {
namespace {

using ::testing::HasSubstr;

std::vector<double> nominal_design(const MechanismInfo& info) { return design_with(info, nlohmann::json::object()); }

std::string text_in(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}
std::string cable_text(const std::string& name) { return text_in(kMechanismFolder + "cables/" + name + ".toml"); }
nlohmann::json references() { return nlohmann::json::parse(text_in(PKM_TEST_DATA "/cables/references.json")); }

/// The poses of tests/data/cables/references.py.
std::vector<std::vector<double>> sequence(std::size_t count, const nlohmann::json& ranges) {
  double g = 1.1;
  for (int i = 0; i < 100; ++i) g = std::pow(1 + g, 1.0 / 7);
  std::vector<std::vector<double>> poses;
  for (std::size_t k = 1; k <= count; ++k) {
    std::vector<double> pose;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      const double lower = ranges[i][0], upper = ranges[i][1];
      const double u = 0.5 + static_cast<double>(k) * std::pow(g, -static_cast<double>(i + 1));
      pose.push_back(lower + (upper - lower) * (u - std::floor(u)));
    }
    poses.push_back(pose);
  }
  return poses;
}

/// Margins of many poses.
std::vector<double> margins_at(const Mechanism& mechanism, const std::vector<std::vector<double>>& poses) {
  std::vector<Pose<double>> list;
  for (const auto& pose : poses) list.push_back(pose_at(pose));
  Scratch scratch;
  std::vector<double> margins;
  mechanism.pose_margins()->append(std::span<const double>(nominal_design(mechanism.info())), "",
                                   no_limits(mechanism.info()), list, scratch, margins);
  return margins;
}

TEST(Cables, WrenchFeasibleAgreesWithLinearProgramsOfTenThousandPoses) {
  const nlohmann::json expected = references()["cogiro"];
  const auto cogiro = read(cable_text("cogiro"));
  const auto poses = sequence(10000, expected["ranges"]);
  const std::vector<double> margins = margins_at(*cogiro, poses);
  ASSERT_EQ(margins.size(), poses.size()) << "cables always reach the pose, so there is a single margin";
  const std::string feasible = expected["feasible"];
  ASSERT_GT(double(expected["nearest_to_0"]), 1e-3) << "no pose is near the boundary";
  std::size_t different = 0;
  for (std::size_t k = 0; k < margins.size(); ++k) different += (margins[k] >= 0) != (feasible[k] == '1');
  EXPECT_EQ(different, 0u);
  for (std::size_t k = 0; k < margins.size(); k += 20)
    EXPECT_NEAR(margins[k], double(expected["reserves"][k / 20]), 1e-6 * (1 + std::fabs(margins[k]))) << k;
}

TEST(Cables, BoxOfWrenchesAgreesWithLinearProgramsAtItsVertices) {
  const nlohmann::json expected = references()["cogiro"];
  const auto cogiro = read(replaced(cable_text("cogiro"), "payload = [0, \"m_payload\"]",
                                    "payload = [0, \"300 kg\"]\nforce = [50, 50, \"100 N\"]\nmoment = [0, 0, 20]"));
  const std::vector<double> margins = margins_at(*cogiro, sequence(300, expected["ranges"]));
  for (std::size_t k = 0; k < margins.size(); ++k)
    EXPECT_NEAR(margins[k], double(expected["box_reserves"][k]), 1e-6 * (1 + std::fabs(margins[k]))) << k;
}

/// IEEE Transactions on Robotics 31(2), 501-510, and counts of an independent program (numpy).
TEST(Cables, PublishedPosesAndSlices) {
  const nlohmann::json expected = references()["cogiro"]["central"];
  const auto cogiro = read(cable_text("cogiro"));
  const std::vector<double> design = nominal_design(cogiro->info());
  const auto at = [&](const Mechanism& mechanism, const std::vector<double>& pose) {
    return mechanism.inspect(design, pose_at(pose), mechanism.info().modes.front(), no_limits(mechanism.info()));
  };
  const PoseReport central = at(*cogiro, {0, 0, 2, 0, 0, 0});
  EXPECT_TRUE(central.feasible);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR((*central.joints)[i], double(expected["lengths"][i]), 1e-12);
  EXPECT_NEAR(value_in(central, cogiro->info(), "tension_reserve"), double(expected["reserve"]), 1e-6);
  EXPECT_FALSE(at(*cogiro, {6, 4, 1, 0, 0, 0}).feasible);
  EXPECT_THAT(at(*cogiro, {6.5, 4.5, 1, 0, 0, 0}).reason, HasSubstr("wrench-feasible"));
  const auto count = [&](const std::string& text) {
    const auto robot = read(text);
    std::vector<std::vector<double>> poses;
    for (int i = 0; i < 41; ++i)
      for (int j = 0; j < 41; ++j) poses.push_back({-7 + 14 * (i + 0.5) / 41, -5 + 10 * (j + 0.5) / 41, 1, 0, 0, 0});
    return std::ranges::count_if(margins_at(*robot, poses), [](double margin) { return margin >= 0; });
  };
  const std::string text = cable_text("cogiro"), payload = "payload = [0, \"m_payload\"]";
  EXPECT_NEAR(static_cast<double>(count(text)), 934, 1);
  EXPECT_NEAR(static_cast<double>(count(replaced(text, payload, "payload = [300, 300]"))), 1561, 1);
  EXPECT_NEAR(
      static_cast<double>(count(replaced(text, payload, "payload = [300, 300]\npayload_at = [-0.034, -0.013, 0.264]"))),
      1538, 1);
}

TEST(Cables, ForcesOfAPose) {
  const nlohmann::json all = references();
  const auto tensions = [](const std::string& text, const std::vector<double>& pose, const std::string& distribution) {
    const auto robot = read(text + "\n[forces]\ndistribution = \"" + distribution + "\"\n");
    const std::vector<double> design = nominal_design(robot->info());
    const MotionState<double> state{pose_at(pose), AxisVector<double>(6)};
    PoseDynamics<double> d;
    robot->dynamics()->equations(std::span<const double>(design), robot->info().modes.front(), {&state, 1}, {&d, 1});
    const auto found = distributed_forces(d, AxisVector<double>(6), {}, drive_limits(*robot, design));
    EXPECT_TRUE(found.tau) << found.reason;
    std::vector<double> t(8, 0.0);
    for (std::size_t i = 0; found.tau && i < 8; ++i) t[i] = -(*found.tau)[i];
    return t;
  };
  const auto compare = [](const std::vector<double>& found, const nlohmann::json& expected, double tolerance) {
    for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(found[i], double(expected[i]), tolerance) << i;
  };
  const std::string cogiro = replaced(cable_text("cogiro"), "[forces]\npayload = [0, \"m_payload\"]\n", ""),
                    ipanema = cable_text("ipanema");
  const nlohmann::json& central = all["cogiro"]["central"];
  compare(tensions(cogiro, {0, 0, 2, 0, 0, 0}, "least-norm"), central["least_norm"], 1e-9);
  compare(tensions(cogiro, {0, 0, 2, 0, 0, 0}, "centre"), central["tensions"]["centre"], 1e-6);
  EXPECT_NEAR(std::ranges::max(tensions(cogiro, {0, 0, 2, 0, 0, 0}, "least-maximum")),
              double(central["tensions"]["largest"]), 1e-6);
  // two cables at their minimum tension, 0
  const std::vector<double> pose = {.5, .3, 1.2, .05, -.1, .02};
  compare(tensions(ipanema, pose, "least-norm"), all["ipanema"]["tensions"]["least-norm"], 1e-3);
  compare(tensions(ipanema, pose, "centre"), all["ipanema"]["tensions"]["centre"], 1e-6);
  EXPECT_NEAR(std::ranges::max(tensions(ipanema, pose, "least-maximum")), double(all["ipanema"]["tensions"]["largest"]),
              1e-6);
  // without limits the lower cables would push by 80.1601 N; the difference is the same
  const std::vector<double> level = tensions(ipanema, {0, 0, 1, 0, 0, 0}, "least-norm");
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(level[i] - level[i + 4], 160.32017, 1e-5);
    EXPECT_NEAR(level[i + 4], 0, 1e-9);
  }
}

constexpr const char* kPointMass = R"([mechanism]
name = "three-cables"
[parameters]
R = { default = 1, unit = "m", min = 0.1, max = 10, meaning = "radius of the anchors" }
t_max = { default = "100 N", min = 0, max = "1 kN", meaning = "maximum tension" }
[platform]
coordinates = { x = "along x", y = "along y", z = "along z" }
mass = "10 kg"
[survey]
box = { x = ["-R", "R"], y = ["-R", "R"], z = [-2, 0] }
[[limb]]
name = "cable"
drive = "telescope"
copies = { number = 3, about = "z" }
base = ["R", 0, 0]
platform = [0, 0, 0]
tension = [0, "t_max"]
)";

TEST(Cables, PointMassOnThreeCables) {
  const auto robot = read(kPointMass);
  const std::vector<double> design = nominal_design(robot->info());
  EXPECT_NEAR(value_at(*robot, design, {0, 0, -1}, "tension_reserve"), 46.244783, 1e-6);
  EXPECT_EQ(value_at(*robot, design, {0, 0, -1}, "tension_factor") < 0, true) << "three cables never pull downwards";
  // outside of the prism below the anchors, a cable would have to push
  EXPECT_LT(value_at(*robot, design, {-0.6, 0, -1}, "tension_reserve"), 0);
  EXPECT_GT(value_at(*robot, design, {-0.49, 0, -1}, "tension_reserve"), 0);
  EXPECT_NEAR(value_at(*robot, design, {-0.5, 0, -1}, "tension_reserve"), 0, 1e-12);
  // singular in the plane of the anchors
  EXPECT_FALSE(robot->inspect(design, pose_at({0, 0, 0}), "", no_limits(robot->info())).feasible);
}

/// The largest additional force that is balanced in every direction is reached in some direction.
TEST(Cables, CapacityIsTheDistanceToTheNearestFace) {
  const std::string text = kPointMass;
  const auto robot = read(text);
  const std::vector<double> design = nominal_design(robot->info()), pose = {0.1, -0.05, -0.8};
  const double capacity = value_at(*robot, design, pose, "wrench_capacity");
  ASSERT_GT(capacity, 0);
  // a box of forces inside of the ball is balanced, and one around a ball that is slightly larger is not
  const auto with_box = [&](double half) {
    const std::string h = std::to_string(half);
    const auto loaded = read(text + "[forces]\nforce = [" + h + ", " + h + ", " + h + "]\n");
    return value_at(*loaded, design, pose, "tension_reserve");
  };
  EXPECT_GE(with_box(capacity / std::sqrt(3.0)), 0);
  EXPECT_LT(with_box(capacity * 1.001), 0);
}

TEST(Cables, PayloadsAndAccelerationsAddTheirInertia) {
  // straight below the centre, all tensions are m (g + a) / (3 cos)
  const std::string text = kPointMass;
  const auto reserve = [&](const std::string& forces) {
    const auto robot = read(text + forces);
    return value_at(*robot, nominal_design(robot->info()), {0, 0, -1}, "tension_reserve");
  };
  const double cosine = std::sqrt(0.5);
  const auto expected = [&](double least, double largest) {
    return std::min(least / (3 * cosine), 100 - largest / (3 * cosine));
  };
  EXPECT_NEAR(reserve("[forces]\nacceleration = { z = \"2 m/s^2\" }\n"), expected(10 * 7.81, 10 * 11.81), 1e-9);
  EXPECT_NEAR(reserve("[forces]\npayload = [0, \"5 kg\"]\n"), expected(98.1, 15 * 9.81), 1e-9);
  EXPECT_NEAR(reserve("[forces]\npayload = [\"2 kg\", \"5 kg\"]\nacceleration = { z = 2 }\n"),
              expected(12 * 7.81, 15 * 11.81), 1e-9);
  EXPECT_NEAR(reserve("[forces]\nforce = [0, 0, 20]\n"), expected(78.1, 118.1), 1e-9);
}

/// The user's file of tests/data/robots compared with determinants by hand.
TEST(Cables, WrenchClosureOfFourCables) {
  const auto robot = read(text_in(PKM_TEST_DATA "/robots/four-cables-wrench-closure.toml"));
  const std::vector<double> design = nominal_design(robot->info());
  std::mt19937 random(1);
  std::size_t closed = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const auto number = [&](double size) { return std::uniform_real_distribution<double>(-size, size)(random); };
    const std::vector<double> at = {number(1), number(0.8), number(1.5)};
    const PoseReport report = robot->inspect(design, pose_at(at), "", no_limits(robot->info()));
    const Eigen::MatrixXd kernel = eigen_of(*report.J).transpose().fullPivLu().kernel();
    ASSERT_EQ(kernel.cols(), 1);
    const double factor = value_in(report, robot->info(), "tension_factor");
    const bool same_sign = kernel.minCoeff() * kernel.maxCoeff() > 0;
    EXPECT_EQ(factor >= 0, same_sign);
    EXPECT_EQ(report.feasible, same_sign);
    if (!same_sign) continue;
    ++closed;
    EXPECT_NEAR(factor, kernel.cwiseAbs().minCoeff() / kernel.cwiseAbs().maxCoeff(), 1e-9);
  }
  EXPECT_GT(closed, 100u);
}

/// A user's file; the numbers are linear programs of tests/data/cables/references.py for its dimensions.
TEST(Cables, EightCablesOfAUser) {
  const auto robot = read(text_in(PKM_TEST_DATA "/robots/eight-cables.toml"));
  const std::vector<double> design = nominal_design(robot->info());
  EXPECT_NEAR(value_at(*robot, design, {0, 0, 1, 0, 0, 0}, "tension_reserve"), 54.27669629355703, 1e-9);
  EXPECT_NEAR(value_at(*robot, design, {2.5, 1.5, 1, 0, 0, 0}, "tension_reserve"), 6.856300666847255, 1e-9);
  EXPECT_NEAR(value_at(*robot, design, {0, 0, 2.4, 0, 0, 0}, "tension_reserve"), -78.63463933988606, 1e-9);
}

TEST(Cables, MarginsHaveDerivativesByParameters) {
  const auto robot = read(cable_text("ipanema"));
  const std::vector<double> design = nominal_design(robot->info());
  const std::vector<std::vector<double>> at = {{.4, .2, 1.1, .05, -.02, .1}, {-1, .5, .4, 0, .1, 0}};
  for (const auto& pose : at)
    for (const std::size_t i : {std::size_t{0}, std::size_t{3}, design.size() - 1}) {
      std::vector<Dual4> varied(design.begin(), design.end());
      varied[i].v[0] = 1;
      Scratch scratch;
      std::vector<Dual4> margins;
      const Pose<double> place = pose_at(pose);
      robot->pose_margins()->append(std::span<const Dual4>(varied), "", no_limits(robot->info()), {&place, 1}, scratch,
                                    margins);
      const auto moved = [&](double step) {
        std::vector<double> other = design;
        other[i] += step;
        return value_at(*robot, other, pose, "tension_reserve");
      };
      const double step = 1e-6 * design[i], slope = (moved(step) - moved(-step)) / (2 * step);
      EXPECT_NEAR(margins[0].v[0], slope, 1e-5 * (1 + std::fabs(slope))) << i;
    }
}

TEST(Cables, CertifiedBoxes) {
  const auto robot = read(kPointMass);
  const std::vector<double> design = nominal_design(robot->info());
  const auto over = [&](double x) {
    WorkspacePlan plan;
    plan.limits = no_limits(robot->info());
    return robot->bounds()
        ->solid(design, plan, "", {{{x, x + 0.1}, {-0.1, 0.1}, {-1.2, -0.8}}}, {.max_boxes = 20000})
        .feasible;
  };
  EXPECT_EQ(over(0).kind, PropertyResult::Kind::holds);
  EXPECT_EQ(over(-0.55).kind, PropertyResult::Kind::fails);
}

/// Poses of a box of positions: its vertices, and some poses between them.
std::vector<std::vector<double>> poses_in(const std::vector<std::array<double, 2>>& box, std::mt19937& random) {
  std::vector<std::vector<double>> poses;
  for (unsigned k = 0; k < 24; ++k) {
    std::vector<double> pose;
    for (std::size_t i = 0; i < box.size(); ++i) {
      const double u = k < 8 ? (k >> i & 1U) : std::uniform_real_distribution<double>(0, 1)(random);
      pose.push_back(std::lerp(box[i][0], box[i][1], i < 3 ? u : 0));
    }
    poses.push_back(pose);
  }
  return poses;
}

TEST(Cables, CertifiedBoxesOfSixFreedomsAgreeWithTheirPoses) {
  const auto cogiro = read(cable_text("cogiro"));
  const std::vector<double> design = nominal_design(cogiro->info());
  WorkspacePlan plan;
  plan.limits = no_limits(cogiro->info());
  const auto certify = [&](const std::vector<std::array<double, 2>>& box, std::size_t boxes) {
    return cogiro->bounds()->solid(design, plan, "", {.ranges = box}, {.max_boxes = boxes});
  };
  const std::array<double, 2> level = {0, 0};
  const auto cube = [&](double x, double y, double z) {
    return certify({{x - 0.1, x + 0.1}, {y - 0.1, y + 0.1}, {z - 0.1, z + 0.1}, level, level, level}, 300);
  };
  EXPECT_EQ(cube(0, 0, 2).feasible.kind, PropertyResult::Kind::holds);
  EXPECT_EQ(cube(2, -1.5, 1).feasible.kind, PropertyResult::Kind::holds);
  EXPECT_EQ(cube(6.5, 4.5, 1).feasible.kind, PropertyResult::Kind::fails);
  // results of single boxes
  std::mt19937 random(3);
  const auto number = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
  std::vector<std::vector<double>> poses;  // of the boxes that are proven to be feasible
  for (int trial = 0; trial < 25; ++trial) {
    std::vector<std::array<double, 2>> box;
    for (const auto& [from, to] : {std::array{-5.0, 5.0}, {-4.0, 4.0}, {0.0, 4.0}}) {
      const double centre = number(from, to), half = number(0, 0.15);
      box.push_back({centre - half, centre + half});
    }
    for (int axis = 0; axis < 3; ++axis) {
      const double angle = number(-0.2, 0.2);
      box.push_back({angle, angle});
    }
    if (certify(box, 1).feasible.kind != PropertyResult::Kind::holds) continue;
    const auto samples = poses_in(box, random);
    poses.insert(poses.end(), samples.begin(), samples.end());
  }
  EXPECT_GT(poses.size(), 6 * 24u);
  for (const double margin : margins_at(*cogiro, poses)) EXPECT_GE(margin, 0);
}

/// IPAnema 1 with a pulley at each anchor.
std::string pulleys_text() {
  const std::string text = replaced(cable_text("ipanema"), "radius  = \"2 mm\"", "pulley_radius = \"50 mm\"");
  const std::size_t limb = text.find("[[limb]]");
  const std::string upper = text.substr(limb, text.find("  { base = [\"-W\", \"D\", 0]") - limb) + "]\n";
  const std::string below = "name = \"lower\"\npulley_axis = [0, 0, -1]";
  return text.substr(0, limb) + upper + replaced(replaced(upper, "\"H\"", "0"), "name    = \"cable\"", below);
}

TEST(Cables, PulleysAgreeWithTangentsFoundNumerically) {
  const nlohmann::json expected = references()["pulleys"];
  std::string text = pulleys_text();
  for (std::size_t i = 0; i < 8; ++i) {
    const std::string cable = (i < 4 ? "cable" : "lower") + std::to_string(i % 4 + 1);
    text += "[[quantity]]\nname = \"free_" + std::to_string(i) +
            "\"\nunit = \"m\"\nmeaning = \"free length\"\nformula = \"norm(" + cable + ".B - " + cable + ".C)\"\n";
  }
  const auto robot = read(text);
  const std::vector<double> design = nominal_design(robot->info());
  const auto at = [&](const std::vector<double>& pose) {
    return robot->inspect(design, pose_at(pose), "", no_limits(robot->info()));
  };
  for (std::size_t k = 0; k < expected["poses"].size(); ++k) {
    const std::vector<double> pose = expected["poses"][k];
    const PoseReport report = at(pose);
    for (std::size_t i = 0; i < 8; ++i) {
      EXPECT_NEAR((*report.joints)[i], double(expected["lengths"][k][i]), 1e-12) << k << i;
      EXPECT_NEAR(value_in(report, robot->info(), "free_" + std::to_string(i)), double(expected["free"][k][i]), 1e-12);
    }
    for (std::size_t j = 0; j < 6; ++j) {
      std::vector<double> before = pose, after = pose;
      before[j] -= 1e-5;
      after[j] += 1e-5;
      const PoseReport from = at(before), to = at(after);
      for (std::size_t i = 0; i < 8; ++i) {
        EXPECT_NEAR((*report.J)(i, j), double(expected["jacobian"][k][i][j]), 1e-9);
        EXPECT_NEAR((*report.J)(i, j), ((*to.joints)[i] - (*from.joints)[i]) / 2e-5, 1e-9);
      }
    }
    EXPECT_NEAR(value_in(report, robot->info(), "tension_reserve"), double(expected["reserve"][k]), 1e-6);
  }
}

TEST(Cables, SmallPulleysApproachPoints) {
  const auto points = read(cable_text("ipanema")),
             pulleys = read(replaced(pulleys_text(), "pulley_radius = \"50 mm\"", "pulley_radius = 1e-9"));
  const std::vector<double> design = nominal_design(points->info()), pose = {.5, .3, 1.2, .05, -.1, .02};
  EXPECT_NEAR(value_at(*pulleys, design, pose, "tension_reserve"), value_at(*points, design, pose, "tension_reserve"),
              1e-5);
}

TEST(Cables, PosesInsideOfAPulleyAreInfeasible) {
  const auto robot = read(replaced(kPointMass, "tension =", "pulley_radius = \"100 mm\"\ntension ="));
  const std::vector<double> design = nominal_design(robot->info());
  const PoseReport report = robot->inspect(design, pose_at({0.9, 0, 0.01}), "", no_limits(robot->info()));
  EXPECT_FALSE(report.feasible);
  EXPECT_THAT(report.reason, HasSubstr("cable1"));
  EXPECT_EQ(robot->reactions(), nullptr);
  EXPECT_THAT(robot->why_no_reactions(), HasSubstr("pulley"));
}

TEST(Cables, Messages) {
  const std::string text = kPointMass;
  const auto message = [](const std::string& wrong) -> std::string {
    try {
      read(wrong);
    } catch (const std::exception& reason) {
      return reason.what();
    }
    return "no message";
  };
  EXPECT_THAT(message(replaced(text, "number = 3", "number = 2")), HasSubstr("2 joints for 3 coordinates"));
  EXPECT_THAT(message(replaced(text, "[0, \"t_max\"]", "[\"200 N\", \"t_max\"]")), HasSubstr("tension"));
  EXPECT_THAT(message(text + "[forces]\ndistribution = \"centre\"\n"), HasSubstr("not redundant"));
  const auto with = [&](const std::string& keys) { return message(replaced(text, "tension =", keys + "\ntension =")); };
  EXPECT_THAT(with("pulley_axis = [0, 0, 1]"), HasSubstr("pulley_radius"));
  EXPECT_THAT(with("pulley_radius = -1"), HasSubstr("pulley_radius"));
  EXPECT_THAT(with("pulley_radius = \"50 mm\"\nleg_section = { outer = \"4 mm\", young = 1e11 }"),
              HasSubstr("leg_section"));
  EXPECT_THAT(message(replaced(text, "tension = [0, \"t_max\"]", "pulley_radius = \"50 mm\"")),
              HasSubstr("requires a cable"));
  EXPECT_THAT(message(text + "[forces]\npayload_at = [0, 0, 0]\n"), HasSubstr("`payload_at` requires `payload`"));
  EXPECT_THAT(message(text + "[forces]\nforce = [1, 2]\n"), HasSubstr("force"));
  EXPECT_THAT(message(text + "[forces]\nacceleration = { w = 1 }\n"), HasSubstr("one of x, y, z"));
  EXPECT_THAT(message(replaced(text, "tension = [0, \"t_max\"]\n", "") + "[forces]\npayload = [0, 1]\n"),
              HasSubstr("`payload` requires cables"));
}

}  // namespace
}  // namespace pkm::test
