// Quantities of the performance at random poses of eight mechanisms, against numeric linear algebra, enumeration,
// search and differences.
#include <numbers>

#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/generic/exact_accuracy.hpp"
#include "engine/math/eigen_solvers.hpp"
#include "tests/unit/generic/performance_fixtures.hpp"

namespace pkm::test {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd, Eigen::Vector3d;

constexpr double kStiffness = 1e5, kError = 1e-4, kPeak = 1000;

/// The mechanism with elastic and inexact drives that have a peak force.
std::shared_ptr<const Mechanism> with_drives(const std::string& name) {
  std::istringstream lines(text_of_mechanism(name));
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    text += line + "\n";
    if (line.starts_with("drive ")) text += "drive_stiffness = " + std::to_string(kStiffness) + "\n";
  }
  text += "\n[accuracy]\njoint_error = " + std::to_string(kError) + "\n";
  return with_study(text, "[[drive_train]]\njoint = \"all\"\npeak_force = " + std::to_string(kPeak) + "\n");
}

VectorXd eigenvalues_of(const MatrixXd& A) { return Eigen::SelfAdjointEigenSolver<MatrixXd>(A).eigenvalues(); }

/// Maximum of |V e| over the vertices of |e_i| <= 1.
double longest_error(const MatrixXd& V) {
  double longest = 0;
  for (unsigned vertex = 0; vertex < 1U << V.cols(); ++vertex) {
    VectorXd e(V.cols());
    for (Eigen::Index i = 0; i < e.size(); ++i) e[i] = vertex >> i & 1U ? 1 : -1;
    longest = std::fmax(longest, (V * e).norm());
  }
  return longest;
}

/// Minimum over all directions of sum |u . w_i| - |u . offset|, by random search from the best of many directions.
/// @param W  the w_i as columns
double smallest_support(const MatrixXd& W, const VectorXd& offset, std::mt19937& random) {
  const auto support = [&](const VectorXd& u) {
    return (u.transpose() * W).cwiseAbs().sum() - std::fabs(u.dot(offset));
  };
  const auto direction_near = [&](const VectorXd& u, double step) {
    VectorXd moved = u;
    for (double& component : moved) component += step * std::normal_distribution<double>()(random);
    return VectorXd(moved.normalized());
  };
  std::vector<VectorXd> starts;
  for (int k = 0; k < 1000; ++k) starts.push_back(direction_near(VectorXd::Zero(W.rows()), 1));
  std::ranges::sort(starts, {}, support);
  double smallest = support(starts[0]);
  for (std::size_t k = 0; k < 20; ++k) {
    VectorXd best = starts[k];
    for (double step = .1; step > 1e-6; step *= .8)
      for (int trial = 0; trial < 12; ++trial)
        if (const VectorXd u = direction_near(best, step); support(u) < support(best)) best = u;
    smallest = std::fmin(smallest, support(best));
  }
  return smallest;
}

/// Ends of the rod or leg of a limb at a pose.
std::array<Vector3d, 2> rod_of(const Mechanism& mechanism, const std::vector<double>& design, const Pose<double>& pose,
                               const std::string& limb) {
  for (const PlacedLink& link : mechanism.links()->place(design, pose, mechanism.info().modes.front()))
    if (link.name == "rod of " + limb || link.name == "leg of " + limb)
      return {Vector3d(link.body.axis.from[0], link.body.axis.from[1], link.body.axis.from[2]),
              Vector3d(link.body.axis.to[0], link.body.axis.to[1], link.body.axis.to[2])};
  ADD_FAILURE() << "no rod of " << limb;
  return {};
}

/// Transmission indices of a limb by differences of the ends of its rod: input (1 for telescopes) and output.
std::array<double, 2> transmission_of(const Mechanism& mechanism, const std::vector<double>& design,
                                      const Pose<double>& pose, const MatrixXd& inverse, std::size_t limb) {
  const std::string& name = mechanism.info().joints[limb].name;
  const auto [C, B] = rod_of(mechanism, design, pose, name);
  Vector3d of_C = Vector3d::Zero(), of_B = Vector3d::Zero();  // velocities while all other drives are locked
  constexpr double kStep = 1e-5;
  for (std::size_t j = 0; j < pose.size(); ++j) {
    Pose<double> up = pose, down = pose;
    up[j] += kStep;
    down[j] -= kStep;
    const auto above = rod_of(mechanism, design, up, name), below = rod_of(mechanism, design, down, name);
    const double rate = inverse(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(limb)) / (2 * kStep);
    of_C += (above[0] - below[0]) * rate;
    of_B += (above[1] - below[1]) * rate;
  }
  const Vector3d f = (B - C).normalized();
  const double input = of_C.norm() > 1e-7 * of_B.norm() ? std::fabs(f.dot(of_C.normalized())) : 1;
  return {input, std::fabs(f.dot(of_B.normalized()))};
}

class PerformanceNumeric : public ::testing::TestWithParam<const char*> {};

TEST_P(PerformanceNumeric, AgreesWithOtherMethods) {
  std::mt19937 random(1);
  const auto mechanism = with_drives(GetParam());
  const MechanismInfo& info = mechanism->info();
  const std::vector<double> design = nominal(info);
  const std::string& mode = info.modes.front();
  int compared = 0;
  const auto poses = random_poses(*mechanism, design, random);
  ASSERT_EQ(poses.size(), 10U);
  for (const std::vector<double>& at : poses) {
    const Pose<double> pose = pose_at(at);
    const PoseReport report = mechanism->inspect(design, pose, mode, no_limits(info));
    const auto expect = [&](const std::string& quantity, double expected, double tolerance = 1e-9) {
      ++compared;
      EXPECT_NEAR(value_in(report, info, quantity), expected, tolerance * std::fabs(expected)) << quantity;
    };
    const MatrixXd J = eigen_of(*report.J), T = eigen_of(*report.T), inverse = J.inverse();
    for (const bool rotations : {false, true}) {
      const MatrixXd rows = rows_of_twist(T, rotations), V = rows * inverse;
      if (V.rows() == 0) continue;
      const VectorXd sigma = V.jacobiSvd().singularValues();
      expect(rotations ? "angular_velocity_transmission" : "velocity_transmission", sigma(sigma.size() - 1));
      expect(rotations ? "moment_transmission" : "force_transmission", 1 / sigma(0));
      expect(rotations ? "accuracy_angle" : "accuracy", kError * longest_error(V));
      expect(rotations ? "accuracy_angle_rms" : "accuracy_rms", kError * V.norm());
      expect(rotations ? "rotational_stiffness" : "stiffness", kStiffness / (sigma(0) * sigma(0)));
    }
    for (std::size_t limb = 0; find_named(info.quantities, "lti") && limb < info.joints.size(); ++limb) {
      const auto [input, output] = transmission_of(*mechanism, design, pose, inverse, limb);
      const std::string& name = info.joints[limb].name;
      if (find_named(info.quantities, "lti_input_" + name)) expect("lti_input_" + name, input, 1e-6);
      expect("lti_output_" + name, output, 1e-6);
    }
    if (mechanism->elasticity()) {  // wrenches that the joints carry do no work on displacements that they prevent
      const PlatformCompliance found = mechanism->elasticity()->compliance(design, pose, mode);
      const MatrixXd S = eigen_of(found.supported), C = eigen_of(found.compliance);
      const MatrixXd V = S.transpose() * T * inverse, expected = V * V.transpose() / kStiffness;
      EXPECT_GE(S.cols(), T.cols());
      EXPECT_LT((C - expected).norm(), 1e-9 * expected.norm());
    }
    ASSERT_TRUE(mechanism->dynamics());
    const MotionState<double> state{pose, Pose<double>(at.size())};
    PoseDynamics<double> dynamics;
    mechanism->dynamics()->equations(std::span<const double>(design), mode, {&state, 1}, {&dynamics, 1});
    const MatrixXd M = eigen_of(dynamics.M_X), rows = rows_of_twist(T, false), by_force = rows * M.inverse();
    const VectorXd mass = eigenvalues_of(by_force * rows.transpose());
    expect("effective_mass", 1 / mass(0));
    expect("effective_mass_ratio", mass(0) / mass(mass.size() - 1));
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> vibration(kStiffness * J.transpose() * J, M);
    expect("natural_frequency", std::sqrt(vibration.eigenvalues()(0)) / (2 * std::numbers::pi));
    VectorXd weight(M.rows());
    for (std::size_t i = 0; i < at.size(); ++i) weight(static_cast<Eigen::Index>(i)) = dynamics.G_X[i];
    const MatrixXd W = by_force * J.transpose() * kPeak;
    const double radius = smallest_support(W, by_force * weight, random);
    const double found = value_in(report, info, "acceleration");
    EXPECT_GT(found, 0);
    EXPECT_NEAR(found, radius, 1e-4 * W.norm());
    EXPECT_LE(found, radius + 1e-9 * W.norm());
  }
  EXPECT_GE(compared, 80);
}
INSTANTIATE_TEST_SUITE_P(Of, PerformanceNumeric,
                         ::testing::Values("rotary-delta", "linear-delta", "orthoglide", "five-bar", "3-rpr", "3-rrr",
                                           "gough", "par4"),
                         [](const auto& instance) {
                           std::string name = instance.param;
                           std::erase(name, '-');
                           return name;
                         });

/// Errors of parameters of all limbs or of one, and play at both ends of the rods, by differences of the joints.
TEST(PerformanceAccuracy, IncludesParametersAndPlay) {
  constexpr double kLength = 5e-5, kCrank = 2e-5, kPlay = 3e-6;
  const auto mechanism =
      read(replaced(text_of_mechanism("rotary-delta"), "drive    = \"crank\"", "drive = \"crank\"\nplay = \"3 um\"") +
           "\n[accuracy]\njoint_error = 1e-4\nparameter_error = { l_b = \"50 um\", arm2.l_a = \"20 um\" }\n");
  const MechanismInfo& info = mechanism->info();
  std::mt19937 random(5);
  const std::vector<double> design = nominal(info);  // R, r, l_a, l_b
  for (const std::vector<double>& at : random_poses(*mechanism, design, random)) {
    const auto inspect = [&](std::size_t parameter, double change) {
      std::vector<double> changed = design;
      changed[parameter] += change;
      return mechanism->inspect(changed, pose_at(at), info.modes.front(), no_limits(info));
    };
    const auto by_parameter = [&](std::size_t parameter, std::size_t joint) {
      constexpr double kStep = 1e-6;
      return ((*inspect(parameter, kStep).joints)[joint] - (*inspect(parameter, -kStep).joints)[joint]) / (2 * kStep);
    };
    const PoseReport report = inspect(0, 0);
    MatrixXd bound = MatrixXd::Zero(3, 3), spread = bound;
    for (std::size_t i = 0; i < 3; ++i) {
      const double play = kPlay / (design[2] * value_in(report, info, "lti_input_arm" + std::to_string(i + 1))),
                   of_rod = std::fabs(by_parameter(3, i)) * kLength,
                   of_crank = i == 1 ? std::fabs(by_parameter(2, i)) * kCrank : 0;
      const auto k = static_cast<Eigen::Index>(i);
      bound(k, k) = kError + of_rod + of_crank + 2 * play;
      spread(k, k) = std::sqrt(kError * kError + of_rod * of_rod + of_crank * of_crank + 2 * play * play);
    }
    const MatrixXd inverse = eigen_of(*report.J).inverse();
    const double worst = longest_error(inverse * bound), deviation = (inverse * spread).norm();
    EXPECT_NEAR(value_in(report, info, "accuracy"), worst, 1e-7 * worst);
    EXPECT_NEAR(value_in(report, info, "accuracy_rms"), deviation, 1e-7 * deviation);
  }
}

/// Without linearisation: for small errors of the joints the same as to first order; for the five-bar with errors of
/// 0.01 deg, the values of all four extreme joint errors were computed by an independent program.
TEST(PerformanceAccuracy, WithoutLinearisation) {
  std::mt19937 random(6);
  for (const char* const name :
       {"rotary-delta", "linear-delta", "orthoglide", "five-bar", "3-rpr", "3-rrr", "gough", "par4"}) {
    SCOPED_TRACE(name);
    const auto mechanism = read(text_of_mechanism(name) + "\n[accuracy]\njoint_error = 1e-7\n");
    const std::vector<double> design = nominal(mechanism->info());
    std::vector<Pose<double>> poses;
    for (const auto& at : random_poses(*mechanism, design, random)) poses.push_back(pose_at(at));
    for (const WorkspaceField& field : generic::exact_accuracy_fields(*mechanism, design, poses)) {
      const std::string first_order = field.name.substr(0, field.name.size() - std::string("_exact").size());
      for (std::size_t i = 0; i < poses.size(); ++i) {
        const double expected = value_at(*mechanism, design, {poses[i].begin(), poses[i].end()}, first_order);
        EXPECT_NEAR(field.values[i], expected, 1e-5 * expected) << field.name;
      }
    }
  }
  const auto mechanism = read(text_of_mechanism("five-bar") + "\n[accuracy]\njoint_error = \"0.01 deg\"\n");
  const std::vector<double> design = design_with(mechanism->info(), {{"d", .1375}, {"l_a", .23}, {"l_b", .23}});
  const auto fields =
      generic::exact_accuracy_fields(*mechanism, design, {pose_at({0, .3}), pose_at({0, .25}), pose_at({.1, .3})});
  ASSERT_EQ(fields.size(), 1U);
  EXPECT_NEAR(fields[0].values[0], .11093631e-3, 1e-11);
  EXPECT_NEAR(fields[0].values[1], .23672869e-3, 1e-11);
  EXPECT_NEAR(fields[0].values[2], .0878738e-3, 1e-10);
}

}  // namespace
}  // namespace pkm::test
