// Equations of motion of 4PPa-2PaR: against point masses whose positions are stated here and differentiated by
// differences, and against the balance of power. Masses of the accelerator.
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>
#include <Eigen/Core>

#include "engine/accelerators/four_ppa_two_par/masses.hpp"
#include "engine/dynamics/coupling.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/golden.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/random_states.hpp"

namespace pkm::testing {
namespace {

using namespace four_ppa_two_par;
using Vector3 = Eigen::Vector3d;

struct PointMass {
  double mass;
  Vector3 at;
};

/// Every link as points of the same mass, centre and inertia; kappa and kappa_p say how far apart.
std::vector<PointMass> point_masses(const std::vector<double>& p, const Vector4& X, int mode) {
  const double a = p[kA], b = p[kB], lu = p[kLu], ld = p[kLd], d = p[kD];
  std::vector<PointMass> all;
  const auto rod = [&](double mass, const Vector3& from, const Vector3& to, double kappa) {
    const Vector3 middle = (from + to) / 2, half = (to - from) * std::sqrt(kappa / 12);
    all.push_back({mass / 2, middle - half});
    all.push_back({mass / 2, middle + half});
  };
  const Vector3 centre(X[0], X[1], X[2]), arm(std::cos(X[3]), std::sin(X[3]), 0);
  const double slider = p[kLambdaS] * (2 * p[kD0] + p[kDu]);
  const double upper_connector = p[kLambdaU] * p[kDu] + p[kLambdaD] * p[kDd] + p[kJoints];
  const double lower_connector = p[kLambdaD] * std::max(d, p[kDd]) + p[kJoints];
  for (int j = 0; j < 2; ++j) {
    const double sign = j == 0 ? -1 : 1, rail = j == 0 ? 0 : b;
    const bool upper = mode & (j == 0 ? 2 : 1);
    const Vector3 P = centre + sign * a / 2 * arm, D = P + Vector3(0, 0, d);
    const double reach = D.x() - rail, rise = std::sqrt(ld * ld - reach * reach);
    const Vector3 C(rail, D.y(), D.z() + (upper ? -rise : rise));
    const double h = std::sqrt(lu * lu - C.z() * C.z());
    for (const double side : {-1.0, 1.0}) {
      const Vector3 B(rail, C.y() + side * h, 0), along_y(0, p[kDu] / 2, 0);
      all.push_back({slider, B});
      for (const double bar : {-1.0, 1.0}) rod(p[kLambdaU] * lu, B + bar * along_y, C + bar * along_y, p[kKappa]);
    }
    all.push_back({upper_connector, C});
    all.push_back({lower_connector, D});
    const Vector3 down(0, 0, -p[kDd]);
    rod(p[kLambdaD] * ld, C, D, p[kKappa]);
    rod(p[kLambdaD] * ld, C + down, D + down, p[kKappa]);
  }
  rod(p[kLambdaP] * a, centre - a / 2 * arm, centre + a / 2 * arm, p[kKappaP]);
  all.push_back({p[kPayload], centre + p[kPayloadOffset] * arm});
  return all;
}

/// Of the point masses, when X moves with V: kinetic energy by central differences.
double energy_of_motion(const std::vector<double>& p, const Vector4& X, const Vector4& V, int mode) {
  constexpr double kStep = 1e-6;
  const auto after = point_masses(p, X + V * kStep, mode), before = point_masses(p, X - V * kStep, mode);
  double sum = 0;
  for (std::size_t i = 0; i < after.size(); ++i)
    sum += after[i].mass * ((after[i].at - before[i].at) / (2 * kStep)).squaredNorm() / 2;
  return sum;
}

double potential(const std::vector<double>& p, const Vector4& X, int mode) {
  double sum = 0;
  for (const PointMass& point : point_masses(p, X, mode)) sum += kGravity * point.mass * point.at.z();
  return sum;
}

TEST(FourPpaDynamics, KineticEnergyIsThatOfThePointMasses) {
  for (const Drawn& s : random_states(400, 1)) {
    const auto d = dynamics(s.p, s.X, s.V, s.mode);
    ASSERT_TRUE(d.assembles);
    const double energy = energy_of_motion(s.p, s.X, s.V, s.mode);
    EXPECT_NEAR(kinetic_energy(d, s.V) / energy, 1, 1e-8) << kModes[s.mode];
  }
}

TEST(FourPpaDynamics, GravityTermsAreTheDerivativesOfThePointMassesPotential) {
  constexpr double kStep = 1e-6;
  for (const Drawn& s : random_states(100, 2)) {
    const auto d = dynamics(s.p, s.X, s.V, s.mode);
    for (std::size_t k = 0; k < 4; ++k) {
      Vector4 step;
      step[k] = kStep;
      const double expected = (potential(s.p, s.X + step, s.mode) - potential(s.p, s.X - step, s.mode)) / (2 * kStep);
      EXPECT_NEAR(d.G_X[k], expected, 1e-6 * (1 + std::fabs(d.G_X[2])));
    }
  }
}

TEST(FourPpaDynamics, JointSpeedsAndAccelerations) {
  constexpr double kStep = 1e-6;
  for (const Drawn& s : random_states(200, 3)) {
    const auto here = dynamics(s.p, s.X, s.V, s.mode), after = dynamics(s.p, s.X + s.V * kStep, s.V, s.mode),
               before = dynamics(s.p, s.X - s.V * kStep, s.V, s.mode);
    const auto speed = here.J * s.V, rate = (after.J - before.J) * s.V * (1 / (2 * kStep));
    const PoseReport report =
        four_ppa().inspect(s.p, {s.X[0], s.X[1], s.X[2], s.X[3]}, kModes[s.mode], no_limits(four_ppa().info()));
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(here.q[i], (*report.joints)[i]);
      EXPECT_NEAR(speed[i], (after.q[i] - before.q[i]) / (2 * kStep), 1e-7 * (1 + std::fabs(speed[i])));
      EXPECT_NEAR(here.J_rate_X[i], rate[i], 1e-6 * (1 + std::fabs(rate[i])));
      for (std::size_t c = 0; c < 4; ++c) {
        const double reported = (*report.J)(i, c);
        EXPECT_NEAR(here.J(i, c), reported, 1e-11 * (1 + std::fabs(reported)));
      }
    }
  }
}

TEST(FourPpaDynamics, PowerOfAllForcesIsTheRateOfEnergy) {
  Uniform uniform(4);
  constexpr double kStep = 1e-6;
  for (const Drawn& s : random_states(400, 4)) {
    Vector4 A;
    Wrench<double> wrench;
    for (std::size_t k = 0; k < 4; ++k) A[k] = uniform(-10, 10);
    for (std::size_t k = 0; k < 6; ++k) wrench[k] = uniform(-20, 20);
    const auto energy = [&](double t) {
      const Vector4 X = s.X + s.V * t + A * (t * t / 2), V = s.V + A * t;
      return kinetic_energy(dynamics(s.p, X, V, s.mode), V) + potential(s.p, X, s.mode);
    };
    const auto d = dynamics(s.p, s.X, s.V, s.mode);
    const AxisVector<double> tau = drive_forces(d, A, wrench);
    const double by_drives = dot(tau, d.J * s.V), by_wrench = dot(wrench, d.J_wrench * s.V);
    EXPECT_NEAR(by_drives + by_wrench, (energy(kStep) - energy(-kStep)) / (2 * kStep),
                1e-6 * (10 + std::fabs(by_drives)));
    const AxisVector<double> back = acceleration(d, tau, wrench);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(back[k], A[k], 1e-8);
  }
}

TEST(FourPpaDynamics, NoStateWhereThePoseDoesNotAssemble) {
  EXPECT_FALSE(dynamics(nominal(), {{0.4, 1.25, -3, 0}}, {}, 0).assembles);
  EXPECT_THROW(four_ppa().dynamics()->equations(std::span<const double>(nominal()), "low",
                                                std::span<const pkm::MotionState<double>>(),
                                                std::span<pkm::PoseDynamics<double>>()),
               std::invalid_argument);
}

TEST(FourPpaDynamics, DerivativesByEveryParameterEqualDifferences) {
  for (const Drawn& s : random_states(12, 5)) {
    for (std::size_t first = 0; first < s.p.size(); first += 4) {
      std::vector<Dual4> p(s.p.begin(), s.p.end());
      for (std::size_t k = 0; k < 4 && first + k < p.size(); ++k) p[first + k].v[static_cast<int>(k)] = 1;
      const pkm::MotionState<Dual4> state{s.X, s.V};
      pkm::PoseDynamics<Dual4> exact;
      four_ppa().dynamics()->equations(std::span<const Dual4>(p), kModes[s.mode], {&state, 1}, {&exact, 1});
      for (std::size_t k = 0; k < 4 && first + k < p.size(); ++k) {
        const double step = 1e-6;
        auto more = s.p, less = s.p;
        more[first + k] += step;
        less[first + k] -= step;
        const auto after = dynamics(more, s.X, s.V, s.mode), before = dynamics(less, s.X, s.V, s.mode);
        const auto expect = [&](const Dual4& found, double high, double low) {
          const double derivative = found.v[static_cast<int>(k)];
          EXPECT_NEAR(derivative, (high - low) / (2 * step), 1e-5 * (1 + std::fabs(derivative) + std::fabs(found.a)))
              << four_ppa().info().parameters[first + k].name;
        };
        for (std::size_t i = 0; i < 16; ++i) expect(exact.M_X[i], after.M_X[i], before.M_X[i]);
        for (std::size_t i = 0; i < 4; ++i) {
          expect(exact.h_X[i], after.h_X[i], before.h_X[i]);
          expect(exact.G_X[i], after.G_X[i], before.G_X[i]);
        }
      }
    }
  }
}

TEST(FourPpaDynamics, ScalingLaws) {
  for (const Drawn& s : random_states(50, 6)) {
    const auto M = joint_inertia(dynamics(s.p, s.X, s.V, s.mode));
    auto heavy = s.p, large = s.p;
    for (const MassIndex i : {kLambdaU, kLambdaD, kLambdaS, kLambdaP, kJoints, kPayload}) heavy[i] *= 3;
    for (std::size_t i = 0; i < kParameters; ++i) large[i] *= 2;  // masses per length stay, so masses double
    for (const MassIndex i : {kJoints, kPayload, kPayloadOffset}) large[i] *= 2;
    const Vector4 X = {{2 * s.X[0], 2 * s.X[1], 2 * s.X[2], s.X[3]}};
    const auto M_heavy = joint_inertia(dynamics(heavy, s.X, s.V, s.mode)),
               M_large = joint_inertia(dynamics(large, X, s.V, s.mode));
    const AxisVector<double> index = coupling_indices(M), index_large = coupling_indices(M_large);
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        EXPECT_NEAR(M_heavy(i, j), 3 * M(i, j), 1e-11 * M(i, i));
        EXPECT_NEAR(M_large(i, j), 2 * M(i, j), 1e-10 * M(i, i));
      }
      EXPECT_NEAR(index_large[i], index[i], 1e-10);
    }
  }
}

TEST(FourPpaDynamics, MassesOfTheNominalDesign) {
  const auto p = nominal();
  const Masses<double> b = masses(std::span<const double>(p));
  EXPECT_NEAR(b.slider, 3.393 * 0.14, 1e-12);
  EXPECT_NEAR(b.upper_bar, 0.848 * 0.6, 1e-12);
  EXPECT_NEAR(b.lower_bar, 0.848 * 0.55, 1e-12);
  EXPECT_NEAR(b.upper_connector, 0.848 * 0.16 + 0.1, 1e-12);
  EXPECT_NEAR(b.lower_connector, 0.848 * 0.15 + 0.1, 1e-12);
  EXPECT_NEAR(b.platform, 3.393 * 0.2, 1e-12);
  EXPECT_NEAR(b.I_upper, 0.848 * 0.216 / 12, 1e-12);
  double total = 0;
  for (const PointMass& point : point_masses(p, {{0.4, 1.25, -1, 0.2}}, 0)) total += point.mass;
  EXPECT_NEAR(total,
              4 * b.slider + 8 * b.upper_bar + 4 * b.lower_bar + 2 * (b.upper_connector + b.lower_connector) +
                  b.platform + b.payload,
              1e-12);
  EXPECT_EQ(four_ppa().dynamics()->mass_models(), std::vector<std::string>{"geometry"});
  EXPECT_EQ(four_ppa().dynamics()->with_masses("table"), nullptr);
  EXPECT_EQ(four_ppa().dynamics()->with_masses("geometry")->info().parameters.size(), std::size_t{kAllParameters});
}

/// What refuses a design in which one parameter is 0; "": nothing does.
template <class Use>
std::string complaint(MassIndex index, const Use& use) {
  auto p = nominal();
  p[index] = 0;
  try {
    use(p);
  } catch (const DesignError& error) {
    return error.what();
  }
  return "";
}

TEST(FourPpaDynamics, LinksWithoutMassAreRefused) {
  const auto message = [](MassIndex index) {
    return complaint(index, [](const auto& p) { dynamics(p, {{0.4, 1.25, -1, 0}}, {}, 0); });
  };
  EXPECT_EQ(message(kLambdaU), "the mass of upper bar 1 of slider 1 is not positive: 0 kg");
  EXPECT_EQ(message(kLambdaD), "the mass of lower bar 1 of limb 1 is not positive: 0 kg");
  EXPECT_EQ(message(kLambdaS), "the mass of slider 1 is not positive: 0 kg");
  EXPECT_EQ(message(kLambdaP), "the mass of the platform is not positive: 0 kg");
  EXPECT_EQ(message(kJoints), "");
}

TEST(FourPpaDynamics, LinksWithoutMassAreRefusedByTheAccelerator) {
  const auto message = [](MassIndex index) {
    return complaint(index, [](const auto& p) { masses(std::span<const double>(p)); });
  };
  EXPECT_EQ(message(kLambdaU), "the upper bars have no positive mass: lambda_u l_u = 0 kg");
  EXPECT_EQ(message(kLambdaD), "the lower bars have no positive mass: lambda_d l_d = 0 kg");
  EXPECT_EQ(message(kLambdaS), "the sliders have no positive mass: lambda_s (2 d_0 + d_u) = 0 kg");
  EXPECT_EQ(message(kLambdaP), "the platform has no positive mass: lambda_p a = 0 kg");
  EXPECT_EQ(message(kKappa), "the upper bars have no positive inertia: kappa lambda_u l_u^3 / 12 = 0 kg m^2");
  EXPECT_EQ(message(kJoints), "");
  auto p = nominal();
  p[kLambdaU] = 0;  // without fields of inertia, masses do not matter
  EXPECT_GT(survey(p, columns(no_limits(four_ppa().info()))).volume, 0);
  EXPECT_THROW(survey(p, columns(no_limits(four_ppa().info())), {.fields = {&kCouplingIndex}}), DesignError);
}

}  // namespace
}  // namespace pkm::testing
