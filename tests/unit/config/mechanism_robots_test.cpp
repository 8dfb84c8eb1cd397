// Published robots as chains of joints: an Exechon module, an Isoglide4-T3R1 and a Hexaglide against values of a
// program that shares no code; the chains S P R and U P R; and copies of a limb with further keys of their own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <regex>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "engine/config/mechanism_file.hpp"
#include "engine/core/error.hpp"
#include "engine/dynamics/coupling.hpp"
#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/math/eigen_solvers.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "tests/unit/config/report_at.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm::robots_test {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;
using Robot = std::shared_ptr<const Mechanism>;

Robot read(const std::string& text) { return read_mechanism_toml(text, "robot.toml"); }
std::string text_of(const std::string& name) { return test::text_of_mechanism("chains/" + name); }

template <class Vector>
Vector from_json(const Json& list) {
  Vector v(list.size());
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = list[i];
  return v;
}

std::string replaced(const std::string& text, const std::string& from, const std::string& to) {
  const std::regex pattern(from);
  EXPECT_TRUE(std::regex_search(text, pattern)) << from;
  return std::regex_replace(text, pattern, to);
}

/// The message about a file; "it is accepted" if there is none.
std::string refusal_of(const std::string& text) {
  try {
    read(text);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "it is accepted";
}

PoseDynamics<double> dynamics_at(const Mechanism& mechanism, const MotionState<double>& state) {
  PoseDynamics<double> d;
  mechanism.dynamics()->equations(std::span<const double>(test::nominal(mechanism.info())),
                                  mechanism.info().modes.front(), {&state, 1}, {&d, 1});
  EXPECT_TRUE(d.assembles);
  return d;
}

double quantity_at(const Mechanism& mechanism, const std::string& name, const Pose<double>& pose) {
  const auto& known = mechanism.info().quantities;
  const auto found = std::ranges::find(known, name, &QuantityInfo::name);
  if (found == known.end()) throw std::logic_error(name);
  return report_at(mechanism, pose).quantities[static_cast<std::size_t>(found - known.begin())];
}

const Pose<double> kTilted{{0.72, 0.25, -0.3}};  // of the Exechon: z, alpha, beta

class PublishedRobots : public ::testing::TestWithParam<std::string> {
 protected:
  const Robot robot_ = read(text_of(GetParam()));
  const Json known_ = Json::parse(std::ifstream(PKM_TEST_DATA "/chains/robots.json"))[GetParam()];
};

TEST_P(PublishedRobots, HaveReferenceJointsJacobiansInertiaAndForces) {
  ASSERT_EQ(known_["cases"].size(), 6u);
  for (const Json& each : known_["cases"]) {
    SCOPED_TRACE(each["pose"].dump());
    const auto pose = from_json<Pose<double>>(each["pose"]);
    const std::size_t n = pose.size();
    const PoseReport report = report_at(*robot_, pose);
    ASSERT_TRUE(report.J);
    EXPECT_TRUE(report.feasible) << report.reason;
    const PoseDynamics<double> d = dynamics_at(*robot_, {pose, from_json<AxisVector<double>>(each["velocity"])});
    const AxisVector<double> tau = drive_forces(d, from_json<AxisVector<double>>(each["acceleration"]), {});
    const auto dci = coupling_indices(joint_space(d).M_q);
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_NEAR((*report.joints)[i], each["joints"][i], 1e-12);
      EXPECT_NEAR(tau[i], each["forces"][i].get<double>(), 1e-9);
      EXPECT_NEAR(dci[i], each["dci"][i].get<double>(), 1e-9);
      for (std::size_t j = 0; j < n; ++j) {
        EXPECT_NEAR((*report.J)(i, j), each["J"][i][j].get<double>(), 1e-9);
        EXPECT_NEAR(d.M_X(i, j), each["M"][i][j].get<double>(), 1e-9);
      }
    }
    const Json parasitic = each.value("dependent", Json::array());
    for (std::size_t k = 0; k < parasitic.size(); ++k)
      EXPECT_NEAR(quantity_at(*robot_, k == 0 ? "x" : "y", pose), parasitic[k].get<double>(), 1e-12);
  }
}

TEST_P(PublishedRobots, HaveTheFeasibleVoxelsOfTheReference) {
  const Json& voxels = known_["voxels"];
  ASSERT_GT(voxels["least_margin"].get<double>(), 1e-6);
  WorkspacePlan plan = test::voxels(robot_->info(), voxels["cells"].get<std::int64_t>());
  for (std::size_t i = 0; i < voxels["fixed"].size(); ++i) {
    plan.fixed[i].kind = FixedCoordinate::Kind::value;
    plan.fixed[i].value = voxels["fixed"][i];
  }
  std::string feasible;
  for (const std::uint8_t cell : voxel_map(*robot_, test::nominal(robot_->info()), plan).feasible)
    feasible += cell ? '1' : '0';
  EXPECT_EQ(feasible, voxels["feasible"].get<std::string>());
  EXPECT_GT(std::ranges::count(feasible, '1'), 40);
}

// The joints of the file permit exactly the motions of the coordinates, and Newton-Euler equations of all bodies give
// the drive forces of the virtual work.
TEST_P(PublishedRobots, HaveForcesInTheirJoints) {
  const std::string n = std::to_string(robot_->info().coordinates.size());
  EXPECT_THAT(describe_mechanism(*robot_), HasSubstr(n + " of " + n + " degrees of freedom at this pose\n"));
  ASSERT_TRUE(robot_->reactions()) << robot_->why_no_reactions();
  const Json& each = known_["cases"][0];
  const MotionState<double> state{from_json<Pose<double>>(each["pose"]),
                                  from_json<AxisVector<double>>(each["velocity"])};
  const auto acceleration = from_json<AxisVector<double>>(each["acceleration"]);
  const Wrench<double> wrench{{3, -4, 5, 0.6, -0.5, 0.4}};
  const AxisVector<double> tau = drive_forces(dynamics_at(*robot_, state), acceleration, wrench);
  const Reactions found = robot_->reactions()->find(test::nominal(robot_->info()), robot_->info().modes.front(), state,
                                                    acceleration, wrench);
  ASSERT_EQ(found.reason, "");
  for (std::size_t i = 0; i < tau.size(); ++i)
    EXPECT_NEAR(found.drive_forces[i], tau[i], 1e-9 * (1 + std::fabs(tau[i])));
}

INSTANTIATE_TEST_SUITE_P(All, PublishedRobots, ::testing::Values("exechon", "isoglide4-t3r1", "hexaglide"),
                         [](const auto& of) { return test::test_name(of.param); });

// Three slides translate the platform independently of each other; the fourth one rotates it.
TEST(Isoglide, IsDecoupled) {
  const Robot robot = read(text_of("isoglide4-t3r1"));
  const Pose<double> pose{{0.2, 0.25, 0.3, 0.4}};
  const AxisMatrix<double> J = *report_at(*robot, pose).J;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      const double expected = i == 3 && j == 3 ? -0.15 * std::cos(0.4) : (i == j || (i == 3 && j == 2)) ? 1 : 0;
      EXPECT_NEAR(J(i, j), expected, 1e-15);
    }
}

// Legs that end in spherical joints have the same joint coordinates, but do not prevent any motion.
TEST(HingedLegs, AreTelescopes) {
  const std::string text = text_of("exechon"),
                    free = replaced(replaced(text, "\\[\"(U|S)\", \"P\", \"R\"\\]", "[\"S\", \"P\", \"S\"]"),
                                    "\n(axes|zero) [^\n]*", "");
  const PoseReport a = report_at(*read(text), kTilted), b = report_at(*read(free), kTilted);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ((*a.joints)[i], (*b.joints)[i]);
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR((*a.J)(i, j), (*b.J)(i, j), 1e-14);
  }
  EXPECT_THAT(describe_mechanism(*read(free)), HasSubstr("do not prevent"));
}

// The angle of a hinge from the leg to `zero` of the platform, and the hinge as the driven joint.
TEST(HingedLegs, NameAndMayDriveTheHinge) {
  const std::string text = text_of("exechon");
  const PoseReport report = report_at(*read(text), kTilted);
  const Eigen::Matrix3d R = (Eigen::AngleAxisd(kTilted[1], Eigen::Vector3d::UnitX()) *
                             Eigen::AngleAxisd(kTilted[2], Eigen::Vector3d::UnitY()))
                                .toRotationMatrix();
  const double z = kTilted[0] / std::cos(kTilted[1]);  // of the platform in the plane of the legs U P R
  const double x = std::tan(kTilted[2]) * (z - 0.45 * std::sin(kTilted[1]));
  const Eigen::Vector3d p = Eigen::AngleAxisd(kTilted[1], Eigen::Vector3d::UnitX()) * Eigen::Vector3d(x, 0, z);
  const Eigen::Vector3d leg = p + R * Eigen::Vector3d(0.15, 0, 0) - Eigen::Vector3d(0.35, 0, 0);
  const Eigen::Vector3d side = R.col(0), hinge = R.col(1);
  const double expected = std::atan2(hinge.dot(leg.cross(side)), leg.dot(side));
  const auto angle = std::ranges::find(report.angles, "upr1.q3", &NamedValues::value_type::first);
  ASSERT_NE(angle, report.angles.end());
  EXPECT_NEAR(angle->second, expected, 1e-12);

  const Robot driven = read(replaced(text, "(zero *= \\[1, 0, 0\\]\n[^\n]*\n[^\n]*\n)range [^\n]*",
                                     "driven = 3\n$1range = [\"-180 deg\", \"180 deg\"]"));
  const PoseReport other = report_at(*driven, kTilted);
  ASSERT_TRUE(other.J) << other.reason;
  EXPECT_NEAR((*other.joints)[0], expected, 1e-12);
  const AxisMatrix<double> G = *other.Jq * *other.J;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(G(i, j), (*other.G)(i, j), 1e-12);
}

// The smallest singular value of the powers of the constraint wrenches, which are computed here as the null space of
// the twists of all joints of a leg; the forces pass through the joints of the base.
TEST(HingedLegs, HaveConstraintsReciprocalToTheirJoints) {
  const double alpha = kTilted[1], beta = kTilted[2], z = kTilted[0];
  const Eigen::Matrix3d R_x = Eigen::AngleAxisd(alpha, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const Eigen::Matrix3d R = R_x * Eigen::AngleAxisd(beta, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const Eigen::Vector3d O(std::tan(beta) * (z / std::cos(alpha) - 0.45 * std::sin(alpha)), -z * std::tan(alpha), z);
  const Eigen::Vector3d e_x = Eigen::Vector3d::UnitX(), across = R.col(1), along = R.col(0);
  using Twist = Eigen::Matrix<double, 6, 1>;
  const double unit = 0.15;  // the characteristic length
  const auto revolute = [&](const Eigen::Vector3d& at, const Eigen::Vector3d& axis) {
    Twist t;
    t << (at - O).cross(axis), axis;
    return t;
  };
  const auto slide = [](const Eigen::Vector3d& direction) {
    Twist t;
    t << direction.normalized(), Eigen::Vector3d::Zero();
    return t;
  };
  Eigen::MatrixXd powers(0, 3);
  const auto add = [&](const Eigen::MatrixXd& wrenches) {
    for (Eigen::Index i = 0; i < wrenches.cols(); ++i) {
      powers.conservativeResize(powers.rows() + 1, 3);
      const Eigen::Vector3d f = wrenches.col(i).head<3>(), m = wrenches.col(i).tail<3>() / unit;
      powers.row(powers.rows() - 1) << f[0], f[1], m.dot(e_x.cross(R_x.col(1)));
    }
  };
  const Eigen::Vector3d side(0.35, 0, 0), arm = R * Eigen::Vector3d(0.15, 0, 0);
  for (const double sign : {1.0, -1.0}) {
    const Eigen::Vector3d A = sign * side, B = O + sign * arm;
    Eigen::MatrixXd twists(6, 4);
    twists << revolute(A, e_x), revolute(A, across), slide(B - A), revolute(B, across);
    EXPECT_EQ(Eigen::FullPivLU<Eigen::MatrixXd>(twists).rank(), 4);
    Twist force, couple;
    force << across, (A - O).cross(across);
    couple << Eigen::Vector3d::Zero(), e_x.cross(across).normalized() * unit;
    Eigen::MatrixXd wrenches(6, 2);
    wrenches << force, couple;
    const Eigen::MatrixXd reciprocal =
        wrenches.topRows(3).transpose() * twists.topRows(3) + wrenches.bottomRows(3).transpose() * twists.bottomRows(3);
    EXPECT_LT(reciprocal.cwiseAbs().maxCoeff(), 1e-14);
    add(wrenches);
  }
  const Eigen::Vector3d A(0, -0.45, 0), B = O + R * Eigen::Vector3d(0, -0.2, 0);
  Twist force;
  force << along, (A - O).cross(along);
  for (const Twist& twist : {slide(B - A), revolute(B, along), revolute(A, e_x), revolute(A, Eigen::Vector3d(0, 1, 0))})
    EXPECT_NEAR(force.dot(twist), 0, 1e-14);
  add(force);
  const double expected = Eigen::JacobiSVD<Eigen::MatrixXd>(powers).singularValues()[2];
  EXPECT_NEAR(quantity_at(*read(text_of("exechon")), "constraint_singular_value", kTilted), expected, 1e-8);
}

TEST(HingedLegs, AreRefusedWithReasons) {
  const auto with = [](const std::string& from, const std::string& to) {
    return refusal_of(replaced(text_of("exechon"), from, to));
  };
  EXPECT_THAT(with("\ny = [^\n]*", "\ny = \"-z*sin(alpha)\""),
              HasSubstr("the component of B - A along `across` changes with the pose"));
  EXPECT_THAT(
      with("axes     = \\[\\[1, 0, 0\\], \\[0, 1, 0\\]\\]", "axes = [[0, 0, 1], [0, 1, 0]]"),
      HasSubstr("axes[1]: this axis of the universal joint does not stay normal to that of the revolute joint"));
  EXPECT_THAT(with("axes     = \\[\\[1, 0, 0\\], \\[0, 1, 0\\]\\]", "axes = [[1, 1, 0], [0, 1, 0]]"),
              HasSubstr("axes[2]: the axis of the revolute joint has to be normal to that of the universal joint, "
                        "axes[1]"));
  EXPECT_THAT(with("zero     = \\[1, 0, 0\\]", "zero = [0, 1, 0]"),
              HasSubstr("`zero` has to be normal to the axis of the revolute joints"));
  EXPECT_THAT(with("\nzero [^\n]*", ""), HasSubstr("zero: found nothing"));
}

// A copy with a branch and axes of its own is the limb with these keys: results have the same bits.
TEST(CopiesWithOwnKeys, AreLimbsWithTheseKeys) {
  const std::string text = text_of("hexaglide");
  std::string limbs = text.substr(0, text.find("[[limb]]")), limb = text.substr(text.find("[[limb]]"));
  const auto from = limb.find("copies"), to = limb.find("]\n", limb.find("platform = [\"r*cos(a)\", \"-r")) + 2;
  const std::string list = limb.substr(from, to - from);
  const std::regex entry("\\{ (branch = [^,]*), (base = \\[[^\\]]*\\]), (platform = \\[[^\\]]*\\]) \\}");
  int count = 0;
  for (auto each = std::sregex_iterator(list.begin(), list.end(), entry); each != std::sregex_iterator(); ++each)
    limbs += replaced(limb.substr(0, from) + (*each)[1].str() + "\n" + (*each)[2].str() + "\n" + (*each)[3].str() +
                          "\n" + limb.substr(to),
                      "\"leg\"", "\"leg" + std::to_string(++count) + "\"");
  ASSERT_EQ(count, 6);
  const Robot copies = read(text), single = read(limbs);
  const Pose<double> pose{{0.02, -0.05, -0.62, 0.1, -0.15, 0.05}};
  const PoseReport a = report_at(*copies, pose), b = report_at(*single, pose);
  ASSERT_TRUE(b.J) << b.reason;
  const AxisVector<double> rates{{0.4, -0.5, 0.6, 1, 2, -1}};
  const AxisVector<double> forces = drive_forces(dynamics_at(*copies, {pose, rates}), rates, {}),
                           same = drive_forces(dynamics_at(*single, {pose, rates}), rates, {});
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ((*a.joints)[i], (*b.joints)[i]);
    EXPECT_EQ(forces[i], same[i]);
  }
}

TEST(CopiesWithOwnKeys, AreRefusedWithReasons) {
  const auto with = [](const std::string& from, const std::string& to) {
    return refusal_of(replaced(text_of("hexaglide"), from, to));
  };
  EXPECT_THAT(with("\nlinks ", "\nbranch = \"+\"\nlinks "),
              HasSubstr("limb[1].branch: `branch` is also in a table of `copies`; give it either there or here"));
  EXPECT_THAT(with("branch = \"-\", base = \\[0, \"5", "base = [0, \"5"), HasSubstr("limb[1].branch: found nothing"));
  EXPECT_THAT(with("branch = \"-\", base = \\[0, \"5", "brench = \"-\", base = [0, \"5"),
              HasSubstr("limb[1].copies[1].brench: found an unknown key"));
  EXPECT_THAT(with("branch = \"-\", base = \\[0, \"5", "branch = \"up\", base = [0, \"5"),
              HasSubstr("branch: found \"up\"; expected one of +, -"));
}

}  // namespace
}  // namespace pkm::robots_test
