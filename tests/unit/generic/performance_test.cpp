// Transmission of velocities, accuracy, stiffness, natural frequency, effective mass and acceleration of mechanism
// files, against published and independently computed values, and against numeric linear algebra at random poses.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "engine/math/eigen_solvers.hpp"
#include "tests/unit/generic/performance_fixtures.hpp"

namespace pkm::test {
namespace {

constexpr double kRailLength = .3106;

/// An Orthoglide with single rods of length L, 20 mm thick, drives of 5e6 N/m and 3 kg at the platform: a 3-PUU
/// translator. Its values were computed by an independent program.
std::shared_ptr<const Mechanism> orthoglide() {
  std::string text = text_of_mechanism("orthoglide");
  for (const char* const word : {"pair", "slider_mass", "rod_mass_per_length"}) text = without(text, word);
  text = replaced(text, "mass = \"0.6 kg\"", "mass = \"3 kg\"");
  return read(
      replaced(text, "drive     = \"slider\"\n",
               "drive = \"slider\"\ndrive_stiffness = 5e6\nrod_section = { outer = \"20 mm\", young = \"70 GPa\" }\n"));
}

TEST(Performance, VelocityTransmissionOfTheOrthoglide) {
  const auto mechanism = orthoglide();
  const std::vector<double> design = design_with(mechanism->info(), {{"L", kRailLength}});
  const auto expect = [&](double at, double velocity, double force) {
    EXPECT_NEAR(value_at(*mechanism, design, {at, at, at}, "velocity_transmission"), velocity, 1e-12);
    EXPECT_NEAR(value_at(*mechanism, design, {at, at, at}, "force_transmission"), force, 1e-12);
  };
  expect(0, 1, 1);
  // the published design rule: factors of 1/2 and 2 in the corners of the cube (Chablat and Wenger 2003)
  expect(-kRailLength / std::sqrt(6), .5, .5);
  expect(kRailLength / std::sqrt(18), .8, .5);
}

TEST(Performance, StiffnessOfTheOrthoglide) {
  const auto mechanism = orthoglide();
  const std::vector<double> design = design_with(mechanism->info(), {{"L", kRailLength}});
  EXPECT_NEAR(value_at(*mechanism, design, {0, 0, 0}, "stiffness"), 4670194.062, 1e-3);
  EXPECT_NEAR(value_at(*mechanism, design, {0, 0, 0}, "natural_frequency"), 198.576096, 1e-6);
  EXPECT_NEAR(value_at(*mechanism, design, {0, 0, 0}, "effective_mass"), 3, 1e-14);
  const double corner = -kRailLength / std::sqrt(6);  // K has 6781628.944 on its diagonal, 5651357.453 beside it
  EXPECT_NEAR(value_at(*mechanism, design, {corner, corner, corner}, "stiffness"), 6781628.944 - 5651357.453, 2e-3);
}

TEST(Performance, StiffnessOfADelta) {
  std::string text = text_of_mechanism("rotary-delta");
  const auto mechanism = read(replaced(text, "drive    = \"crank\"", "drive = \"crank\"\ndrive_stiffness = 1e4"));
  const std::vector<double> design = nominal(mechanism->info());
  EXPECT_NEAR(value_at(*mechanism, design, {0, 0, -.5}, "stiffness"), 150539.282, 1e-3);
  const PlatformCompliance found =
      mechanism->elasticity()->compliance(design, pose_at({0, 0, -.5}), mechanism->info().modes.front());
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j)
      if (i != j || i > 2) {
        EXPECT_EQ(found.compliance(i, j), 0) << "pairs of rigid rods prevent rotations";
      }
  EXPECT_NEAR(1 / found.compliance(0, 0), 150539.282, 1e-3);
  EXPECT_NEAR(1 / found.compliance(1, 1), 150539.282, 1e-3);
  EXPECT_NEAR(1 / found.compliance(2, 2), 454707.926, 1e-3);
}

std::shared_ptr<const Mechanism> five_bar(const std::string& more) {
  std::string text = text_of_mechanism("five-bar");
  for (const char* const word : {"crank_mass", "rod_mass", "mass"}) text = without(text, word);
  text = replaced(text, "[platform]", "[platform]\nmass = \"1 kg\"");
  return read(replaced(text, "drive    = \"crank\"", "drive = \"crank\"\ndrive_stiffness = 1000") + more);
}

TEST(Performance, OfAFiveBar) {
  const auto mechanism = five_bar("\n[accuracy]\njoint_error = \"0.01 deg\"\n");
  const std::vector<double> design = design_with(mechanism->info(), {{"d", .1375}, {"l_a", .23}, {"l_b", .23}});
  EXPECT_NEAR(value_at(*mechanism, design, {0, .3}, "natural_frequency"), 11.204621774, 1e-8);
  EXPECT_NEAR(value_at(*mechanism, design, {0, .3}, "accuracy"), .11087032e-3, 1e-11);
  EXPECT_NEAR(value_at(*mechanism, design, {0, .25}, "accuracy"), .23607311e-3, 1e-11);
  EXPECT_NEAR(value_at(*mechanism, design, {.1, .3}, "accuracy"), .08783725e-3, 1e-11);
  for (const auto& at : {std::vector<double>{0, .3}, {0, .25}, {.1, .3}}) {
    const double ratio = value_at(*mechanism, design, at, "velocity_transmission") *
                         value_at(*mechanism, design, at, "force_transmission");
    EXPECT_NEAR(ratio, at[0] > 0 ? .484525188 : at[1] > .28 ? .388228833 : .167774052, 1e-9);
  }
}

/// The platform's compliance by the equilibrium of all bodies, against the same references, and the torsion of rods
/// with universal joints, G J / L.
TEST(Performance, ComplianceOfTheOrthoglideWithUniversalJoints) {
  std::string text = text_of_mechanism("orthoglide");
  for (const char* const word : {"pair", "slider_mass", "rod_mass_per_length"}) text = without(text, word);
  text = replaced(text, "mass = \"0.6 kg\"", "mass = \"3 kg\"");
  const std::string drive = "drive     = \"slider\"\n";
  const char* const axes[] = {"[0, 1, 0]", "[0, 0, 1]", "[1, 0, 0]"};
  std::size_t at = text.find(drive);
  for (const char* const axis : axes) {
    const std::string more = std::string("universal = ") + axis +
                             "\ndrive_stiffness = 5e6\n"
                             "rod_section = { outer = \"20 mm\", young = \"70 GPa\", shear = \"26 GPa\" }\n";
    text.insert(at + drive.size(), more);
    at = text.find(drive, at + 1);
  }
  const auto mechanism = read(text);
  const std::vector<double> design = design_with(mechanism->info(), {{"L", kRailLength}});
  const auto at_diagonal = [&](double x) {
    Pose<double> pose(3);
    for (std::size_t i = 0; i < 3; ++i) pose[i] = x;
    return mechanism->elasticity()->compliance(design, pose, mechanism->info().modes.front());
  };
  const PlatformCompliance centre = at_diagonal(0);
  ASSERT_TRUE(centre.is_complete());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(1 / centre.compliance(i, i), 4670194.062, 1e-3);
    EXPECT_NEAR(1 / centre.compliance(i + 3, i + 3), 1314.897118, 1e-6);
  }
  EXPECT_NEAR(centre.compliance(0, 0) * 100, 21.412386e-6, 1e-12);
  const PlatformCompliance corner = at_diagonal(-kRailLength / std::sqrt(6));
  EXPECT_NEAR(corner.compliance(0, 0) * 100, 60.826094e-6, 1e-12);
  // a parallel singularity: the platform is free in some direction, and not every wrench is carried
  EXPECT_FALSE(at_diagonal(kRailLength / std::sqrt(3)).is_complete());
}

TEST(Performance, ComplianceWithBallJointsCarriesForcesOnly) {
  const auto mechanism = orthoglide();
  const std::vector<double> design = design_with(mechanism->info(), {{"L", kRailLength}});
  const PlatformCompliance found =
      mechanism->elasticity()->compliance(design, Pose<double>(3), mechanism->info().modes.front());
  ASSERT_EQ(found.supported.cols(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(1 / found.compliance(i, i), 4670194.062, 1e-3);
}

/// With pairs of rods a Delta carries moments, too; the quantity, which holds the other degrees of freedom, cannot be
/// below the stiffness of the whole mechanism. A crank's bending is that of a cantilever.
TEST(Performance, ComplianceOfADeltaWithElasticLinks) {
  std::string text = text_of_mechanism("rotary-delta");
  text = replaced(text, "drive    = \"crank\"",
                  "drive = \"crank\"\ndrive_stiffness = 1e4\n"
                  "rod_section = { outer = \"8 mm\", inner = \"6 mm\", young = \"70 GPa\" }");
  text = replaced(text, "outer = \"30 mm\", inner = \"26 mm\" }",
                  "outer = \"30 mm\", inner = \"26 mm\", young = \"70 GPa\" }");
  const auto mechanism = read(text);
  const std::vector<double> design = nominal(mechanism->info());
  for (const double x : {0.0, 0.1, -0.15}) {
    Pose<double> pose(3);
    pose[0] = x;
    pose[2] = -.5;
    const PlatformCompliance found = mechanism->elasticity()->compliance(design, pose, mechanism->info().modes.front());
    ASSERT_TRUE(found.is_complete());
    const Eigen::MatrixXd C = eigen_of(found.compliance);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(C).eigenvalues()[0], 0);
    const double whole =
        1 / Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(Eigen::MatrixXd(C.topLeftCorner<3, 3>())).eigenvalues()[2];
    const double quantity = value_at(*mechanism, design, {x, 0, -.5}, "stiffness");
    EXPECT_LE(whole, quantity * (1 + 1e-9));
    EXPECT_GT(whole, quantity * .8);
  }
}

/// Six elastic rods alone: K = sum (E A / L) w w^T with w = (f, (B - O) x f).
TEST(Performance, ComplianceOfADeltaWithElasticRods) {
  const std::string text = replaced(text_of_mechanism("rotary-delta"), "drive    = \"crank\"",
                                    "drive = \"crank\"\nrod_section = { outer = \"8 mm\", young = \"70 GPa\" }");
  const auto mechanism = read(text);
  const std::vector<double> design = nominal(mechanism->info());  // R, r, l_a, l_b
  Pose<double> pose(3);
  pose[0] = .1;
  pose[1] = .05;
  pose[2] = -.5;
  const std::string& mode = mechanism->info().modes.front();
  const PoseReport report = mechanism->inspect(design, pose, mode, no_limits(mechanism->info()));
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(6, 6);
  for (std::size_t limb = 0; limb < 3; ++limb) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(limb) / 3, q = (*report.joints)[limb];
    const Eigen::Vector3d radial(std::cos(turn), std::sin(turn), 0), side(-std::sin(turn), std::cos(turn), 0);
    // the crank rotates about the side axis, from the radial direction at 0
    const Eigen::Vector3d C =
        design[0] * radial + design[2] * (std::cos(q) * radial + std::sin(q) * side.cross(radial));
    const Eigen::Vector3d arm = design[1] * radial, B = Eigen::Vector3d(pose[0], pose[1], pose[2]) + arm;
    EXPECT_NEAR((B - C).norm(), design[3], 1e-12);
    for (const double offset : {-.03, .03}) {
      Eigen::VectorXd w(6);
      w << (B - C).normalized(), (arm + offset * side).cross((B - C).normalized());
      K += 70e9 * std::numbers::pi / 4 * .008 * .008 / design[3] * w * w.transpose();
    }
  }
  const PlatformCompliance found = mechanism->elasticity()->compliance(design, pose, mode);
  ASSERT_TRUE(found.is_complete());
  const Eigen::MatrixXd C = eigen_of(found.compliance), expected = K.inverse();
  EXPECT_LT((C - expected).norm(), 1e-9 * expected.norm());
}

/// A cubic hexapod of edge a: legs along three orthogonal directions, 2 k I, and its rotational stiffness
/// k a^2 [[1, .5, .5], [.5, 1, .5], [.5, .5, 1]] about the centre.
TEST(Performance, OfACubicHexapod) {
  std::string text = R"(
[mechanism]
name = "cube"
[parameters]
a = { default = 0.3, min = 0.01, max = 1 }
[platform]
coordinates = { x = "along x", y = "along y", z = "along z", alpha = "about x", beta = "about y", gamma = "about z" }
characteristic_length = "a"
mass = "10 kg"
inertia = [0.2, 0.2, 0.2]
)";
  // each leg is an edge of the cube of two opposite corners' neighbours
  const int legs[6][2][3] = {{{0, 0, 1}, {1, 0, 1}}, {{0, 1, 0}, {0, 1, 1}}, {{1, 0, 0}, {1, 1, 0}},
                             {{0, 1, 0}, {1, 1, 0}}, {{1, 0, 0}, {1, 0, 1}}, {{0, 0, 1}, {0, 1, 1}}};
  int number = 0;
  for (const auto& leg : legs) {
    const auto point = [&](const int* corner) {
      std::string list = "[";
      for (int k = 0; k < 3; ++k) list += std::string(k ? ", " : "") + (corner[k] ? "\"a/2\"" : "\"-a/2\"");
      return list + "]";
    };
    const std::string name = "leg" + std::to_string(++number);
    text += "[[limb]]\nname = \"" + name + "\"\ndrive = \"telescope\"\nbase = " + point(leg[0]) +
            "\nplatform = " + point(leg[1]) + "\ndrive_stiffness = 1e6\n";
  }
  const auto mechanism = read(text);
  const std::vector<double> design = {.3}, origin(6, 0.0);
  EXPECT_NEAR(value_at(*mechanism, design, origin, "stiffness"), 2e6, 1e-3);
  EXPECT_NEAR(value_at(*mechanism, design, origin, "rotational_stiffness"), 1e6 * .09 * .5, 1e-6);
  EXPECT_NEAR(value_at(*mechanism, design, origin, "natural_frequency"), 71.176254, 1e-6);
}

/// Margins under limits of all quantities have the derivatives of the quantities: against central differences, at
/// random poses of random designs. Quantities that are minima over limbs have kinks, where the differences do not
/// converge.
TEST(Performance, HasDerivatives) {
  std::mt19937 random(2);
  int compared = 0, kinks = 0;
  for (const char* const name :
       {"rotary-delta", "linear-delta", "orthoglide", "five-bar", "3-rpr", "3-rrr", "gough", "par4"}) {
    SCOPED_TRACE(name);
    std::string text = text_of_mechanism(name);
    std::istringstream lines(text);
    text.clear();
    for (std::string line; std::getline(lines, line);) {
      text += line + "\n";
      if (line.starts_with("drive ")) text += "drive_stiffness = 1e5\n";
    }
    const bool turns = described(name)->info().joints.front().turns();
    text += std::string("\n[accuracy]\njoint_error = \"") + (turns ? "1 mrad" : "1 mm") + "\"\n";
    std::vector<std::string> quantities;
    const std::string drives = "[[drive_train]]\njoint = \"all\"\npeak_force = 100\n";
    const auto unlimited = with_study(text, drives);
    for (const QuantityInfo& quantity : unlimited->info().quantities)
      if (quantity.of_pose) quantities.push_back(quantity.name);
    std::string limits = "[workspace]\nlimits = { ";
    for (const std::string& quantity : quantities) limits += quantity + " = { min = 0 }, ";
    limits = limits.substr(0, limits.size() - 2) + " }\n" + drives;
    SCOPED_TRACE(limits);
    const auto mechanism = with_study(text, limits);
    const MechanismInfo& info = mechanism->info();
    LimitSpec spec = no_limits(info);
    for (std::size_t i = 0; i < info.limits.size(); ++i)
      if (info.limits[i].group == kQuantityLimit) spec.given[i] = 0;
    const std::vector<double> default_design = nominal(info);
    for (int trial = 0; trial < 100; ++trial) {
      std::vector<double> design = default_design;
      for (double& p : design) p *= std::uniform_real_distribution<double>(.97, 1.03)(random);
      Pose<double> pose = reference_pose(*mechanism);
      for (double& x : pose) x += std::uniform_real_distribution<double>(-.02, .02)(random);
      const auto margins = [&](const std::vector<double>& at) {
        std::vector<double> values;
        Scratch scratch;
        mechanism->pose_margins()->append(std::span<const double>(at), info.modes.front(), spec, {&pose, 1}, scratch,
                                          values);
        return values;
      };
      const std::size_t parameter = trial % std::min<std::size_t>(4, design.size());
      std::vector<Dual4> seeded(design.begin(), design.end());
      seeded[parameter].v[0] = 1;
      std::vector<Dual4> exact;
      Scratch scratch;
      mechanism->pose_margins()->append(std::span<const Dual4>(seeded), info.modes.front(), spec, {&pose, 1}, scratch,
                                        exact);
      const std::vector<double> value = margins(design);
      const auto difference = [&](double h) {
        std::vector<double> up = design, down = design;
        up[parameter] += h;
        down[parameter] -= h;
        std::vector<double> above = margins(up), below = margins(down);
        for (std::size_t i = 0; i < above.size(); ++i) above[i] = (above[i] - below[i]) / (2 * h);
        return above;
      };
      const double h = 1e-4 * std::fabs(design[parameter]) + 1e-6;
      const std::vector<double> coarse = difference(h), fine = difference(h / 2);
      ASSERT_EQ(value.size(), exact.size());
      for (std::size_t i = 0; i < value.size(); ++i) {
        if (!std::isfinite(value[i])) continue;
        const double extrapolated = (4 * fine[i] - coarse[i]) / 3;
        const double scale = std::fabs(extrapolated) + std::fabs(value[i] / design[parameter]);
        EXPECT_EQ(exact[i].a, value[i]);
        if (std::fabs(fine[i] - coarse[i]) > 1e-3 * scale) {
          ++kinks;
          continue;
        }
        ++compared;
        EXPECT_NEAR(exact[i].v[0], extrapolated, 1e-6 * scale) << i;
      }
    }
  }
  EXPECT_GT(compared, 5000);
  EXPECT_LT(kinks, compared / 50);
}

}  // namespace
}  // namespace pkm::test
