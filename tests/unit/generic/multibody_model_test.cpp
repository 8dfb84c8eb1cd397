// Multibody models of mechanism files: spanning tree, loop closures, drives, and refusals.
#include "engine/generic/multibody_model.hpp"

#include <gmock/gmock.h>

#include "tests/multibody/cases.hpp"

namespace pkm::generic {
namespace {

using ::testing::HasSubstr;
using Type = MultibodyModel::JointType;

std::size_t count(const std::vector<MultibodyModel::Joint>& joints, Type type) {
  return static_cast<std::size_t>(std::ranges::count(joints, type, &MultibodyModel::Joint::type));
}

TEST(MultibodyModel, DeltaHasThreeCranksSixRodsAndClosesLoopsAtBallJoints) {
  const MultibodyModel model = test::NominalDesign("rotary-delta").model();
  EXPECT_EQ(model.bodies.size(), 11U);
  EXPECT_EQ(count(model.tree, Type::revolute), 3U);
  EXPECT_EQ(count(model.tree, Type::universal), 6U);
  EXPECT_EQ(count(model.tree, Type::ball), 1U);
  EXPECT_EQ(count(model.closures, Type::ball), 5U);
  EXPECT_EQ(model.closures.size(), 5U);
  std::vector<bool> reached(model.bodies.size());
  reached[0] = true;
  double mass = 0;
  for (const auto& joint : model.tree) {
    EXPECT_TRUE(reached[joint.parent]);
    EXPECT_FALSE(reached[joint.child]);
    reached[joint.child] = true;
    mass += model.bodies[joint.child].mass;
  }
  // cranks: aluminium tubes, 30 mm by 26 mm, of 200 mm; pairs of rods: 0.12 kg/m of 500 mm; platform
  EXPECT_NEAR(mass, 3 * 2700 * kPi / 4 * (0.03 * 0.03 - 0.026 * 0.026) * 0.2 + 3 * 0.12 * 0.5 + 0.25, 1e-12);
  ASSERT_TRUE(model.tree[0].drive && model.tree[0].drive->range);
  EXPECT_EQ(model.tree[0].name, "arm1");
  EXPECT_DOUBLE_EQ((*model.tree[0].drive->range)[1], 95 * kPi / 180);
}

TEST(MultibodyModel, LegsAreDrawnHalfOnEachOfTheirBodies) {
  const MultibodyModel model = test::NominalDesign("gough").model();
  for (const auto& joint : model.tree)
    if (joint.type == Type::prismatic) {
      EXPECT_EQ(model.bodies[joint.parent].shapes.size(), 1U);
      EXPECT_EQ(model.bodies[joint.child].shapes.size(), 1U);
    }
  EXPECT_TRUE(model.notes.empty());
}

TEST(MultibodyModel, MiddlePlatformKeepsItsInertia) {  // which has no effect, because it does not rotate
  const MultibodyModel model = test::NominalDesign("3crr-r-cru").model();
  const auto body = std::ranges::find(model.bodies, "middle platform", &MultibodyModel::Body::name);
  ASSERT_NE(body, model.bodies.end());
  EXPECT_NEAR(body->inertia(0, 0), 3.376e-05, 1e-15);
}

/// Why a changed mechanism file has no model at a pose.
std::string refusal(std::string text, const std::string& from, const std::string& to, const Pose<double>& pose) {
  const auto at = text.find(from);
  if (at == std::string::npos) return "'" + from + "' is not in the file";
  const auto mechanism = read_mechanism_toml(text.replace(at, from.size(), to), "changed.toml");
  std::vector<double> design;
  for (const Parameter& p : mechanism->info().parameters) design.push_back(p.nominal);
  try {
    multibody_model(*mechanism, design, pose, mechanism->info().modes.front());
  } catch (const std::invalid_argument& reason) {
    return reason.what();
  }
  return "";
}

TEST(MultibodyModel, RefusesWhatIsNotDescribed) {
  const std::string delta = test::text_of_mechanism("rotary-delta");
  EXPECT_EQ(refusal(delta, "mass = \"0.25 kg\"", "mass = \"0.25 kg\"", {0, 0, -0.45}), "");
  EXPECT_THAT(refusal(delta, "pair  ", "#pair", {0, 0, -0.45}), HasSubstr("give `pair` for rods in pairs"));
  EXPECT_THAT(refusal(delta, "R  ", "R  ", {0, 0, -4.5}), HasSubstr("reference pose does not assemble: "));
  const std::string sliders = test::text_of_mechanism("4ppa-2par");
  EXPECT_THAT(refusal(sliders, "along  = [0, 1, 0]\ndrive  = \"q2\"", "along  = [0, -1, 0]\ndrive  = \"q2\"",
                      {0.25, 0.85, -0.8, 0.5}),
              HasSubstr("the drive q2 does not move as its joint"));
  EXPECT_THAT(refusal(sliders, "at     = [0, \"y_1\", \"c_1 - d_d\"]", "at     = [0, \"y_1\", \"z - d_d\"]",
                      {0.25, 0.85, -0.8, 0.5}),
              HasSubstr("the joint c12 does not move with "));
  EXPECT_EQ(
      why_no_multibody_model(*test::described("par4")),
      "limb arm1 ends at `end`, but the body there is unknown; give end_on = \"platform\" or the name of a [[body]]");
}

TEST(MultibodyModel, RefusesJointsThatAllowOtherMotionsThanTheCoordinates) {
  // the pair of the limb along z is normal to y, as that of the limb along x, so that none prevents rotation about y
  const std::string text = test::text_of_mechanism("orthoglide");
  EXPECT_THAT(refusal(text, "along = [1, 0, 0]", "along = [0, 1, 0]", {0, 0, 0}),
              HasSubstr("4 degrees of freedom at this pose, but the platform has 3 coordinates"));
}

TEST(MultibodyModel, UniversalJointsAreThoseOfTheFile) {
  // Tsai's 3-UPU mechanism: with tangential axes at base and platform, the platform translates
  const auto mechanism = read_mechanism_toml(R"(
[mechanism]
name = "3-upu"
[parameters]
R = { default = "0.5 m", min = "0.1 m", max = "1 m" }
[platform]
coordinates = { x = "along x", y = "along y", z = "along z" }
mass = "2 kg"
[[limb]]
name      = "leg"
copies    = { number = 3, about = "z" }
drive     = "telescope"
base      = ["R", 0, 0]
platform  = ["R/2", 0, 0]
universal = [0, 1, 0]
cylinder_mass   = "2 kg"
cylinder_centre = "0.2 m"
)",
                                             "3-upu.toml");
  const std::vector<double> design = {0.5};
  const MultibodyModel model = multibody_model(*mechanism, design, {0.05, 0.02, 0.6}, mechanism->info().modes.front());
  EXPECT_EQ(count(model.tree, Type::universal), 4U);
  EXPECT_EQ(count(model.closures, Type::universal), 2U);
  const auto joint = std::ranges::find(model.tree, "leg1.A", &MultibodyModel::Joint::name);
  ASSERT_NE(joint, model.tree.end());
  EXPECT_LE((joint->axes[0] - Eigen::Vector3d(0, 1, 0)).norm(), 1e-12);  // on the base
  EXPECT_NEAR(joint->axes[1].dot(Eigen::Vector3d(0.05 - 0.25, 0.02, 0.6)), 0, 1e-12);
}

}  // namespace
}  // namespace pkm::generic
