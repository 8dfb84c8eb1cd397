// Transmission of velocities, accuracy, stiffness, natural frequency, effective mass and acceleration of mechanism
// files, against published and independently computed values, and against numeric linear algebra at random poses.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Dense>

#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/workspace/pose_quantities.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"

namespace pkm {
namespace {

using ::testing::HasSubstr;

std::string replaced(std::string text, const std::string& old, const std::string& by) {
  std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  for (; at != std::string::npos; at = text.find(old, at + by.size())) text.replace(at, old.size(), by);
  return text;
}
/// Omits the lines that begin with a word.
std::string without(const std::string& text, const std::string& word) {
  std::istringstream lines(text);
  std::string kept;
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with(word)) kept += line + "\n";
  return kept;
}

std::shared_ptr<const Mechanism> read(const std::string& text) { return read_mechanism_toml(text, "test.toml"); }

/// Value of a quantity at a pose.
double value_at(const Mechanism& mechanism, const std::vector<double>& design, const std::vector<double>& at,
                const std::string& name, const std::string& mode = "") {
  const MechanismInfo& info = mechanism.info();
  Pose<double> pose(at.size());
  std::ranges::copy(at, pose.begin());
  const PoseReport report = mechanism.inspect(design, pose, mode.empty() ? info.modes.front() : mode, no_limits(info));
  const auto found = std::ranges::find(info.quantities, name, &QuantityInfo::name);
  if (found == info.quantities.end()) {
    ADD_FAILURE() << "there is no " << name;
    return std::nan("");
  }
  return report.quantities.at(static_cast<std::size_t>(found - info.quantities.begin()));
}

constexpr double kL = .3106;

/// An Orthoglide with single rods of length L, 20 mm thick, drives of 5e6 N/m and 3 kg at the platform: a 3-PUU
/// translator. Its values were computed by an independent program.
std::shared_ptr<const Mechanism> orthoglide() {
  std::string text = test::text_of_mechanism("orthoglide");
  for (const char* const word : {"pair", "slider_mass", "rod_mass_per_length"}) text = without(text, word);
  text = replaced(text, "mass = \"0.6 kg\"", "mass = \"3 kg\"");
  return read(
      replaced(text, "drive     = \"slider\"\n",
               "drive = \"slider\"\ndrive_stiffness = 5e6\nrod_section = { outer = \"20 mm\", young = \"70 GPa\" }\n"));
}

TEST(Performance, VelocityTransmissionOfTheOrthoglide) {
  const auto mechanism = orthoglide();
  const std::vector<double> design = test::design_with(mechanism->info(), {{"L", kL}});
  const auto expect = [&](double at, double velocity, double force) {
    EXPECT_NEAR(value_at(*mechanism, design, {at, at, at}, "velocity_transmission"), velocity, 1e-12);
    EXPECT_NEAR(value_at(*mechanism, design, {at, at, at}, "force_transmission"), force, 1e-12);
  };
  expect(0, 1, 1);
  // the published design rule: factors of 1/2 and 2 in the corners of the cube (Chablat and Wenger 2003)
  expect(-kL / std::sqrt(6), .5, .5);
  expect(kL / std::sqrt(18), .8, .5);
}

TEST(Performance, StiffnessOfTheOrthoglide) {
  const auto mechanism = orthoglide();
  const std::vector<double> design = test::design_with(mechanism->info(), {{"L", kL}});
  EXPECT_NEAR(value_at(*mechanism, design, {0, 0, 0}, "stiffness"), 4670194.062, 1e-3);
  EXPECT_NEAR(value_at(*mechanism, design, {0, 0, 0}, "natural_frequency"), 198.576096, 1e-6);
  EXPECT_NEAR(value_at(*mechanism, design, {0, 0, 0}, "effective_mass"), 3, 1e-14);
  const double corner = -kL / std::sqrt(6);  // K has 6781628.944 on its diagonal, 5651357.453 beside it
  EXPECT_NEAR(value_at(*mechanism, design, {corner, corner, corner}, "stiffness"), 6781628.944 - 5651357.453, 2e-3);
}

TEST(Performance, StiffnessOfADelta) {
  std::string text = test::text_of_mechanism("rotary-delta");
  const auto mechanism = read(replaced(text, "drive    = \"crank\"", "drive = \"crank\"\ndrive_stiffness = 1e4"));
  const std::vector<double> design = test::nominal(mechanism->info());
  EXPECT_NEAR(value_at(*mechanism, design, {0, 0, -.5}, "stiffness"), 150539.282, 1e-3);
}

std::shared_ptr<const Mechanism> five_bar(const std::string& more) {
  std::string text = test::text_of_mechanism("five-bar");
  for (const char* const word : {"crank_mass", "rod_mass", "mass"}) text = without(text, word);
  text = replaced(text, "[platform]", "[platform]\nmass = \"1 kg\"");
  return read(replaced(text, "drive    = \"crank\"", "drive = \"crank\"\ndrive_stiffness = 1000") + more);
}

TEST(Performance, OfAFiveBar) {
  const auto mechanism = five_bar("\n[accuracy]\njoint_error = \"0.01 deg\"\n");
  const std::vector<double> design = test::design_with(mechanism->info(), {{"d", .1375}, {"l_a", .23}, {"l_b", .23}});
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

Eigen::MatrixXd eigen_of(const AxisMatrix<double>& A) {
  Eigen::MatrixXd result(A.rows(), A.cols());
  for (std::size_t i = 0; i < A.rows(); ++i)
    for (std::size_t j = 0; j < A.cols(); ++j)
      result(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = A(i, j);
  return result;
}

/// The nonzero rows of the map from coordinate rates to velocities, or to angular velocities.
Eigen::MatrixXd rows_of_twist(const Eigen::MatrixXd& T, bool rotations) {
  const Eigen::MatrixXd part = rotations ? T.bottomRows(3) : T.topRows(3);
  Eigen::MatrixXd kept(0, T.cols());
  for (Eigen::Index i = 0; i < 3; ++i)
    if (part.row(i).norm() > 0) {
      kept.conservativeResize(kept.rows() + 1, Eigen::NoChange);
      kept.row(kept.rows() - 1) = part.row(i);
    }
  return kept;
}

/// Feasible poses about the reference pose.
std::vector<std::vector<double>> random_poses(const Mechanism& mechanism, const std::vector<double>& design,
                                              std::mt19937& random) {
  const MechanismInfo& info = mechanism.info();
  const Pose<double> centre = test::reference_pose(mechanism);
  std::vector<std::vector<double>> poses;
  for (int trial = 0; trial < 200 && poses.size() < 10; ++trial) {
    std::vector<double> at;
    for (std::size_t i = 0; i < info.coordinates.size(); ++i)
      at.push_back(centre[i] + std::uniform_real_distribution<double>(-.05, .05)(random));
    Pose<double> pose(at.size());
    std::ranges::copy(at, pose.begin());
    if (mechanism.inspect(design, pose, info.modes.front(), no_limits(info)).feasible) poses.push_back(at);
  }
  return poses;
}

TEST(Performance, AgreesWithNumericLinearAlgebra) {
  std::mt19937 random(1);
  int compared = 0;
  for (const char* const name :
       {"rotary-delta", "linear-delta", "orthoglide", "five-bar", "3-rpr", "3-rrr", "gough", "par4"}) {
    SCOPED_TRACE(name);
    const auto mechanism = test::described(name);
    const MechanismInfo& info = mechanism->info();
    const std::vector<double> design = test::nominal(info);
    for (const std::vector<double>& at : random_poses(*mechanism, design, random)) {
      Pose<double> pose(at.size());
      std::ranges::copy(at, pose.begin());
      const PoseReport report = mechanism->inspect(design, pose, info.modes.front(), no_limits(info));
      const Eigen::MatrixXd J = eigen_of(*report.J), T = eigen_of(*report.T), inverse = J.inverse();
      const auto expect = [&](const std::string& quantity, double expected) {
        const auto found = std::ranges::find(info.quantities, quantity, &QuantityInfo::name);
        if (found == info.quantities.end()) return;
        ++compared;
        EXPECT_NEAR(report.quantities[static_cast<std::size_t>(found - info.quantities.begin())], expected,
                    1e-9 * std::fabs(expected))
            << quantity;
      };
      for (const bool rotations : {false, true}) {
        const Eigen::MatrixXd rows = rows_of_twist(T, rotations);
        if (rows.rows() == 0) continue;
        const Eigen::VectorXd sigma = (rows * inverse).jacobiSvd().singularValues();
        expect(rotations ? "angular_velocity_transmission" : "velocity_transmission", sigma(sigma.size() - 1));
        expect(rotations ? "moment_transmission" : "force_transmission", 1 / sigma(0));
      }
      if (!mechanism->dynamics()) continue;
      const Eigen::MatrixXd rows = rows_of_twist(T, false);
      const MotionState<double> state{pose, Pose<double>(at.size())};
      PoseDynamics<double> dynamics;
      mechanism->dynamics()->equations(std::span<const double>(design), info.modes.front(), {&state, 1},
                                       {&dynamics, 1});
      const Eigen::MatrixXd M = eigen_of(dynamics.M_X);
      const Eigen::VectorXd mass =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(rows * M.inverse() * rows.transpose()).eigenvalues();
      expect("effective_mass", 1 / mass(0));
      expect("effective_mass_ratio", mass(0) / mass(mass.size() - 1));
    }
  }
  EXPECT_GT(compared, 300);
}

}  // namespace
}  // namespace pkm
