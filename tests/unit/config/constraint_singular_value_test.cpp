// The quantity `constraint_singular_value`: values against the wrenches that are reciprocal to the joints, a constraint
// singularity, and reasons why it is undefined.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "tests/unit/config/mechanism_text.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm::constraint_singular_value_test {
namespace {

using test::quantity_at, test::read_robot, test::substituted, test::why_undefined;
using ::testing::HasSubstr;
using Robot = std::shared_ptr<const Mechanism>;

// The smallest singular value of the powers of the constraint wrenches, which are computed here as the null space of
// the twists of all joints of a limb.
TEST(ConstraintSingularValue, IsThatOfTheWrenchesReciprocalToTheJoints) {
  using Twist = Eigen::Matrix<double, 6, 1>;
  const auto revolute = [](const Eigen::Vector3d& at, const Eigen::Vector3d& axis) {
    Twist t;
    t << at.cross(axis), axis;
    return t;
  };
  const auto slide = [](const Eigen::Vector3d& along) {
    Twist t;
    t << along, Eigen::Vector3d::Zero();
    return t;
  };
  const Eigen::Vector3d O(0.05, -0.02, 0.6), e_z = Eigen::Vector3d::UnitZ();
  const auto text = [](const std::string& limb) {
    return "[mechanism]\nname = \"upu\"\n[parameters]\nR = { default = 0.3, min = 0.1, max = 1, unit = \"m\" }\n"
           "[platform]\ncoordinates = { x = \"along x\", y = \"along y\", z = \"along z\" }\n"
           "characteristic_length = 1\n[survey]\nbox = { x = [-0.2, 0.2], y = [-0.2, 0.2], z = [0.4, 0.7] }\n"
           "[[limb]]\nname = \"leg\"\ncopies = { number = 3, about = \"z\" }\ndrive = \"chain\"\n"
           "base = [\"R\", 0, 0]\nplatform = [0.1, 0, 0]\n" +
           limb;
  };
  const std::vector<std::pair<std::string, std::string>> chains = {
      {"UPU", "chain = [\"U\", \"P\", \"U\"]\naxes = [[0.6, 0.8, 0.3]]\n"},
      {"PUU", "chain = [\"P\", \"U\", \"U\"]\naxes = [[0, 0, 1], [0.6, 0.8, 0.3]]\nlinks = [0.5]\nbranch = \"-\"\n"},
      {"RUU",
       "chain = [\"R\", \"U\", \"U\"]\naxes = [[0, 1, 0], [0.6, 0.8, 0.3]]\nzero = [1, 0, 0]\nlinks = [0.4, 0.6]\n"
       "branch = \"-\"\n"}};
  for (const auto& [chain, limb] : chains) {
    std::string ends;
    for (const char* const leg : {"1", "2", "3"})
      for (const char* const axis : {"x", "y", "z"})
        ends +=
            std::string("[[quantity]]\nname = \"c") + leg + axis + "\"\nformula = \"leg" + leg + ".C." + axis + "\"\n";
    const Robot robot = read_robot(text(limb) + ends);
    const Pose<double> pose{{O[0], O[1], O[2]}};
    Eigen::MatrixXd powers(3, 3);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Matrix3d turn = Eigen::AngleAxisd(2 * kPi * k / 3, e_z).toRotationMatrix();
      const Eigen::Vector3d A = turn * Eigen::Vector3d(0.3, 0, 0) - O, B = turn * Eigen::Vector3d(0.1, 0, 0);
      const Eigen::Vector3d a = turn * Eigen::Vector3d(0.6, 0.8, 0.3).normalized();
      const std::string end = "c" + std::to_string(k + 1);
      const Eigen::Vector3d C =
          Eigen::Vector3d(quantity_at(*robot, end + "x", pose), quantity_at(*robot, end + "y", pose),
                          quantity_at(*robot, end + "z", pose)) -
          O;
      const Eigen::Vector3d rod = B - C;
      Eigen::MatrixXd twists(6, 5);
      twists << revolute(C, a), revolute(C, a.cross(rod)), revolute(B, a), revolute(B, a.cross(rod)),
          chain == "UPU"   ? slide(rod)
          : chain == "PUU" ? slide(e_z)
                           : revolute(A, turn * Eigen::Vector3d(0, 1, 0));
      const Eigen::MatrixXd null = Eigen::JacobiSVD<Eigen::MatrixXd>(twists.transpose(), Eigen::ComputeFullV).matrixV();
      Eigen::Matrix<double, 6, 1> wrench = null.col(5);  // force, moment about the origin of the platform
      const Eigen::Vector3d f = wrench.head<3>(), m = wrench.tail<3>(), at_B = m - B.cross(f);
      powers.row(k) = m.transpose() / std::sqrt(f.squaredNorm() + at_B.squaredNorm());
    }
    const double expected = Eigen::JacobiSVD<Eigen::MatrixXd>(powers).singularValues()[2];
    EXPECT_NEAR(quantity_at(*robot, "constraint_singular_value", pose), expected, 1e-8) << chain;
  }
}

// Di Gregorio and Parenti-Castelli 2002: a 3-UPU of translations has a constraint singularity where the couples, normal
// to both axes of the universal joints, are coplanar.
TEST(ConstraintSingularValue, VanishesAtAConstraintSingularity) {
  const Robot delta = read_robot(test::text_of_mechanism("rotary-delta"));
  EXPECT_GT(quantity_at(*delta, "constraint_singular_value", {{0, 0, -0.5}}), 0.1);
  // rods that are parallel to each other: the pairs of a Delta whose joints have the same radius, with cranks and rods
  // in vertical planes, prevent only the rotations about horizontal axes
  const Robot straight =
      read_robot(substituted(test::text_of_mechanism("linear-delta"), "base *= \\[\"R\"", "base = [\"r\""));
  EXPECT_NEAR(quantity_at(*straight, "constraint_singular_value", {{0, 0, -0.1}}), 0, 1e-7);
}

TEST(ConstraintSingularValue, IsUndefinedWithReasons) {
  const auto why = [](const std::string& text) {
    return why_undefined(*read_robot(text), "constraint_singular_value");
  };
  EXPECT_EQ(why(test::text_of_mechanism("gough")), "the coordinates are all six motions of a rigid body");
  EXPECT_EQ(why(test::text_of_mechanism("3-rrr")),
            "all limbs move in parallel planes, so that the constraints are always regular");
  EXPECT_EQ(why(test::text_of_mechanism("chains/agile-eye")),
            "the constraints of the limbs have the same rank at every pose");
  EXPECT_EQ(why(substituted(test::text_of_mechanism("rotary-delta"), "\npair [^\n]*", "")),
            "the joints of the limbs transmit 0 constraint forces and couples, but 3 motions are not among the "
            "coordinates");
  EXPECT_THAT(why(test::text_of_mechanism("par4")), HasSubstr("does not connect the base with the platform"));
  EXPECT_THAT(why(test::text_of_mechanism("4ppa-2par")), HasSubstr("are given by formulas"));
  EXPECT_THAT(why(test::text_of_file(PKM_TEST_DATA "/robots/crank-and-slide.toml")),
              HasSubstr("limb slide has neither `rod` nor `links`"));
}

}  // namespace
}  // namespace pkm::constraint_singular_value_test
