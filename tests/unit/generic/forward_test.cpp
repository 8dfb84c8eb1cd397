// Forward kinematics of mechanism files: distinct rigid-body poses, their mirror images, and the twist Jacobian.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "engine/geometry/influence.hpp"
#include "engine/math/random.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm::forward_of_files {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

/// A rigid-body pose of a platform whose coordinates are x, y, z and three angles.
struct Placed {
  Vector3d position;
  Matrix3d rotation;
};

/// @param axes  of the angles, "xyz"
Placed placed(const Pose<double>& pose, const std::string& axes) {
  Placed at{{pose[0], pose[1], pose[2]}, Matrix3d::Identity()};
  for (std::size_t k = 0; k < 3; ++k)
    at.rotation = at.rotation * Eigen::AngleAxisd(pose[3 + k], Vector3d::Unit(axes[k] - 'x')).toRotationMatrix();
  return at;
}
double distance(const Placed& a, const Placed& b) {
  return std::fmax((a.position - b.position).norm(), (a.rotation - b.rotation).norm());
}

/// gough.toml with its angles about other axes.
std::shared_ptr<const Mechanism> gough_about(const std::string& axes) {
  std::string text = test::text_of_mechanism("gough");
  const std::string given = "alpha = \"about x\", beta = \"about y\", gamma = \"about z\"";
  const auto at = text.find(given);
  if (at == std::string::npos) return nullptr;
  text.replace(at, given.size(),
               std::string("alpha = \"about ") + axes[0] + "\", beta = \"about " + axes[1] + "\", gamma = \"about " +
                   axes[2] + "\"");
  return read_mechanism_toml(text, "gough-" + axes + ".toml");
}

std::vector<double> defaults(const MechanismInfo& info) { return test::design_with(info, nlohmann::json::object()); }

/// Checks what any list of poses of Gough's platform has to be. @return  the list
std::vector<Placed> checked(const Mechanism& gough, const AxisVector<double>& joints, const std::string& axes) {
  const std::vector<double> design = defaults(gough.info());
  std::vector<Placed> all;
  for (const AssemblyMode& mode : gough.forward()->assemblies(design, joints)) {
    const auto found = gough.inspect(design, mode.pose, "", no_limits(gough.info())).joints;
    for (std::size_t i = 0; i < joints.size(); ++i) EXPECT_NEAR((*found)[i], joints[i], 1e-9);
    const double least = axes[0] == axes[2] ? 0 : -kPi / 2, greatest = axes[0] == axes[2] ? kPi : kPi / 2;
    EXPECT_GE(mode.pose[4], least - 1e-9) << axes;
    EXPECT_LE(mode.pose[4], greatest + 1e-9) << axes;
    const Placed one = placed(mode.pose, axes);
    for (const Placed& other : all) EXPECT_GT(distance(one, other), 1e-5) << axes;
    all.push_back(one);
  }
  return all;
}

TEST(ForwardOfFiles, ListsRigidPosesAndNoTripleOfAnglesTwice) {
  const Mechanism& gough = *test::described("gough");
  // left1, left2, left3, right1, right2, right3, as a user had them
  const AxisVector<double> joints = {1.1456153162831684, 1.3826721670268600, 1.383789063119757,
                                     1.427947184023169,  1.5712485447307782, 1.423278191584543};
  EXPECT_EQ(checked(gough, joints, "xyz").size(), 8u);
  EXPECT_FALSE(gough.forward()->guarantee().is_complete);
}

/// Base and platform are planar, so that the mirror image in the base's plane has the same legs.
TEST(ForwardOfFiles, HasMirrorImagesForEveryOrderOfAxes) {
  const Matrix3d S = Vector3d(1, 1, -1).asDiagonal();
  std::size_t compared = 0;
  for (const std::string axes : {"xyz", "xzy", "yxz", "yzx", "zxy", "zyx", "xyx", "xzx", "yxy", "yzy", "zxz", "zyz"}) {
    SCOPED_TRACE(axes);
    const auto gough = gough_about(axes);
    ASSERT_TRUE(gough);
    Stream random(7, 0, static_cast<unsigned>(compared), Stream::Use::start);
    const auto within = [&random](double from, double to) { return from + (to - from) * random.u01(); };
    const Pose<double> pose = {within(-0.5, 0.5), within(-0.5, 0.5), within(0.9, 1.3),
                               within(0.3, 0.7),  within(0.2, 0.7),  -0.6};
    const auto joints = gough->inspect(defaults(gough->info()), pose, "", no_limits(gough->info())).joints;
    const std::vector<Placed> found = checked(*gough, *joints, axes);
    const auto has = [&found](const Placed& wanted) {
      return std::ranges::any_of(found, [&](const Placed& one) { return distance(one, wanted) < 1e-7; });
    };
    EXPECT_TRUE(has(placed(pose, axes)));
    for (const Placed& one : found) EXPECT_TRUE(has({S * one.position, S * one.rotation * S}));
    compared += found.size();
  }
  EXPECT_GE(compared, 24u);
}

/// In a plane the mirror is a line: base joints on one, platform joints on another.
TEST(ForwardOfFiles, HasMirrorImagesInAPlane) {
  std::string text =
      "[mechanism]\nname = \"lines\"\n[parameters]\nb = { default = \"1 m\", min = 0, max = \"9 m\" }\n[platform]\n"
      "coordinates = { x = \"along x\", y = \"along y\", phi = \"about z\" }\ncharacteristic_length = \"b\"\n"
      "[survey]\nfixed = { phi = 0 }\nsweep = [\"x\", \"y\"]\nbox = { x = [0.2, 0.4], y = [0.5, 0.7], phi = [-0.1, "
      "0.1] }\n";
  for (const std::string leg : {"0, 0.1, -0.2", "1, 0.3, 0.1", "2, 0.5, 0.2"})
    text += "[[limb]]\nname = \"leg" + leg.substr(0, 1) + "\"\ndrive = \"telescope\"\nbase = [\"" + leg.substr(3, 3) +
            "*b\", 0.2, 0]\nplatform = [\"" + leg.substr(8) + "*b\", 0, 0]\n";
  const auto lines = read_mechanism_toml(text, "lines.toml");
  const std::vector<double> design = defaults(lines->info());
  const Pose<double> pose = {0.3, 0.6, 0.05};
  const auto joints = lines->inspect(design, pose, "", no_limits(lines->info())).joints;
  const auto found = lines->forward()->assemblies(design, *joints);
  const auto has = [&found](double x, double y, double phi) {
    return std::ranges::any_of(found, [&](const AssemblyMode& one) {
      return std::fabs(one.pose[0] - x) + std::fabs(one.pose[1] - y) + std::fabs(one.pose[2] - phi) < 1e-7;
    });
  };
  EXPECT_TRUE(has(0.3, 0.6, 0.05));
  for (const AssemblyMode& one : found) EXPECT_TRUE(has(one.pose[0], 0.4 - one.pose[1], -one.pose[2]));
  EXPECT_GE(found.size(), 2u);
}

TEST(ForwardOfFiles, NearAPoseKeepsItsAngles) {
  const Mechanism& gough = *test::described("gough");
  const std::vector<double> design = defaults(gough.info());
  const Pose<double> pose = {0.1, -0.05, 1.2, 0.1 - kPi, kPi - 0.2, 0.3 - kPi};
  const auto joints = gough.inspect(design, pose, "", no_limits(gough.info())).joints;
  const auto found = gough.forward()->assemblies_near(design, *joints, pose);
  ASSERT_EQ(found.size(), 1u);
  for (std::size_t i = 0; i < pose.size(); ++i) EXPECT_NEAR(found[0].pose[i], pose[i], 1e-9);
}

/// Angles about x, y, z of a rotation, the second in (-pi/2, pi/2).
Vector3d angles_of(const Matrix3d& R) {
  return {std::atan2(-R(1, 2), R(2, 2)), std::asin(R(0, 2)), std::atan2(-R(0, 1), R(0, 0))};
}

TEST(TwistJacobian, IsTheDerivativeOfTheJointsByTwistsAndByRates) {
  const Mechanism& gough = *test::described("gough");
  const std::vector<double> design = defaults(gough.info());
  const auto joints = [&](const Pose<double>& pose) {
    return *gough.inspect(design, pose, "", no_limits(gough.info())).joints;
  };
  constexpr double h = 1e-6;
  double parting = 0;
  for (unsigned k = 0; k < 20; ++k) {
    Stream random(11, 0, k, Stream::Use::start);
    Pose<double> pose(6);
    for (double& x : pose) x = random.u01() - 0.5;
    pose[2] += 1.3;
    const PoseReport report = gough.inspect(design, pose, "", no_limits(gough.info()));
    ASSERT_TRUE(report.J && report.T);
    const auto J_twist = twist_jacobian(*report.J, *report.T);
    ASSERT_TRUE(J_twist);
    const Placed at = placed(pose, "xyz");
    for (std::size_t j = 0; j < 6; ++j) {
      const auto by_rate = [&](double step) {
        Pose<double> moved = pose;
        moved[j] += step;
        return joints(moved);
      };
      const auto by_twist = [&](double step) {
        Placed moved = at;
        if (j < 3) moved.position[static_cast<Eigen::Index>(j)] += step;
        if (j >= 3)
          moved.rotation =
              Eigen::AngleAxisd(step, Vector3d::Unit(static_cast<Eigen::Index>(j) - 3)).toRotationMatrix() *
              at.rotation;
        const Vector3d& p = moved.position;
        const Vector3d angles = angles_of(moved.rotation);
        return joints({p[0], p[1], p[2], angles[0], angles[1], angles[2]});
      };
      const auto rates = (by_rate(h) - by_rate(-h)) * (0.5 / h), twists = (by_twist(h) - by_twist(-h)) * (0.5 / h);
      for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_NEAR((*report.J)(i, j), rates[i], 1e-8);
        EXPECT_NEAR((*J_twist)(i, j), twists[i], 1e-8);
        parting = std::fmax(parting, std::fabs((*report.J)(i, j) - (*J_twist)(i, j)));
      }
    }
  }
  EXPECT_GT(parting, 0.1) << "rates of angles are not the angular velocity";
}

TEST(TwistJacobian, OfAPlanarMechanismHasTheColumnsOfItsTwist) {
  const Mechanism& planar = *test::described("3-rpr");
  const std::vector<double> design = defaults(planar.info());
  const Pose<double> pose = {0.5, 0.3, 0.1};
  const PoseReport report = planar.inspect(design, pose, "", no_limits(planar.info()));
  ASSERT_TRUE(report.J && report.T);
  const auto J_twist = twist_jacobian(*report.J, *report.T);
  ASSERT_TRUE(J_twist);
  constexpr double h = 1e-6;
  const std::array<std::size_t, 3> moving = {0, 1, 5};  // vx, vy, wz
  for (std::size_t j = 0; j < 3; ++j) {
    Pose<double> more = pose, less = pose;
    more[j] += h;
    less[j] -= h;
    const auto q_more = planar.inspect(design, more, "", no_limits(planar.info())).joints,
               q_less = planar.inspect(design, less, "", no_limits(planar.info())).joints;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR((*report.J)(i, j), ((*q_more)[i] - (*q_less)[i]) / (2 * h), 1e-8);
      EXPECT_NEAR((*J_twist)(i, moving[j]), (*report.J)(i, j), 1e-14);
    }
  }
  for (const std::size_t fixed : {2u, 3u, 4u})
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ((*J_twist)(i, fixed), 0);
}

TEST(TwistJacobian, IsAbsentWhereAnglesAreSingular) {
  const Mechanism& gough = *test::described("gough");
  const PoseReport report =
      gough.inspect(defaults(gough.info()), {0, 0, 1.3, 0.1, kPi / 2, 0.2}, "", no_limits(gough.info()));
  ASSERT_TRUE(report.J && report.T);
  EXPECT_FALSE(twist_jacobian(*report.J, *report.T));
}

}  // namespace
}  // namespace pkm::forward_of_files
