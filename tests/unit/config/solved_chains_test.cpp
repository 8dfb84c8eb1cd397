// Limbs as chains of joints that Newton's method finds: joints against values of a program that shares no code, chains
// that have a closed form, too, a chain that constrains the platform, and refusals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include "tests/unit/config/mechanism_text.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm::solved_chains_test {
namespace {

using Json = nlohmann::json;
using test::read_robot, test::refusal_of, test::substituted, test::value_of;
using ::testing::HasSubstr;

Pose<double> pose_of(const Json& list) {
  Pose<double> pose(list.size());
  for (std::size_t i = 0; i < pose.size(); ++i) pose[i] = list[i];
  return pose;
}

// solved.py computes the joints by matrix exponentials of all twists, without cutting the chains at spherical joints.
TEST(SolvedChains, HaveReferenceJoints) {
  const auto robot = read_robot(test::text_of_file(PKM_TEST_DATA "/chains/solved.toml"));
  const Json cases = Json::parse(std::ifstream(PKM_TEST_DATA "/chains/solved.json"));
  ASSERT_EQ(cases.size(), 8u);
  for (const Json& each : cases) {
    SCOPED_TRACE(each["pose"].dump());
    const PoseReport report = report_at(*robot, pose_of(each["pose"]));
    ASSERT_TRUE(report.joints) << report.reason;
    std::size_t passive = 0;
    for (std::size_t i = 0; i < robot->info().joints.size(); ++i) {
      const std::string& limb = robot->info().joints[i].name;
      for (const auto& [name, value] : each["joints"].at(limb).items()) {
        double found = (*report.joints)[i];
        for (const auto& [angle, its_value] : report.angles)
          if (angle == limb + "." + name) {
            found = its_value;
            ++passive;
          }
        EXPECT_NEAR(found, value.get<double>(), 1e-12) << limb << "." << name;
      }
    }
    EXPECT_EQ(passive, report.angles.size());
  }
}

TEST(SolvedChains, AgreeWithTheClosedFormOfALeg) {
  const std::string text =
      "[mechanism]\nname = \"legs\"\n[parameters]\nR = { default = 0.3, min = 0.1, max = 1, unit = \"m\" }\n"
      "[platform]\ncoordinates = { x = \"along x\", y = \"along y\", z = \"along z\" }\ncharacteristic_length = 1\n"
      "[survey]\nbox = { x = [-0.2, 0.2], y = [-0.2, 0.2], z = [0.4, 0.7] }\n"
      "[[limb]]\nname = \"leg\"\ncopies = { number = 3, about = \"z\" }\ndrive = \"chain\"\nbase = [\"R\", 0, 0]\n"
      "platform = [0.1, 0, 0]\n";
  const auto closed = read_robot(text + "chain = [\"U\", \"P\", \"S\"]\n");
  // the leg at z = 0.5; a universal joint at the platform, too, whose axes there are parallel to those at the base
  const std::string leg = "links = [[0, 0, 0], [\"0.1 - R\", 0, 0.5]]\n", along = "[\"0.1 - R\", 0, 0.5]";
  const auto ball = read_robot(text + "chain = [\"U\", \"P\", \"S\"]\naxes = [[1, 0, 0], [0, 1, 0], " + along + "]\n" +
                               leg),
             universal = read_robot(text + "chain = [\"U\", \"P\", \"U\"]\naxes = [[1, 0, 0], [0, 1, 0], " + along +
                                    ", [0, 1, 0], [1, 0, 0]]\n" + leg);
  for (const Pose<double>& pose : {Pose<double>{{0.05, -0.1, 0.55}}, Pose<double>{{-0.15, 0.1, 0.45}}}) {
    const PoseReport expected = report_at(*closed, pose);
    for (const auto& robot : {ball, universal}) {
      const PoseReport found = report_at(*robot, pose);
      ASSERT_TRUE(found.J) << found.reason;
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR((*found.joints)[i] + std::hypot(0.2, 0.5), (*expected.joints)[i], 1e-13);
        for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR((*found.J)(i, j), (*expected.J)(i, j), 1e-11);
      }
    }
  }
}

// Li and Xu 2006: q = z + sqrt(l^2 - (x + r - R)^2) in the coordinates of the limb, and y is the displacement of the
// cylindrical joint.
TEST(SolvedChains, OfA3PrcAreThoseOfItsClosedForm) {
  const auto robot = read_robot(test::text_of_mechanism("chains/3-prc"));
  for (const Pose<double>& pose : {Pose<double>{{0.03, -0.02, -0.42}}, Pose<double>{{-0.1, 0.09, -0.35}}}) {
    const PoseReport report = report_at(*robot, pose);
    ASSERT_TRUE(report.joints) << report.reason;
    for (int k = 0; k < 3; ++k) {
      const double turn = 2 * kPi * k / 3, c = std::cos(turn), s = std::sin(turn);
      const double x = c * pose[0] + s * pose[1], y = c * pose[1] - s * pose[0], inward = x + 0.1 - 0.4;
      const std::string leg = "leg" + std::to_string(k + 1) + ".";
      EXPECT_NEAR((*report.joints)[static_cast<std::size_t>(k)], pose[2] + std::sqrt(0.25 - inward * inward), 1e-13);
      EXPECT_NEAR(value_of(report.angles, leg + "q3_1"), y, 1e-13);
      EXPECT_NEAR(value_of(report.angles, leg + "q2"), std::asin(-inward / 0.5) - std::asin(0.3 / 0.5), 1e-13);
      EXPECT_NEAR(value_of(report.angles, leg + "q3_2"), -value_of(report.angles, leg + "q2"), 1e-13);
    }
  }
}

TEST(SolvedChains, AreRefusedWithReasons) {
  const auto with = [](const std::string& from, const std::string& to) {
    return refusal_of(substituted(test::text_of_mechanism("chains/3-prc"), from, to));
  };
  const std::string chain = "\\[\"P\", \"R\", \"C\"\\]";
  EXPECT_THAT(with("axes     = \\[\\[0, 0, 1\\], ", "axes = ["),
              HasSubstr("axes: found an array; expected the directions of the 3 axes of the chain in its reference"));
  EXPECT_THAT(with(chain, "[\"P\", \"R\", \"U\"]"),
              HasSubstr("axes: found an array; expected the directions of the 4"));
  EXPECT_THAT(with("links    = [^\n]*", "links = [[0, 0, 0]]"),
              HasSubstr("links: found an array; expected the vectors from each of the 3 joints to the next"));
  EXPECT_THAT(with("links    = [^\n]*", "links = [0.3, 0.2]"), HasSubstr("no closed form of the chain P-R-C is known"));
  EXPECT_THAT(with(chain, "[\"P\", \"S\", \"S\"]"),
              HasSubstr("two spherical joints do not determine the rotation of the links between them"));
  EXPECT_THAT(with("range    =", "driven = 3\nrange ="),
              HasSubstr("driven: joint 3 of the chain P-R-C cannot be driven; expected one of 1, 2"));
  EXPECT_THAT(with("range    =", "branch = \"+\"\nrange ="),
              HasSubstr("branch: `branch` has no effect on a chain whose joints are found by Newton's method"));
  EXPECT_THAT(with("\\{ q2 =", "{ q1 ="), HasSubstr("joint_ranges.q1: expected a passive joint of the chain, one of "
                                                    "q2, q3_1, q3_2; `range` is that of the driven joint"));
  // without the sliding of the cylindrical joint, the limbs do not permit all translations
  EXPECT_THAT(with(chain, "[\"P\", \"R\", \"R\"]"),
              HasSubstr("chain: the chain has 3 degrees of freedom, which do not permit all motions of the platform"));
  std::string seven;
  for (int i = 0; i < 3; ++i) seven += "\"U\", ";
  EXPECT_THAT(refusal_of(substituted(
                  substituted(substituted(test::text_of_mechanism("chains/3-prc"), chain, "[" + seven + "\"R\"]"),
                              "axes     = [^\n]*",
                              "axes = [[1, 0, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0], "
                              "[0, 0, 1]]"),
                  "links    = [^\n]*", "links = [[0, 0, -0.1], [0, 0, -0.1], [0, 0, -0.1]]")),
              HasSubstr("chain: the chain has 7 degrees of freedom; expected at most 6"));
}

}  // namespace
}  // namespace pkm::solved_chains_test
