// Limbs as chains of joints: an Agile Eye against values of a program that shares no code, chains against limbs with
// the equivalent drive, all joints that may be driven, passive joints, refusals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "tests/unit/config/chain_robots.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"

namespace pkm::chains_test {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;
using Robot = std::shared_ptr<const Mechanism>;
using test::kPRR, test::kRPR, test::kRRR, test::planar, test::spatial;
using test::quantity_at, test::read_robot, test::refusal_of, test::substituted, test::value_of, test::why_undefined;

template <class Vector>
Vector from_json(const Json& list) {
  Vector v(list.size());
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = list[i];
  return v;
}

AxisVector<double> forces_at(const Mechanism& mechanism, const MotionState<double>& state,
                             const AxisVector<double>& acceleration) {
  PoseDynamics<double> d;
  mechanism.dynamics()->equations(std::span<const double>(test::nominal(mechanism.info())),
                                  mechanism.info().modes.front(), {&state, 1}, {&d, 1});
  EXPECT_TRUE(d.assembles);
  return drive_forces(d, acceleration, {});
}

std::string agile_eye_driven_by(int joint) {
  const std::string text = substituted(test::text_of_mechanism("chains/agile-eye"), "\nrange[^\n]*\njoint_ranges[^\n]*",
                                       "\ndriven = " + std::to_string(joint));
  return substituted(text, "\nq_m[^\n]*", "");
}

TEST(AgileEye, HasReferenceJointsJacobiansInertiaAndForces) {
  const Robot robot = read_robot(test::text_of_mechanism("chains/agile-eye"));
  const Json cases = Json::parse(std::ifstream(PKM_TEST_DATA "/chains/chains.json"))["agile-eye"];
  ASSERT_EQ(cases.size(), 8u);
  for (const Json& each : cases) {
    SCOPED_TRACE(each["pose"].dump());
    const auto pose = from_json<Pose<double>>(each["pose"]);
    const PoseReport report = report_at(*robot, pose);
    ASSERT_TRUE(report.J);
    const auto velocity = from_json<AxisVector<double>>(each["velocity"]);
    const AxisVector<double> tau =
        forces_at(*robot, {pose, velocity}, from_json<AxisVector<double>>(each["acceleration"]));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR((*report.joints)[i], each["joints"][i], 1e-12);
      EXPECT_NEAR(value_of(report.angles, "eye" + std::to_string(i + 1) + ".q2"), each["passive"][i].get<double>(),
                  1e-12);
      for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR((*report.J)(i, j), each["J"][i][j].get<double>(), 1e-9);
      EXPECT_NEAR(tau[i], each["forces"][i].get<double>(), 1e-9);
    }
  }
}

TEST(AgileEye, HasAsManyFeasibleVoxelsAsTheReference) {
  const Json voxels = Json::parse(std::ifstream(PKM_TEST_DATA "/chains/chains.json"))["voxels"];
  ASSERT_GT(voxels["least_margin"].get<double>(), 1e-6);
  const Robot robot = read_robot(test::text_of_mechanism("chains/agile-eye"));
  const auto plan = test::voxels(robot->info(), voxels["cells"].get<std::int64_t>());
  EXPECT_EQ(test::survey(*robot, test::nominal(robot->info()), plan).feasible_cells, voxels["feasible"]);
}

// A chain is the limb with the equivalent drive: joints, Jacobians and forces have the same bits.
TEST(Chains, AreLimbsWithTheEquivalentDrive) {
  const auto expect_equal = [](const std::string& drives, const std::string& chains, const Pose<double>& pose) {
    SCOPED_TRACE(chains);
    const Robot one = read_robot(drives), other = read_robot(chains);
    const PoseReport a = report_at(*one, pose), b = report_at(*other, pose);
    ASSERT_TRUE(a.J) << a.reason;
    ASSERT_TRUE(b.J) << b.reason;
    AxisVector<double> rates(pose.size());
    for (std::size_t i = 0; i < rates.size(); ++i) rates[i] = 0.3 + 0.2 * static_cast<double>(i);
    for (std::size_t i = 0; i < a.joints->size(); ++i) EXPECT_EQ((*a.joints)[i], (*b.joints)[i]);
    for (std::size_t i = 0; i < a.J->rows(); ++i)
      for (std::size_t j = 0; j < a.J->cols(); ++j) EXPECT_EQ((*a.J)(i, j), (*b.J)(i, j));
    const AxisVector<double> forces = forces_at(*one, {pose, rates}, rates),
                             same = forces_at(*other, {pose, rates}, rates);
    for (std::size_t i = 0; i < forces.size(); ++i) EXPECT_EQ(forces[i], same[i]);
  };
  const std::string delta = test::text_of_mechanism("rotary-delta"), gough = test::text_of_mechanism("gough"),
                    rails = test::text_of_mechanism("linear-delta");
  expect_equal(test::text_of_mechanism("frames/3-prs"), test::text_of_mechanism("chains/3-prs"), {{-0.1, 0.1, -0.2}});
  expect_equal(delta,
               substituted(substituted(substituted(delta, "drive *= \"crank\"",
                                                   "drive = \"chain\"\nchain = [\"R\", \"S\", \"S\"]"),
                                       "\naxis *= (\\[[^\n]*\\])", "\naxes = [$1]"),
                           "\ncrank *= \"l_a\"\nrod *= \"l_b\"", "\nlinks = [\"l_a\", \"l_b\"]"),
               {{0.05, -0.1, -0.5}});
  expect_equal(
      rails,
      substituted(substituted(rails, "drive *= \"slider\"", "drive = \"chain\"\nchain = [\"P\", \"S\", \"S\"]"),
                  "\ndirection *= (\\[[^\n]*\\])\nrod *= \"l\"", "\naxes = [$1]\nlinks = [\"l\"]"),
      {{0.02, -0.05, 0}});
  expect_equal(gough, substituted(gough, "drive *= \"telescope\"", "drive = \"chain\"\nchain = [\"U\", \"P\", \"S\"]"),
               {{0.02, 0.05, 0.9, 0.1, -0.05, 0.1}});
}

struct Driven {
  const char* name;
  std::string text;
  Pose<double> pose;
  bool has_reactions;
};

std::vector<Driven> driven_chains() {
  std::vector<Driven> all;
  const Pose<double> in_plane{{0.02, -0.03, 0.2}}, in_space{{-0.1, 0.15, -0.1}}, turned{{0.1, -0.2, 0.15}};
  for (const int k : {1, 2, 3}) {
    const std::string driven = "driven = " + std::to_string(k) + "\n";
    all.push_back({"R-R-R", planar(kRRR + driven), in_plane, true});
    all.push_back({"P-R-R", planar(kPRR + driven), in_plane, k == 1});
    all.push_back({"R-P-R", planar(kRPR + driven), in_plane, k == 2});
    all.push_back({"spherical R-R-R", agile_eye_driven_by(k), turned, true});
    all.push_back({"P-R-R-R",
                   planar("chain = [\"P\", \"R\", \"R\", \"R\"]\naxes = [[0, 0, 1], [0, 0, 1], [0, 0, 1], [0, 0, 1]]\n"
                          "zero = [1, 0, 0]\nlinks = [0.2, 0.24]\nbranch = \"+\"\nfirst_link_mass = 0.3\n"
                          "second_link_mass = 0.2\ndriven = " +
                          std::to_string(k + 1) + "\n"),
                   in_plane, false});
    if (k == 3) continue;
    all.push_back({"P-R-S",
                   spatial("chain = [\"P\", \"R\", \"S\"]\naxes = [[1, 0, 1], [0, 1, 0]]\nlinks = [\"L\"]\n"
                           "branch = \"+\"\nrod_mass = 1\n" +
                           driven),
                   in_space, k == 1});
    all.push_back({"R-R-S",
                   spatial("chain = [\"R\", \"R\", \"S\"]\naxes = [[0, 1, 0], [0, 1, 0]]\nzero = [1, 0, 0]\n"
                           "links = [0.2, \"L\"]\nbranch = \"+\"\ncrank_mass = 1\nrod_mass = 1\n" +
                           driven),
                   {{0.3, 0.15, -0.1}},
                   true});
    all.push_back({"R-P-S",
                   spatial("chain = [\"R\", \"P\", \"S\"]\naxes = [[0, 1, 0]]\nzero = [1, 0, 0]\n"
                           "cylinder_mass = 1\ncylinder_centre = \"L/3\"\npiston_mass = 1\npiston_centre = 0.1\n" +
                           driven),
                   {{0.4, 0.15, -0.1}},
                   k == 2});
  }
  return all;
}

// The Jacobians of the loop-closure equations agree with the derivatives of the joints, J = Jq^-1 G, and the equations
// find the pose again.
TEST(Chains, AnyJointWithAClosedFormMayBeDriven) {
  for (const Driven& each : driven_chains()) {
    SCOPED_TRACE(each.text);
    const Robot robot = read_robot(each.text);
    const PoseReport report = report_at(*robot, each.pose);
    ASSERT_TRUE(report.J) << each.name << ": " << report.reason;
    const AxisMatrix<double> G = *report.Jq * *report.J;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(G(i, j), (*report.G)(i, j), 1e-12) << each.name;
    bool is_found = false;
    for (const AssemblyMode& mode :
         robot->forward()->assemblies_near(test::nominal(robot->info()), *report.joints, each.pose)) {
      double distance = 0;
      for (std::size_t i = 0; i < 3; ++i) distance += std::fabs(mode.pose[i] - each.pose[i]);
      is_found = is_found || distance < 1e-8;
    }
    EXPECT_TRUE(is_found) << each.name;
    // slides along z do not prevent the translation of the platform along z
    EXPECT_THAT(describe_mechanism(*robot),
                HasSubstr(each.name == std::string("P-R-R-R") ? "3 of 4 degrees of freedom at this pose"
                                                              : "3 of 3 degrees of freedom at this pose\n"))
        << each.name;
  }
}

// The drive forces of a chain do not depend on which of its joints is driven, if they are mapped to the coordinates.
TEST(Chains, ForcesAtThePlatformDoNotDependOnTheDrivenJoint) {
  std::map<std::string, std::vector<double>> known;
  for (const Driven& each : driven_chains()) {
    SCOPED_TRACE(each.text);
    const Robot robot = read_robot(each.text);
    const AxisVector<double> tau = forces_at(*robot, {each.pose, AxisVector<double>{{0.4, -0.5, 0.6}}}, {{2, -3, 4}});
    const AxisMatrix<double> J = *report_at(*robot, each.pose).J;
    std::vector<double> at_platform(3);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) at_platform[j] += J(i, j) * tau[i];
    const auto [first, is_new] = known.try_emplace(each.name, at_platform);
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_NEAR(at_platform[j], first->second[j], 1e-10 * (1 + std::fabs(first->second[j]))) << each.name;
  }
  EXPECT_EQ(known.size(), 8u);
}

TEST(Chains, ReactionsOfDrivenJointsAreThoseOfVirtualWork) {
  int count = 0;
  for (const Driven& each : driven_chains()) {
    SCOPED_TRACE(each.text);
    const Robot robot = read_robot(each.text);
    EXPECT_EQ(robot->reactions() != nullptr, each.has_reactions) << robot->why_no_reactions();
    if (!each.has_reactions) {
      EXPECT_THAT(robot->why_no_reactions(), HasSubstr(" has a passive slide, whose reactions are not computed"));
      EXPECT_EQ(robot->why_no_elasticity(), robot->why_no_reactions());
      continue;
    }
    ++count;
    const MotionState<double> state{each.pose, AxisVector<double>{{0.4, -0.5, 0.6}}};
    const AxisVector<double> acceleration{{2, -3, 4}};
    const AxisVector<double> tau = forces_at(*robot, state, acceleration);
    const Reactions found =
        robot->reactions()->find(test::nominal(robot->info()), robot->info().modes.front(), state, acceleration, {});
    ASSERT_EQ(found.reason, "") << each.name;
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(found.drive_forces[i], tau[i], 1e-9 * (1 + std::fabs(tau[i]))) << each.name;
  }
  EXPECT_EQ(count, 12);
}

TEST(Chains, NamePassiveJoints) {
  const double phi = 0.2;
  const Pose<double> pose{{0.02, -0.03, phi}};
  const auto sum = [&](const std::string& limb, const std::string& formula) {
    const Robot robot = read_robot(planar(limb) + "[[quantity]]\nname = \"total\"\nformula = \"" + formula + "\"\n");
    return std::remainder(quantity_at(*robot, "total", pose) - phi, 2 * kPi);
  };
  EXPECT_NEAR(sum(kRRR, "arm2.q1 + arm2.q2 + arm2.q3"), 0, 1e-12);
  EXPECT_NEAR(sum(kPRR, "arm2.q2 + arm2.q3"), 0, 1e-12);
  EXPECT_NEAR(sum(kRPR, "arm2.q1 + arm2.q3"), 0, 1e-12);
  EXPECT_NEAR(sum(kRRR + "driven = 3\n", "arm3 - arm3.q3"), -phi, 1e-15);  // the limb's name is its driven joint

  const PoseReport report = report_at(*read_robot(planar(kRPR + "driven = 1\n")), pose);
  const Eigen::Vector2d A(0.35, 0),
      B = Eigen::Vector2d(0.02, -0.03) + 0.08 * Eigen::Vector2d(std::cos(phi), std::sin(phi));
  EXPECT_NEAR(value_of(report.angles, "arm1.q2"), (B - A).norm(), 1e-15);
  EXPECT_NEAR((*report.joints)[0], std::atan2(B[1] - A[1], B[0] - A[0]), 1e-15);
}

// Each slide of a Tripteron moves the platform along its own axis; the platform does not rotate.
TEST(Chains, ATripteronIsDecoupled) {
  std::string text = test::text_of_mechanism("chains/tripteron");
  const Pose<double> pose{{0.2, 0.15, 0.3}};
  const Robot robot =
      read_robot(text + "[[quantity]]\nname = \"total\"\nformula = \"limb_y.q2 + limb_y.q3 + limb_y.q4\"\n");
  const PoseReport report = report_at(*robot, pose);
  ASSERT_TRUE(report.J);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR((*report.joints)[i], pose[i], 1e-15);
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR((*report.J)(i, j), i == j ? 1 : 0, 1e-15);
  }
  EXPECT_NEAR(std::remainder(quantity_at(*robot, "total", pose), 2 * kPi), 0, 1e-14);
  EXPECT_THAT(describe_mechanism(*robot), HasSubstr("3 of 3 degrees of freedom at this pose\n"));
  EXPECT_EQ(why_undefined(*robot, "constraint_singular_value"),
            "the constraints of the limbs have the same rank at every pose");
}

TEST(Chains, RangesOfPassiveJointsAreMargins) {
  const Pose<double> pose{{0.02, -0.03, 0.2}};
  const Robot robot = read_robot(planar(kRRR + "joint_ranges = { q2 = [\"180 deg\", \"360 deg\"] }\n"));
  const PoseReport report = report_at(*robot, pose);
  const double q_2 = value_of(report.angles, "arm1.q2");  // in the revolution about the middle of its range
  EXPECT_GT(q_2, kPi / 2);
  EXPECT_EQ(value_of(report.margins, "arm1.q2 min"), q_2 - kPi);
  EXPECT_EQ(value_of(report.margins, "arm1.q2 max"), 2 * kPi - q_2);
}

TEST(Chains, AreRefusedWithReasons) {
  const auto with = [](const std::string& from, const std::string& to) {
    return refusal_of(planar(substituted(kRRR, from, to)));
  };
  const std::string chain = "chain = \\[[^\n]*\\]\n";
  EXPECT_THAT(
      with("\"R\", \"R\", \"R\"", "\"R\", \"R\", \"P\""),
      HasSubstr("robot.toml:18: limb[1].chain: no closed form of the chain R-R-P is known; expected one of R-R-R, "
                "R-R-S, R-U-S, R-S-S, R-U-U, P-R-R, P-R-R-R, P-R-S, P-U-S, P-S-S, P-U-U, R-P-R, R-P-S, U-P-S, S-P-S, "
                "U-P-U, S-P-R, U-P-R, and R-R-R with `angles`, a spherical chain, or `links` with the vectors from "
                "each joint to the "
                "next, [[x, y, z], ..], for Newton's method"));
  EXPECT_THAT(with("\"R\", \"R\", \"R\"", "\"R\", \"R\", \"R\", \"R\""), HasSubstr("of the chain R-R-R-R is known"));
  EXPECT_THAT(with("\"R\", \"R\", \"R\"", "\"R\", \"Q\", \"R\""),
              HasSubstr("limb[1].chain[2]: found \"Q\"; expected one of P, R, C, U, S"));
  EXPECT_THAT(with(chain, ""), HasSubstr("limb[1].chain: found nothing; expected a list of joints from the base"));
  // a Bennett linkage has skew axes
  EXPECT_THAT(with("axes = \\[\\[0, 0, 1\\], \\[0, 0, 1\\]", "axes = [[0, 0, 1], [0, 1, 1]"),
              HasSubstr("limb[1].axes[2]: the revolute joints of the chain R-R-R have to be parallel"));
  EXPECT_THAT(
      with(", \\[0, 0, 1\\]\\]", "]"),
      HasSubstr("limb[1].axes: found an array; expected the directions of 3 axes of the chain R-R-R, each [x, y, z]"));
  EXPECT_THAT(with("axes[^\n]*\n", ""), HasSubstr("limb[1].axes: found nothing; expected the directions of 3 axes"));
  EXPECT_THAT(with("links[^\n]*", "links = [0.2]"),
              HasSubstr("limb[1].links: found [0.2]; expected two lengths [l_1, l_2]"));
  EXPECT_THAT(with("links[^\n]*", "links = [0.2, \"50 deg\"]"),
              HasSubstr("limb[1].links[2]: found \"50 deg\", an angle; expected a length"));
  EXPECT_THAT(with("links[^\n]*", "links = [-0.2, 0.3]"),
              HasSubstr("limb[1].links[1]: found -0.2; expected a number > 0"));
  EXPECT_THAT(with("zero = [^\n]*", "zero = [0, 0, 1]"), HasSubstr("zero"));
  EXPECT_THAT(refusal_of(planar(kRRR + "driven = 7\n")),
              HasSubstr("limb[1].driven: found 7; expected an integer in [1, 6]"));
  EXPECT_THAT(refusal_of(planar(kRRR + "driven = 4\n")),
              HasSubstr("limb[1].driven: joint 4 of the chain R-R-R cannot be driven; expected one of 1, 2, 3"));
  EXPECT_THAT(refusal_of(planar(kRRR + "across = [0, 0, 1]\n")), HasSubstr("limb[1].across: found an unknown key"));
  EXPECT_THAT(
      refusal_of(planar(kRRR + "joint_ranges = { q1 = [0, 1] }\n")),
      HasSubstr("limb[1].joint_ranges.q1: expected a passive joint of the chain, one of q2, q3; `range` is that "
                "of the driven joint"));
  EXPECT_THAT(refusal_of(planar(kRRR + "joint_ranges = { q2 = [1, 0] }\n")), HasSubstr("limb[1].joint_ranges.q2"));
  EXPECT_THAT(refusal_of(planar(kRRR + "driven = 2\nplay = \"10 um\"\n")),
              HasSubstr("limb[1].play: `play` requires that joint 1 of the chain is driven"));
  EXPECT_THAT(refusal_of(planar(substituted(kPRR, "\\[0, 1, 0\\]", "[0, 1, 1]"))),
              HasSubstr("limb[1].axes[2]: the axis of the revolute joint has to be normal to the slide, axes[1]"));
  EXPECT_THAT(refusal_of(planar(substituted(kPRR, "links = \\[0.4\\]", "links = [0.3, 0.2]"))),
              HasSubstr("limb[1].links: found [0.3, 0.2]; expected a list with the length of the rod, [l]"));
  EXPECT_THAT(refusal_of(planar(kRPR + "links = [0.3]\n")),
              HasSubstr("limb[1].links: the chain R-P-R has no link of constant length"));
  EXPECT_THAT(refusal_of(planar(substituted(kRPR, "zero[^\n]*\n", ""))),
              HasSubstr("limb[1].zero: found nothing; expected the direction, normal to the axis"));
  EXPECT_THAT(refusal_of(planar(substituted(kRPR, "zero[^\n]*", "zero = [1, 0, 1]"))),
              HasSubstr("limb[1].zero: `zero` has to be normal to the axis of the revolute joints"));
  const std::string delta =
      substituted(substituted(substituted(test::text_of_mechanism("rotary-delta"), "drive *= \"crank\"",
                                          "drive = \"chain\"\ndriven = 2\nchain = [\"R\", \"S\", \"S\"]"),
                              "\naxis *= (\\[[^\n]*\\])", "\naxes = [$1]"),
                  "\ncrank *= \"l_a\"\nrod *= \"l_b\"", "\nlinks = [\"l_a\", \"l_b\"]");
  EXPECT_THAT(refusal_of(delta), HasSubstr("driven: joint 2 of the chain R-S-S cannot be driven; expected 1"));
  EXPECT_THAT(refusal_of(spatial("chain = [\"P\", \"R\", \"S\"]\naxes = [[0, 0, 1], [0, 1, 0]]\nlinks = [\"L\"]\n"
                                 "branch = \"+\"\ndriven = 3\n")),
              HasSubstr("driven: joint 3 of the chain P-R-S cannot be driven; expected one of 1, 2"));
  EXPECT_THAT(refusal_of(substituted(test::text_of_mechanism("gough"), "drive *= \"telescope\"",
                                     "drive = \"chain\"\naxes = [[1, 0, 0]]\nchain = [\"U\", \"P\", \"S\"]")),
              HasSubstr("axes: the chain U-P-S has no axis that is fixed to the base"));
}

TEST(SphericalChains, AreRefusedWithReasons) {
  const auto with = [](const std::string& from, const std::string& to) {
    return refusal_of(substituted(test::text_of_mechanism("chains/agile-eye"), from, to));
  };
  EXPECT_THAT(with("\\[\"R\", \"R\", \"R\"\\]", "[\"R\", \"R\", \"S\"]"),
              HasSubstr("chain: no closed form of the spherical chain R-R-S is known"));
  EXPECT_THAT(with("\\[\"u\", \"v\"\\]", "[\"u\"]"),
              HasSubstr("axes: found [\"u\"]; expected two axes: the first, in the base's"));
  EXPECT_THAT(with("\\[\"alpha_1\", \"alpha_2\"\\]", "[\"alpha_1\"]"),
              HasSubstr("angles: found [\"alpha_1\"]; expected two angles [alpha_1, alpha_2]"));
  EXPECT_THAT(with("\\[\"alpha_1\", \"alpha_2\"\\]", "[\"alpha_1\", \"190 deg\"]"),
              HasSubstr("angles[2]: found \"190 deg\"; expected an angle > 0 and < 180 deg"));
  EXPECT_THAT(with("zero *= \"cross\\(u, v\\)\"", "zero = \"u\""),
              HasSubstr("zero: `zero` has to be normal to the first axis"));
  EXPECT_THAT(with("zero *= \"cross\\(u, v\\)\"", "zero = \"v\""),
              HasSubstr("zero: `zero` must not be parallel to the last axis"));
  EXPECT_THAT(with("zero [^\n]*\n", ""), HasSubstr("zero: found nothing; expected the direction of the first link"));
  EXPECT_THAT(with("arc_radius [^\n]*\n", ""), HasSubstr("`radius` requires `arc_radius`, the radius of the arcs"));
  EXPECT_THAT(with("radius     = \"5 mm\"", "crank_mass = 1"), HasSubstr("crank_mass: found an unknown key"));
  EXPECT_THAT(with("branch ", "platform = [0, 0, 0]\nbranch "),
              HasSubstr("platform: a spherical chain has no `platform`"));
  EXPECT_THAT(with("copies [^\n]*", "copies = [{ base = [0, 0, 0], platform = [0, 0, 0] }]"), HasSubstr("base"));
}

}  // namespace
}  // namespace pkm::chains_test
