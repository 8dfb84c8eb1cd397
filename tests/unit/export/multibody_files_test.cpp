// The writers of URDF, SDF and MJCF files, and what simulation programs require of a model.
#include "engine/export/multibody_files.hpp"

#include <gmock/gmock.h>

#include <Eigen/Geometry>

#include "engine/export/multibody_xml.hpp"
#include "engine/math/eigen_solvers.hpp"

namespace pkm {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;
using ::testing::HasSubstr, ::testing::Not;
using Type = MultibodyModel::JointType;

/// A crank with a thin rod on a universal joint, whose end is closed to the base by a joint of some type.
MultibodyModel crank_and_rod(Type closure) {
  MultibodyModel model;
  model.name = "crank & rod";
  const Matrix3d thin = Vector3d(0.02, 0.02, 0).asDiagonal();
  model.bodies = {{"base"},
                  {"crank of arm", 2, {0, 0, 0.5}, thin, {{{0, 0, 0}, {0, 0, 1}, 0.1}}},
                  {"rod of arm", 1, {0, 0, 1.5}, thin, {{{0, 0, 2}, {0, 0, 2}, 0.05}}}};
  const MultibodyModel::Drive drive{0, 0.25, std::array{-1.0, 2.0}, 40.0, 0.5, 0.125, 3};
  model.tree = {{"arm", Type::revolute, 0, 1, {0, 0, 0}, {{0, 1, 0}}, drive},
                {"arm.C", Type::universal, 1, 2, {0, 0, 1}, {{1, 0, 0}, {0, 1, 0}}}};
  std::vector<Vector3d> axes;
  if (closure == Type::revolute) axes = {{1, 0, 0}};
  if (closure == Type::universal) axes = {{1, 0, 0}, {0, 1, 0}};
  model.closures = {{"arm C", closure, 2, 0, {0, 0, 2}, axes}};
  model.platform = 2;
  model.origin = {0, 0, 2};
  model.pose = {{"x", 0.5}};
  return model;
}

TEST(MultibodyFiles, NamesArePlainAndDistinct) {
  MultibodyModel model = for_simulators(crank_and_rod(Type::ball));
  EXPECT_EQ(model.name, "crank___rod");
  EXPECT_EQ(model.bodies[1].name, "crank_of_arm");
  EXPECT_EQ(model.tree[1].name, "arm_C");
  EXPECT_EQ(model.closures[0].name, "arm_C_2");
}

TEST(MultibodyFiles, InertiaIsPhysicalAndChangesAreNoted) {
  MultibodyModel given = crank_and_rod(Type::ball);
  given.bodies.push_back({"plate", 1, {0, 0, 0}, Matrix3d(Vector3d(0, 0, 0.1).asDiagonal())});
  given.bodies.push_back({"ball", 1, {0, 0, 0}, Matrix3d(Vector3d(0.1, 0.1, 0.1).asDiagonal())});
  given.bodies.push_back({"slide", 0, {0, 0, 0}, Matrix3d(Vector3d(0.1, 0.1, 0.1).asDiagonal())});
  const MultibodyModel model = for_simulators(given);
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    const Vector3d moments =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(Eigen::MatrixXd(model.bodies[i].inertia)).eigenvalues();
    EXPECT_GT(moments[0], 0) << model.bodies[i].name;
    EXPECT_LE(moments[2], moments[0] + moments[1]) << model.bodies[i].name;
  }
  // the total mass is 5 kg, and the farthest joint 2 m from the platform
  EXPECT_DOUBLE_EQ(model.bodies[5].mass, 5e-6);
  EXPECT_NEAR(model.bodies[1].inertia(2, 2), 5e-6 * 2 * 2, 1e-12);
  EXPECT_DOUBLE_EQ(model.bodies[1].inertia(0, 0), 0.02);
  EXPECT_NEAR(model.bodies[3].inertia(2, 2), 0.1, 1e-12);  // the moment with an effect stays
  EXPECT_EQ(model.bodies[4].inertia, given.bodies[4].inertia);
  ASSERT_EQ(model.notes.size(), 1U);
  EXPECT_THAT(model.notes[0], HasSubstr("Masses are at least 5e-06 kg"));
  EXPECT_THAT(model.notes[0], HasSubstr("smaller values for crank_of_arm, rod_of_arm, plate, slide."));
}

TEST(MultibodyFiles, UrdfSplitsUniversalJointsAndKeepsTheClosure) {
  const std::string urdf = urdf_text(crank_and_rod(Type::universal), "a -- b");
  EXPECT_THAT(urdf, HasSubstr("<!-- a - - b. Units are m, kg, s, rad. Reference pose: x = 0.5. -->"));
  EXPECT_THAT(urdf,
              HasSubstr("<joint name=\"arm\" type=\"revolute\"><parent link=\"base\"/><child link=\"crank_of_arm\"/>"
                        "<origin xyz=\"0 0 0\" rpy=\"0 0 0\"/><axis xyz=\"0 1 0\"/><limit lower=\"-1.25\" "
                        "upper=\"1.75\" effort=\"40\" velocity=\"1000000\"/><dynamics damping=\"0.125\" "
                        "friction=\"3\"/></joint>"));
  EXPECT_THAT(
      urdf, HasSubstr("<joint name=\"arm_C_axis_1\" type=\"continuous\"><parent link=\"crank_of_arm\"/><child "
                      "link=\"between_arm_C_1\"/><origin xyz=\"0 0 1\" rpy=\"0 0 0\"/><axis xyz=\"1 0 0\"/></joint>"));
  EXPECT_THAT(urdf,
              HasSubstr("<joint name=\"arm_C_axis_2\" type=\"continuous\"><parent link=\"between_arm_C_1\"/><child "
                        "link=\"rod_of_arm\"/><origin xyz=\"0 0 0\" rpy=\"0 0 0\"/><axis xyz=\"0 1 0\"/></joint>"));
  EXPECT_THAT(
      urdf,
      HasSubstr("<constraint name=\"arm_C_2\" type=\"universal\"><parent link=\"rod_of_arm\"/>"
                "<parent_origin xyz=\"0 0 1\" rpy=\"0 0 0\"/><parent_axis xyz=\"1 0 0\"/><child "
                "link=\"base\"/><child_origin xyz=\"0 0 2\" rpy=\"0 0 0\"/><child_axis xyz=\"0 1 0\"/></constraint>"));
  EXPECT_THAT(urdf, HasSubstr("cannot express the inertia of the drive trains"));
  EXPECT_THAT(urdf, HasSubstr("<sphere radius=\"0.05\"/>"));
}

TEST(MultibodyFiles, YamlHasClosuresAndPositions) {
  EXPECT_THAT(
      loop_closures_yaml(crank_and_rod(Type::ball), "f.urdf", "title"),
      HasSubstr("robot: \"crank___rod\"\nreference_pose:\n  \"x\": 0.5\ndrives:\n  - {joint: \"arm\", "
                "position_at_zero: 0.25}\nloop_closures:\n  - name: \"arm_C_2\"\n    type: spherical\n    parent: "
                "\"rod_of_arm\"\n    parent_point: [0, 0, 1]\n    child: \"base\"\n    child_point: [0, 0, 2]\n"));
}

TEST(MultibodyFiles, SdfClosesLoopsByJoints) {
  const std::string sdf = sdf_text(crank_and_rod(Type::revolute), "title");
  EXPECT_THAT(
      sdf, HasSubstr("<joint name=\"arm_C\" type=\"universal\"><parent>crank_of_arm</parent><child>rod_of_arm</child>"
                     "<pose>0 0 0 0 0 0</pose><axis><xyz>1 0 0</xyz></axis><axis2><xyz>0 1 0</xyz></axis2></joint>"));
  EXPECT_THAT(sdf,
              HasSubstr("<joint name=\"arm_C_2\" type=\"continuous\"><parent>rod_of_arm</parent><child>base</child>"
                        "<pose>0 0 2 0 0 0</pose><axis><xyz>1 0 0</xyz></axis></joint>"));
  EXPECT_THAT(sdf,
              HasSubstr("<limit><lower>-1.25</lower><upper>1.75</upper><effort>40</effort></limit><dynamics><damping>"
                        "0.125</damping><friction>3</friction></dynamics>"));
  EXPECT_THAT(sdf, HasSubstr("drives of the mechanism are at arm = 0.25."));
}

TEST(MultibodyFiles, MjcfHasThePositionsOfTheMechanism) {
  const std::string mjcf = mjcf_text(crank_and_rod(Type::ball), "title");
  EXPECT_THAT(
      mjcf, HasSubstr("<joint name=\"arm\" type=\"hinge\" axis=\"0 1 0\" ref=\"0.25\" limited=\"true\" range=\"-1 2\" "
                      "armature=\"0.5\" damping=\"0.125\" frictionloss=\"3\"/>"));
  EXPECT_THAT(mjcf, HasSubstr("<motor name=\"arm\" joint=\"arm\" ctrllimited=\"true\" ctrlrange=\"-40 40\"/>"));
  EXPECT_THAT(mjcf, HasSubstr("<connect name=\"arm_C_2\" body1=\"rod_of_arm\" anchor=\"0 0 1\"/>"));
  EXPECT_THAT(mjcf, Not(HasSubstr("between_")));
}

TEST(MultibodyFiles, MjcfClosesRevoluteJointsByTwoPoints) {
  const std::string mjcf = mjcf_text(crank_and_rod(Type::revolute), "title");
  EXPECT_THAT(mjcf, HasSubstr("<connect name=\"arm_C_2\" body1=\"rod_of_arm\" anchor=\"0 0 1\"/>"));
  EXPECT_THAT(mjcf, HasSubstr("<connect name=\"arm_C_2_axis\" body1=\"rod_of_arm\" anchor=\"0.5 0 1\"/>"));
}

TEST(MultibodyFiles, MjcfClosesUniversalJointsByABodyBetween) {
  const std::string mjcf = mjcf_text(crank_and_rod(Type::universal), "title");
  EXPECT_THAT(mjcf, HasSubstr("<body name=\"between_arm_C_2\" pos=\"0 0 1\">"));
  EXPECT_THAT(mjcf, HasSubstr("<joint name=\"arm_C_2_axis_1\" type=\"hinge\" axis=\"1 0 0\"/>"));
  EXPECT_THAT(mjcf, HasSubstr("<connect name=\"arm_C_2\" body1=\"between_arm_C_2\" anchor=\"0 0 0\"/>"));
  EXPECT_THAT(mjcf, HasSubstr("<connect name=\"arm_C_2_axis\" body1=\"between_arm_C_2\" anchor=\"0 0.5 0\"/>"));
}

TEST(MultibodyFiles, RollPitchYawAreThoseOfTheRotation) {
  const auto about = [](double angle, const Vector3d& axis) { return Eigen::AngleAxisd(angle, axis).matrix(); };
  for (const Vector3d& rpy : {Vector3d(0.3, -0.4, 2.5), Vector3d(0.3, std::acos(0.0), 0)}) {
    const Matrix3d R =
        about(rpy[2], Vector3d::UnitZ()) * about(rpy[1], Vector3d::UnitY()) * about(rpy[0], Vector3d::UnitX());
    EXPECT_LE((roll_pitch_yaw(R) - rpy).norm(), 1e-12) << rpy.transpose();
  }
}

}  // namespace
}  // namespace pkm
