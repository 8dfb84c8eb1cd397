// Stiffness with elastic slides, rods and drives, against cantilevers by hand and against the direct stiffness method.
#include <numbers>

#include "engine/math/eigen_solvers.hpp"
#include "tests/unit/generic/performance_fixtures.hpp"

namespace pkm::test {
namespace {

using Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr double kYoung = 70e9, kShear = 26e9, kDrive = 2e6, kSpacing = .08;

struct Tube {
  double area, moment;
  Tube(double outer, double inner)
      : area(std::numbers::pi / 4 * (outer * outer - inner * inner)),
        moment(std::numbers::pi / 64 * (std::pow(outer, 4) - std::pow(inner, 4))) {}
};
const Tube kRod(.012, .01), kSlider(.03, .02);

/// A linear Delta with elastic slides, rods and drives. @param length  key of the free length of the slides, or ""
std::string elastic_linear_delta(const std::string& length) {
  return replaced(text_of_mechanism("linear-delta"), "drive     = \"slider\"\n",
                  "drive = \"slider\"\ndrive_stiffness = 2e6\n"
                  "slider_section = { outer = \"30 mm\", inner = \"20 mm\", young = \"70 GPa\", shear = \"26 GPa\"" +
                      length + " }\nrod_section = { outer = \"12 mm\", inner = \"10 mm\", young = \"70 GPa\" }\n");
}

/// Ends of the rod in the middle of a limb's pair, and the direction along which the pair is spaced.
struct LimbGeometry {
  Vector3d S, B, side;
};
LimbGeometry geometry(const std::vector<double>& design, const Vector3d& x, double q, int limb) {
  const double turn = 2 * std::numbers::pi * limb / 3;
  const Vector3d radial(std::cos(turn), std::sin(turn), 0);
  return {design[0] * radial + q * Vector3d::UnitZ(), x + design[1] * radial, {-std::sin(turn), std::cos(turn), 0}};
}

Matrix3d cross_matrix(const Vector3d& u) {
  Matrix3d m;
  m << 0, -u[2], u[1], u[2], 0, -u[0], -u[1], u[0], 0;
  return m;
}

/// Displacement and rotation of the end of a cantilever along u by force and moment at its end.
Matrix6d cantilever(const Vector3d& u, double l) {
  const Matrix3d along = u * u.transpose(), across = Matrix3d::Identity() - along;
  const double EI = kYoung * kSlider.moment, EA = kYoung * kSlider.area, GJ = kShear * 2 * kSlider.moment;
  Matrix6d C;
  C << along * (l / EA) + across * (l * l * l / (3 * EI)), -cross_matrix(u) * (l * l / (2 * EI)),
      cross_matrix(u) * (l * l / (2 * EI)), across * (l / EI) + along * (l / GJ);
  return C;
}

/// Slides that end in a single rod with ball joints: the hand calculation of a bar and a cantilever in series.
TEST(Elasticity, OfSlidesWithSingleRods) {
  std::mt19937 random(3);
  for (const double given : {0.0, .15}) {
    const auto mechanism = read(without(elastic_linear_delta(given > 0 ? ", length = \"150 mm\"" : ""), "pair"));
    const std::vector<double> design = nominal(mechanism->info());
    for (const std::vector<double>& at : random_poses(*mechanism, design, random)) {
      const Vector3d x(at[0], at[1], at[2]);
      const PoseReport report =
          mechanism->inspect(design, pose_at(at), mechanism->info().modes.front(), no_limits(mechanism->info()));
      Matrix3d K = Matrix3d::Zero();
      for (int limb = 0; limb < 3; ++limb) {
        const double q = (*report.joints)[static_cast<std::size_t>(limb)], l = given > 0 ? given : q;
        const auto [S, B, side] = geometry(design, x, q, limb);
        const Vector3d f = (B - S).normalized();
        const double along = f[2] * f[2];
        const double compliance = design[2] / (kYoung * kRod.area) +
                                  along * (1 / kDrive + l / (kYoung * kSlider.area)) +
                                  (1 - along) * l * l * l / (3 * kYoung * kSlider.moment);
        K += f * f.transpose() / compliance;
      }
      const double softest = Eigen::SelfAdjointEigenSolver<Matrix3d>(K).eigenvalues()[0];
      EXPECT_NEAR(value_in(report, mechanism->info(), "stiffness"), softest, 1e-9 * softest);
      const PlatformCompliance found =
          mechanism->elasticity()->compliance(design, pose_at(at), mechanism->info().modes.front());
      ASSERT_EQ(found.supported.cols(), 3U);
      const MatrixXd N = eigen_of(found.supported).topRows(3), C = eigen_of(found.compliance);
      EXPECT_LT((C - N.transpose() * K.inverse() * N).norm(), 1e-9 * C.norm());
    }
  }
}

/// Pairs of rods load the slides by moments, too. Second method: direct stiffness, with six displacements of each slide
/// and of the platform as unknowns.
TEST(Elasticity, OfSlidesWithPairsOfRods) {
  std::mt19937 random(4);
  const auto mechanism = read(elastic_linear_delta(""));
  const std::vector<double> design = nominal(mechanism->info());
  for (const std::vector<double>& at : random_poses(*mechanism, design, random)) {
    const Vector3d x(at[0], at[1], at[2]);
    const std::string& mode = mechanism->info().modes.front();
    const PoseReport report = mechanism->inspect(design, pose_at(at), mode, no_limits(mechanism->info()));
    MatrixXd K = MatrixXd::Zero(24, 24);  // the platform, then the slides
    for (int limb = 0; limb < 3; ++limb) {
      const double q = (*report.joints)[static_cast<std::size_t>(limb)];
      const auto [S, B, side] = geometry(design, x, q, limb);
      const Vector3d f = (B - S).normalized(), e = Vector3d::UnitZ();
      const int of_slide = 6 * (limb + 1);
      Matrix6d slide = cantilever(e, q);
      slide(2, 2) += 1 / kDrive;
      K.block<6, 6>(of_slide, of_slide) += slide.inverse();
      for (const double sign : {-1., 1.}) {
        const Vector3d offset = sign * kSpacing / 2 * side;
        Eigen::RowVectorXd elongation = Eigen::RowVectorXd::Zero(24);
        elongation.segment<3>(0) = f;
        elongation.segment<3>(3) = (B + offset - x).cross(f);
        elongation.segment<3>(of_slide) = -f;
        elongation.segment<3>(of_slide + 3) = -offset.cross(f);
        K += kYoung * kRod.area / design[2] * elongation.transpose() * elongation;
      }
    }
    const Matrix6d expected = K.inverse().topLeftCorner<6, 6>();
    const PlatformCompliance found = mechanism->elasticity()->compliance(design, pose_at(at), mode);
    ASSERT_TRUE(found.is_complete());
    EXPECT_LT((eigen_of(found.compliance) - expected).norm(), 1e-8 * expected.norm());
    EXPECT_LE(1 / Eigen::SelfAdjointEigenSolver<Matrix3d>(expected.topLeftCorner<3, 3>()).eigenvalues()[2],
              value_in(report, mechanism->info(), "stiffness") * (1 + 1e-9));
  }
}

/// Only the drives of a five-bar are elastic, and forces normal to its plane are statically indeterminate: these do not
/// change the compliance in the plane.
TEST(Elasticity, OfAnOverconstrainedMechanismWithRigidLinks) {
  std::string text = text_of_mechanism("five-bar");
  for (const char* const word : {"crank_mass", "rod_mass", "mass"}) text = without(text, word);
  text = replaced(text, "[platform]", "[platform]\nmass = \"1 kg\"");
  const auto mechanism = read(replaced(text, "drive    = \"crank\"", "drive = \"crank\"\ndrive_stiffness = 1000"));
  const std::vector<double> design = design_with(mechanism->info(), {{"d", .1375}, {"l_a", .23}, {"l_b", .23}});
  const std::vector<double> at = {0, .3};
  const std::string& mode = mechanism->info().modes.front();
  const PlatformCompliance found = mechanism->elasticity()->compliance(design, pose_at(at), mode);
  ASSERT_TRUE(found.is_complete());
  const double softest = value_at(*mechanism, design, at, "stiffness");
  const MatrixXd C = eigen_of(found.compliance);
  EXPECT_NEAR(1 / Eigen::SelfAdjointEigenSolver<MatrixXd>(C.topLeftCorner(2, 2)).eigenvalues()[1], softest,
              1e-9 * softest);
  EXPECT_EQ(C(2, 2), 0);
  EXPECT_EQ(C(5, 5), 0);
}

}  // namespace
}  // namespace pkm::test
