// Transmission indices of mechanism files against closed forms and published poses.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "engine/workspace/pose_quantities.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"

namespace pkm {
namespace {

struct Indices {
  double lti, input, output;
};

/// Values of the quantities at a pose.
Indices indices_at(const Mechanism& mechanism, const std::vector<double>& design, const Pose<double>& pose,
                   const std::string& mode) {
  const MechanismInfo& info = mechanism.info();
  const PoseReport report = mechanism.inspect(design, pose, mode, no_limits(info));
  const auto value = [&](const std::string& name) {
    const auto at = std::ranges::find(info.quantities, name, &QuantityInfo::name);
    return report.quantities.at(static_cast<std::size_t>(at - info.quantities.begin()));
  };
  return {value("lti"), value("lti_input"), value("lti_output")};
}

struct Reference {
  const char* mechanism;
  nlohmann::json design;
  std::vector<double> pose;
  double input, output;
};

/// Computed from the closed forms of planar and translational mechanisms by a program of its own. The second pose is
/// one of an ABB IRB 340 (R. L. Williams II, "The Delta parallel robot", Ohio University), turned by 90 deg about z;
/// the corners of the Orthoglide are those of its published design rule (Chablat and Wenger 2003).
const std::vector<Reference> kReferences = {
    {"rotary-delta", nlohmann::json::object(), {0.1, 0, -0.5}, .982264603, .841090820},
    {"rotary-delta",
     {{"R", std::sqrt(3) / 6 * .567}, {"r", std::sqrt(3) / 3 * .076}, {"l_a", .524}, {"l_b", 1.244}},
     {-.5, .3, -1.1},
     .8613811,
     .6650402},
    {"orthoglide",
     {{"L", .31}},
     {-.31 / std::sqrt(6), -.31 / std::sqrt(6), -.31 / std::sqrt(6)},
     .816496581,
     .492365964},
    {"orthoglide",
     {{"L", .31}},
     {.31 / std::sqrt(18), .31 / std::sqrt(18), .31 / std::sqrt(18)},
     .942809042,
     .710669055},
    {"orthoglide", {{"L", .31}}, {0, 0, 0}, 1, 1},
    {"five-bar", {{"d", .1375}, {"l_a", .23}, {"l_b", .23}}, {0, .3}, .999568913, .674757167},
    {"five-bar", {{"d", .1375}, {"l_a", .23}, {"l_b", .23}}, {0, .25}, .973056986, .326361634},
    {"five-bar", {{"d", .1375}, {"l_a", .23}, {"l_b", .23}}, {.1, .3}, .923415419, .78674775},
    {"3-rrr", {{"R", .5}, {"r", .15}, {"l_a", .3}, {"l_b", .35}}, {.02, -.05, .1}, .856347718, .940473648},
};

TEST(Transmission, HasTheReferenceValues) {
  for (const Reference& reference : kReferences) {
    const Mechanism& mechanism = *test::described(reference.mechanism);
    SCOPED_TRACE(std::string(reference.mechanism) + " at " + std::to_string(reference.pose[0]));
    const std::vector<double> design = test::design_with(mechanism.info(), reference.design);
    Pose<double> pose(mechanism.info().coordinates.size());
    std::ranges::copy(reference.pose, pose.begin());
    std::string mode = mechanism.info().modes.front();
    if (mechanism.info().name == "3-rrr") mode = "+,+,+";
    const Indices found = indices_at(mechanism, design, pose, mode);
    const double digits = reference.output == .6650402 ? 5e-8 : 2e-9;
    EXPECT_NEAR(found.input, reference.input, digits);
    EXPECT_NEAR(found.output, reference.output, digits);
    EXPECT_EQ(found.lti, std::min(found.input, found.output));
  }
}

struct LimbReference {
  const char* mechanism;
  nlohmann::json design;
  std::vector<double> pose;
  std::vector<double> angles, input,
      output;  ///< by limb: of the cranks [deg], or empty; transmission indices, or empty
  double digits = 1e-9;
};

/// The same sources, by limb. The limbs of the ABB IRB 340 are at -90, 30 and 150 deg there, and its angles at the
/// first pose are the published ones, -20.5 deg; here they are at 0, 120 and 240 deg. The 3-RRR's limbs are at 90, 210
/// and 330 deg there: its pose (.05, .02) is (.02, -.05) here, and 90 deg are subtracted from its crank angles.
TEST(Transmission, HasTheReferenceValuesOfEachLimb) {
  const nlohmann::json five_bar = {{"d", .1375}, {"l_a", .23}, {"l_b", .23}},
                       irb_340 = {{"R", std::sqrt(3) / 6 * .567},
                                  {"r", std::sqrt(3) / 3 * .076},
                                  {"l_a", .524},
                                  {"l_b", 1.244}},
                       three_rrr = {{"R", .5}, {"r", .15}, {"l_a", .3}, {"l_b", .35}};
  const std::vector<LimbReference> references = {
      {"five-bar", five_bar, {0, .3}, {109.535223, 70.464777}, {.999568913, .999568913}, {.674757167, .674757167}},
      {"five-bar", five_bar, {0, .25}, {112.854368, 67.145632}, {.973056986, .973056986}, {.326361634, .326361634}},
      {"five-bar", five_bar, {.1, .3}, {85.347822, 48.215439}, {.923415419, .990702413}, {.78674775, .78674775}},
      {"rotary-delta",
       nlohmann::json::object(),
       {0, 0, -.5},
       {34.116052, 34.116052, 34.116052},
       {.996164520, .996164520, .996164520},
       {.876938493, .876938493, .876938493}},
      {"rotary-delta",
       nlohmann::json::object(),
       {.1, 0, -.5},
       {},
       {.982264603, .984171606, .984171606},
       {.892441203, .841090820, .841090820}},
      {"rotary-delta", irb_340, {0, 0, -.9}, {-20.54728, -20.54728, -20.54728}, {}, {}},
      {"rotary-delta",
       irb_340,
       {-.5, .3, -1.1},
       {47.50405, -11.56855, 21.37839},
       {.96469944, .92915288, .8613811},
       {.6650402, .74891493, .6811163},
       5e-8},
      {"3-rrr", three_rrr, {0, 0, 0}, {}, {.903507903, .903507903, .903507903}, {.964866624, .964866624, .964866624}},
      {"3-rrr",
       three_rrr,
       {.02, -.05, .1},
       {},
       {.874439925, .972704598, .856347718},
       {.940473648, .964460055, .999672541}},
  };
  for (const LimbReference& reference : references) {
    const Mechanism& mechanism = *test::described(reference.mechanism);
    const MechanismInfo& info = mechanism.info();
    SCOPED_TRACE(std::string(reference.mechanism) + " at " + std::to_string(reference.pose[0]));
    const std::vector<double> design = test::design_with(info, reference.design);
    Pose<double> pose(reference.pose.size());
    std::ranges::copy(reference.pose, pose.begin());
    const std::string mode = info.name == "3-rrr" ? "+,+,+" : info.modes.front();
    const PoseReport report = mechanism.inspect(design, pose, mode, no_limits(info));
    const auto value = [&](const std::string& name) {
      const auto found = std::ranges::find(info.quantities, name, &QuantityInfo::name);
      return report.quantities.at(static_cast<std::size_t>(found - info.quantities.begin()));
    };
    constexpr double kDegree = std::numbers::pi / 180;
    for (std::size_t i = 0; i < reference.angles.size(); ++i)
      EXPECT_NEAR((*report.joints)[i] / kDegree, reference.angles[i], 1e-5);
    for (std::size_t i = 0; i < reference.input.size(); ++i) {
      const std::string& limb = info.joints[i].name;
      EXPECT_NEAR(value("lti_input_" + limb), reference.input[i], reference.digits) << limb;
      EXPECT_NEAR(value("lti_output_" + limb), reference.output[i], reference.digits) << limb;
      EXPECT_NEAR(std::cos(value("pressure_angle_" + limb)), reference.input[i], reference.digits) << limb;
    }
  }
}

TEST(Transmission, OfTelescopesHasTheInputIndexOne) {
  const Mechanism& gough = *test::described("gough");
  const std::vector<double> design = test::nominal(gough.info());
  const Indices found = indices_at(gough, design, test::reference_pose(gough), gough.info().modes.front());
  EXPECT_EQ(found.input, 1);
  EXPECT_GT(found.output, 0.1);
  EXPECT_LT(found.output, 1);
}

/// The areas of poses with y > 0 and an index of at least 0.7, on both sides of the parallel singularity and on that of
/// (0, 300 mm), were computed by an independent program.
TEST(Transmission, IsAFieldOfTheWorkspaceOfAFiveBar) {
  const Mechanism& five_bar = *test::described("five-bar");
  const std::vector<double> design = test::design_with(five_bar.info(), {{"d", .1375}, {"l_a", .23}, {"l_b", .23}});
  const auto lti = std::ranges::find(five_bar.info().quantities, "lti", &QuantityInfo::name)->of_pose;
  WorkspacePlan plan{.method = VoxelOptions{.cells = {1000, 1000, 1}, .box = Box{{{-.5, .5}, {0, .5}, {0, 1}}}},
                     .limits = no_limits(five_bar.info())};
  const WorkspaceResult<double> result = test::survey(five_bar, design, plan, {.fields = {lti.get()}, .poses = true});
  const auto det_G = [&](const Pose<double>& pose) {
    return *five_bar.inspect(design, pose, five_bar.info().modes.front(), plan.limits).det_G;
  };
  std::int64_t cells = 0, on_side = 0;
  for (std::size_t k = 0; k < result.pose.size(); ++k) {
    if (result.field(*lti)[k] < 0.7) continue;
    ++cells;
    on_side += det_G(result.pose[k]) > 0;  // as at (0, 300 mm): .0357
  }
  EXPECT_NEAR(static_cast<double>(cells) * result.cell_volume, 0.0366001, 3e-5);
  EXPECT_NEAR(static_cast<double>(on_side) * result.cell_volume, 0.0361221, 3e-5);
}

std::string why_undefined(const MechanismInfo& info, const std::string& quantity) {
  const auto found = std::ranges::find(info.undefined_quantities, quantity, &UndefinedQuantity::name);
  return found == info.undefined_quantities.end() ? "" : found->why;
}

TEST(Transmission, LeavesItsNamesToTheFile) {
  const std::string own = "[[quantity]]\nname = \"lti\"\nformula = \"2*d\"\nunit = \"m\"\n";
  std::ostringstream text;
  text << std::ifstream(test::kMechanismFolder + "five-bar.toml").rdbuf() << own;
  const auto mechanism = read_mechanism_toml(text.str(), "five-bar.toml");
  const MechanismInfo& info = mechanism->info();
  const auto lti = std::ranges::find(info.quantities, "lti", &QuantityInfo::name);
  ASSERT_NE(lti, info.quantities.end());
  EXPECT_EQ(lti->unit, "m");
  EXPECT_EQ(std::ranges::find(info.quantities, "lti_input", &QuantityInfo::name), info.quantities.end());
  EXPECT_EQ(why_undefined(info, "lti"), "the mechanism file already uses the name lti");
}

TEST(Transmission, IsUndefinedForLimbsOfFormulas) {
  const Mechanism& scara = *test::described("4ppa-2par");
  EXPECT_THAT(why_undefined(scara.info(), "lti"),
              ::testing::HasSubstr("does not act on the platform by a single force"));
  EXPECT_EQ(std::ranges::find(scara.info().quantities, "lti", &QuantityInfo::name), scara.info().quantities.end());
}

}  // namespace
}  // namespace pkm
