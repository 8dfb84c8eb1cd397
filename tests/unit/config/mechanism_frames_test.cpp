// Frames and dependent coordinates of mechanism files: robots against values of a program that shares no code, the same
// robot described without frames, inertia that is known by hand, forces in the joints, and refusals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "engine/config/mechanism_file.hpp"
#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

std::shared_ptr<const Mechanism> jointed(const std::string& name) {
  return read_mechanism_toml(test::text_of_mechanism("frames/" + name), name + ".toml");
}

/// Reference values of a robot. The 3-PRS by [[solve]] has those of the 3-PRS by formulas.
Json cases_of(const std::string& name) {
  return Json::parse(std::ifstream(PKM_TEST_DATA "/frames/frames.json"))[name == "3-prs-solved" ? "3-prs" : name];
}

template <class Vector>
Vector from_json(const Json& list) {
  Vector v(list.size());
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = list[i];
  return v;
}

PoseReport nominal_report(const Mechanism& mechanism, const Pose<double>& pose) {
  return mechanism.inspect(test::nominal(mechanism.info()), pose, mechanism.info().modes.front(),
                           no_limits(mechanism.info()));
}

PoseDynamics<double> dynamics_at(const Mechanism& mechanism, const MotionState<double>& state) {
  PoseDynamics<double> d;
  mechanism.dynamics()->equations(std::span<const double>(test::nominal(mechanism.info())),
                                  mechanism.info().modes.front(), {&state, 1}, {&d, 1});
  return d;
}

class FramesOfRobots : public ::testing::TestWithParam<std::string> {};

TEST_P(FramesOfRobots, GiveReferenceJointsJacobiansInertiaAndForces) {
  const auto mechanism = jointed(GetParam());
  const Json cases = cases_of(GetParam());
  ASSERT_GE(cases.size(), 8u);
  for (const Json& each : cases) {
    SCOPED_TRACE(each["pose"].dump());
    const auto pose = from_json<Pose<double>>(each["pose"]);
    const PoseReport report = nominal_report(*mechanism, pose);
    ASSERT_TRUE(report.J);
    const std::size_t n = pose.size();
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR((*report.joints)[i], each["joints"][i], 1e-12);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) EXPECT_NEAR((*report.J)(i, j), each["J"][i][j].get<double>(), 1e-9);
    const PoseDynamics<double> d = dynamics_at(*mechanism, {pose, from_json<AxisVector<double>>(each["velocity"])});
    ASSERT_TRUE(d.assembles);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) EXPECT_NEAR(d.M_X(i, j), each["M"][i][j].get<double>(), 1e-9);
    const AxisVector<double> tau = drive_forces(d, from_json<AxisVector<double>>(each["acceleration"]), {});
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(tau[i], each["forces"][i].get<double>(), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(All, FramesOfRobots, ::testing::Values("3-prs", "3-prs-solved", "delta-with-shaft", "h4"),
                         [](const auto& of) {
                           std::string name = of.param;
                           std::ranges::replace(name, '-', '_');
                           return "of_" + name;
                         });

TEST(DependentCoordinates, AreQuantitiesOfThePose) {
  for (const char* const robot : {"3-prs", "3-prs-solved"}) {
    const auto mechanism = jointed(robot);
    const std::vector<double> design = test::nominal(mechanism->info());
    for (const Json& each : cases_of(robot)) {
      MotionSample at;
      at.pose = from_json<Pose<double>>(each["pose"]);
      at.velocity = at.acceleration = AxisVector<double>(3);
      const std::vector<double> values =
          mechanism->quantities(design, mechanism->info().modes.front(), no_limits(mechanism->info()), at);
      const auto& known = mechanism->info().quantities;
      for (std::size_t k = 0; const std::string name : {"x", "y", "gamma"}) {
        const auto found = std::ranges::find(known, name, &QuantityInfo::name);
        ASSERT_NE(found, known.end());
        EXPECT_NEAR(values[static_cast<std::size_t>(found - known.begin())], each["dependent"][k++].get<double>(),
                    1e-15);
      }
    }
  }
}

// Twists of the platform: the derivative of its rotation is omega x R, with the dependent angle in omega.
TEST(DependentCoordinates, CountInTheAngularVelocityOfThePlatform) {
  const auto mechanism = jointed("3-prs");
  const Pose<double> pose{{-0.1, 0.4, -0.3}};
  const auto at = [&](std::size_t i, double h) {
    Pose<double> moved = pose;
    moved[i] += h;
    const double a = moved[1], b = moved[2];
    const double g = std::atan2(-std::sin(a) * std::sin(b), std::cos(a) + std::cos(b));
    return Eigen::Matrix3d(Eigen::AngleAxisd(a, Eigen::Vector3d::UnitX()) *
                           Eigen::AngleAxisd(b, Eigen::Vector3d::UnitY()) *
                           Eigen::AngleAxisd(g, Eigen::Vector3d::UnitZ()));
  };
  const PoseReport report = nominal_report(*mechanism, pose);
  for (std::size_t i = 0; i < 3; ++i) {
    const double h = 1e-5;
    const Eigen::Matrix3d spin = (at(i, h) - at(i, -h)) / (2 * h) * at(i, 0).transpose();
    EXPECT_NEAR((*report.T)(3, i), spin(2, 1), 1e-9);
    EXPECT_NEAR((*report.T)(4, i), spin(0, 2), 1e-9);
    EXPECT_NEAR((*report.T)(5, i), spin(1, 0), 1e-9);
  }
}

// The kinematics of an H4 are those of a Par4 of the same dimensions, whose limbs end in formulas.
TEST(FramesOfRobots, DescribeTheSameWorkspaceAsFormulasOfTheEnds) {
  const auto cells = [](const Mechanism& mechanism) {
    WorkspacePlan plan{.method = VoxelOptions{.cells = {24, 24, 24}}, .limits = no_limits(mechanism.info())};
    plan.fixed.push_back({.coordinate = 3, .kind = FixedCoordinate::Kind::value, .value = 0.5});
    return test::survey(mechanism, test::nominal(mechanism.info()), plan).feasible_cells;
  };
  const auto count = cells(*jointed("h4"));
  EXPECT_GT(count, 100);
  EXPECT_EQ(count, cells(*test::described("par4")));
}

// A frame that rotates, with a telescope on it: the inertia about its axis, with l = 0.5 m.
TEST(MovingBases, HaveInertiaThatIsKnownByHand) {
  const auto mechanism = read_mechanism_toml(test::text_of_file(PKM_TEST_DATA "/keys/frames.toml"), "frames.toml");
  const double z = 0.37, phi = 0.6, l = 0.5;
  // in the turret's frame: B is the end of the telescope, u its direction
  const Eigen::Vector2d A(0, -0.1), B(l, -z), u = (B - A).normalized(), normal(-u[1], u[0]);
  const Eigen::Vector2d cylinder = A + 0.1 * u, piston = B - 0.1 * u;
  const PoseDynamics<double> d = dynamics_at(*mechanism, {Pose<double>{{z, phi}}, AxisVector<double>(2)});
  EXPECT_NEAR(d.M_X(1, 1), 2 * B.squaredNorm() + 0.01 + 0.05 + 5 * 1e-4 + cylinder.squaredNorm() + piston.squaredNorm(),
              1e-12);
  // velocities for a unit rate of z, B' = (0, -1): the piston slides along u, and both bodies rotate
  const double slide = -u[1], turn = -normal[1] / (B - A).norm();
  const Eigen::Vector2d of_cylinder = 0.1 * turn * normal;
  const Eigen::Vector2d of_piston = slide * u + ((B - A).norm() - 0.1) * turn * normal;
  EXPECT_NEAR(d.M_X(0, 0), 2 + of_cylinder.squaredNorm() + of_piston.squaredNorm(), 1e-12);
  const auto moment = [](const Eigen::Vector2d& at, const Eigen::Vector2d& v) { return at[0] * v[1] - at[1] * v[0]; };
  EXPECT_NEAR(d.M_X(0, 1), 2 * moment(B, {0, -1}) + moment(cylinder, of_cylinder) + moment(piston, of_piston), 1e-12);
  const PoseReport report = nominal_report(*mechanism, Pose<double>{{z, phi}});
  EXPECT_NEAR((*report.joints)[1], (B - A).norm(), 1e-15);
  EXPECT_NEAR((*report.J)(1, 0), slide, 1e-12);
  EXPECT_NEAR((*report.J)(1, 1), 0, 1e-12);
}

// Newton-Euler equations of all bodies give the drive forces that virtual work gives.
TEST(FramesOfRobots, HaveForcesInTheirJoints) {
  for (const char* const name : {"3-prs", "3-prs-solved", "h4"}) {
    SCOPED_TRACE(name);
    const auto mechanism = jointed(name);
    ASSERT_TRUE(mechanism->reactions()) << mechanism->why_no_reactions();
    const Json cases = cases_of(name);
    for (const Json& each : cases) {
      const MotionState<double> state{from_json<Pose<double>>(each["pose"]),
                                      from_json<AxisVector<double>>(each["velocity"])};
      const auto acceleration = from_json<AxisVector<double>>(each["acceleration"]);
      const Wrench<double> wrench{{3, -4, 5, 0.6, -0.5, 0.4}};
      const AxisVector<double> tau = drive_forces(dynamics_at(*mechanism, state), acceleration, wrench);
      const Reactions found = mechanism->reactions()->find(
          test::nominal(mechanism->info()), mechanism->info().modes.front(), state, acceleration, wrench);
      for (std::size_t i = 0; i < tau.size(); ++i)
        EXPECT_NEAR(found.drive_forces[i], tau[i], 1e-9 * (1 + std::fabs(tau[i])));
    }
  }
}

}  // namespace
}  // namespace pkm
