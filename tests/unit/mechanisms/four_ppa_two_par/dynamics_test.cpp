// Dynamics of 4PPa-2PaR: against point masses whose places are written down anew and followed by differences, against
// the balance of power, and its surveys of coupling indices against each other.
#include "engine/mechanisms/four_ppa_two_par/dynamics.hpp"

#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/dynamics/coupling.hpp"
#include "engine/math/statistics.hpp"
#include "engine/mechanisms/four_ppa_two_par/coupling.hpp"
#include "tests/unit/contracts/slopes.hpp"
#include "tests/unit/mechanisms/four_ppa_two_par/golden.hpp"

namespace pkm::testing {
namespace {

using namespace four_ppa_two_par;
using Vector3 = Eigen::Vector3d;
using Vector4 = Vector<double, 4>;

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

pkm::PoseDynamics<double> dynamics(const std::vector<double>& p, const Vector4& X, const Vector4& V, int mode) {
  const pkm::MotionState<double> state{X, V};
  pkm::PoseDynamics<double> d;
  four_ppa().dynamics()->equations(std::span<const double>(p), kModes[mode], {&state, 1}, {&d, 1});
  return d;
}

/// A random design with every mass changed, a payload off the centre, and a pose away from singularities.
struct Drawn {
  std::vector<double> p;
  Vector4 X, V;
  int mode;
};

bool regular(const Geometry<double>& g, const Vector4& X, int mode) {
  const auto branch = [&](int bit) { return mode & bit ? Branch::upper : Branch::lower; };
  const auto limb = inverse(g, SchoenfliesPose<double>{X[0], X[1], X[2], X[3]}, {branch(2), branch(1)});
  bool good = limb.assembles;
  for (std::size_t j = 0; j < 2 && good; ++j)
    good = limb.sigma[j] > 0.2 * g.l_d && limb.h[j] > 0.2 * g.l_u && std::fabs(limb.z_c[j]) > 0.1 * g.l_u;
  const double turn = mode == 0 || mode == 3 ? limb.x[0] * limb.sigma[1] + limb.x[1] * limb.sigma[0]
                                             : limb.x[0] * limb.sigma[1] - limb.x[1] * limb.sigma[0];
  return good && std::fabs(turn) > 0.1 * g.l_d * g.l_d && std::fabs(std::cos(X[3])) > 0.2;
}

std::vector<Drawn> random_states(int count, unsigned seed) {
  Uniform uniform(seed);
  std::vector<Drawn> all;
  while (static_cast<int>(all.size()) < count) {
    Drawn s{nominal(), {}, {}, static_cast<int>(all.size() % 4)};
    for (double& value : s.p) value *= uniform(0.7, 1.4);
    s.p[kKappa] = uniform(0.6, 1.2);
    s.p[kPayload] = uniform(0, 2);
    s.p[kPayloadOffset] = uniform(-0.2, 0.2);
    const auto g = geometry(std::span<const double>(s.p));
    s.X = {{uniform(0, g.b), uniform(0.5, 1.5), uniform(-1.4, 0.9), uniform(-1.3, 1.3)}};
    s.V = {{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-3, 3)}};
    if (regular(g, s.X, s.mode)) all.push_back(s);
  }
  return all;
}

TEST(FourPpaDynamics, KineticEnergyIsThatOfThePointMasses) {
  for (const Drawn& s : random_states(400, 1)) {
    const auto d = dynamics(s.p, s.X, s.V, s.mode);
    ASSERT_TRUE(d.assembles);
    const double energy = energy_of_motion(s.p, s.X, s.V, s.mode);
    EXPECT_NEAR(kinetic_energy(d, s.V) / energy, 1, 1e-8) << kModes[s.mode];
  }
}

TEST(FourPpaDynamics, WeightIsTheSlopeOfThePointMassesPotential) {
  constexpr double kStep = 1e-6;
  for (const Drawn& s : random_states(100, 2)) {
    const auto d = dynamics(s.p, s.X, s.V, s.mode);
    for (std::size_t k = 0; k < 4; ++k) {
      Vector4 step;
      step[k] = kStep;
      const double slope = (potential(s.p, s.X + step, s.mode) - potential(s.p, s.X - step, s.mode)) / (2 * kStep);
      EXPECT_NEAR(d.G_X[k], slope, 1e-6 * (1 + std::fabs(d.G_X[2])));
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
        const double published = (*report.J)(i, c);
        EXPECT_NEAR(here.J(i, c), published, 1e-11 * (1 + std::fabs(published)));
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
          const double slope = found.v[static_cast<int>(k)];
          EXPECT_NEAR(slope, (high - low) / (2 * step), 1e-5 * (1 + std::fabs(slope) + std::fabs(found.a)))
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

// --- masses

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

TEST(FourPpaDynamics, LinksWithoutMassAreRefused) {
  const auto message = [](MassIndex index) {
    auto p = nominal();
    p[index] = 0;
    try {
      dynamics(p, {{0.4, 1.25, -1, 0}}, {}, 0);
    } catch (const std::domain_error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(message(kLambdaU), "the upper bars have no positive mass: lambda_u l_u = 0 kg");
  EXPECT_EQ(message(kLambdaD), "the lower bars have no positive mass: lambda_d l_d = 0 kg");
  EXPECT_EQ(message(kLambdaS), "the sliders have no positive mass: lambda_s (2 d_0 + d_u) = 0 kg");
  EXPECT_EQ(message(kLambdaP), "the platform has no positive mass: lambda_p a = 0 kg");
  EXPECT_EQ(message(kKappa), "the upper bars have no positive inertia: kappa lambda_u l_u^3 / 12 = 0 kg m^2");
  EXPECT_EQ(message(kJoints), "accepted");
  auto p = nominal();
  p[kLambdaU] = 0;  // no survey of inertia, no question of masses
  EXPECT_GT(survey(p, columns(no_limits(four_ppa().info()))).volume, 0);
  EXPECT_THROW(survey(p, columns(no_limits(four_ppa().info())), {.fields = {&kCouplingIndex}}), std::domain_error);
}

// --- surveys of coupling

TEST(FourPpaCoupling, KernelEqualsTheEquationsOfMotion) {
  int compared = 0;
  for (const Drawn& s : random_states(800, 7)) {
    if (s.mode != 0) continue;
    const auto g = geometry(std::span<const double>(s.p));
    const auto limb =
        inverse(g, SchoenfliesPose<double>{s.X[0], s.X[1], s.X[2], s.X[3]}, {Branch::lower, Branch::lower});
    const auto [sine, cosine] = sincos(s.X[3]);
    const auto fast = four_ppa_two_par::joint_inertia(g, masses(std::span<const double>(s.p)), sine, cosine, limb.x,
                                                      limb.sigma, limb.z_c);
    const auto full = pkm::joint_inertia(dynamics(s.p, s.X, s.V, 0));
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR(fast(i, j), full(i, j), 1e-11 * full(i, i));
    ++compared;
  }
  EXPECT_EQ(compared, 200);
}

const Demand kAll{.fields = {&kConditioning, &kCouplingIndex, &kInertiaCondition}, .poses = true};

TEST(FourPpaCoupling, WhereInertiaHasNoValueTheWorstIsTaken) {
  auto M = Matrix<double, 4, 4>::identity();
  const auto values = [&M] {
    Survey<double> survey;
    survey.clear(kAll.fields);
    add_inertia(M, survey);
    return std::array{survey.of(kCouplingIndex)[0], survey.of(kInertiaCondition)[0]};
  };
  EXPECT_EQ(values(), (std::array{0.0, 1.0}));
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    M(2, 1) = M(1, 2) = bad;
    EXPECT_EQ(values(), (std::array{1.0, 0.0}));
  }
}

/// A design whose payload makes all four joints differ.
std::vector<double> lopsided() {
  auto p = nominal();
  p[kPayload] = 2;
  p[kPayloadOffset] = 0.08;
  return p;
}

LimitSpec away() {
  LimitSpec spec = no_limits(four_ppa().info());
  const double given[] = {0.15, 0.15, 1.3, 0.08, 0.3, 0.3};
  std::ranges::copy(given, spec.given.begin());
  return spec;
}

void expect_lengths(const Survey<double>& s) {
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(s.of(kCouplingIndex, i).size(), s.weight.size());
  EXPECT_EQ(s.of(kInertiaCondition).size(), s.weight.size());
  EXPECT_EQ(s.of(kConditioning).size(), s.weight.size());
  EXPECT_EQ(s.pose.size(), s.weight.size());
}

/// Every sample of a column survey is what the equations of motion give at its pose, and feasible.
void expect_poses(const std::vector<double>& p, const Survey<double>& s, const LimitSpec& limits) {
  ASSERT_GT(s.pose.size(), 100u);
  for (std::size_t k = 0; k < s.pose.size(); k += 17) {
    const pkm::Pose<double>& at = s.pose[k];
    const auto M = joint_inertia(dynamics(p, fixed<4>(at), {}, 0));
    const AxisVector<double> index = coupling_indices(M);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(s.of(kCouplingIndex, i)[k], index[i], 1e-8);
    EXPECT_NEAR(s.of(kInertiaCondition)[k], inertia_condition(M), 1e-8);
    const PoseReport report = four_ppa().inspect(p, at, "lower,lower", limits);
    EXPECT_TRUE(report.feasible) << report.reason;
    EXPECT_NEAR(s.of(kConditioning)[k], *report.conditioning, 1e-8);
  }
}

void expect_alike(const Survey<double>& exact, const Survey<double>& cells, double accuracy) {
  expect_lengths(exact);
  expect_lengths(cells);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(weighted_mean(cells.weight, cells.of(kCouplingIndex, i)),
                weighted_mean(exact.weight, exact.of(kCouplingIndex, i)), accuracy)
        << i;
  EXPECT_NEAR(weighted_mean(cells.weight, cells.of(kInertiaCondition)),
              weighted_mean(exact.weight, exact.of(kInertiaCondition)), accuracy);
}

TEST(FourPpaCoupling, VoxelsConvergeToColumns) {
  const auto p = lopsided();
  for (const double y : {1.25, 0.55, 1.9}) {  // both limbs free or alike; one or the other short of stroke
    const HeldCoordinate held = at_y(y);
    const auto exact = survey(p, columns(away(), held), kAll);
    expect_alike(exact, survey(p, voxels(away(), {50, 56, 60}, held), kAll), 2e-3);
    double sum = 0;
    for (const double w : exact.weight) sum += w;
    EXPECT_NEAR(sum, exact.volume, 1e-4 * exact.volume);
    expect_poses(p, exact, away());
    // the joints do differ, so the comparison tells them apart
    EXPECT_GT(std::fabs(weighted_mean(exact.weight, exact.of(kCouplingIndex, 0)) -
                        weighted_mean(exact.weight, exact.of(kCouplingIndex, 2))),
              0.006);
  }
}

TEST(FourPpaCoupling, IntegratedOverY) {
  auto p = lopsided();
  p[kL0] = 1.4;
  const SurveyPlan cells = voxels(away(), {24, 28, 30}, over_y(24));
  const auto exact = survey(p, columns(away(), over_y(), 1e-8), kAll);
  expect_alike(exact, survey(p, cells, kAll), 4e-3);
  double sum = 0;
  for (const double w : exact.weight) sum += w;
  EXPECT_NEAR(sum, exact.volume, 1e-2 * exact.volume);
}

TEST(FourPpaCoupling, ASampleIsWhatThePoseHas) {
  const auto p = lopsided();
  const auto cells = voxels(away(), {9, 10, 11});
  const auto found = survey(p, cells, kAll);
  const VoxelMap map = voxel_map(four_ppa(), p, cells);
  std::size_t sample = 0;
  for (std::int64_t k = 0; k < 11; ++k)
    for (std::int64_t i = 0; i < 9; ++i)
      for (std::int64_t j = 0; j < 10; ++j) {
        if (!map.feasible[static_cast<std::size_t>((i * 10 + j) * 11 + k)]) continue;
        const auto centre = [&](int axis, std::int64_t index, double count) {
          return map.lower[axis] + (static_cast<double>(index) + 0.5) * (map.upper[axis] - map.lower[axis]) / count;
        };
        const auto M = joint_inertia(dynamics(p, {{centre(0, i, 9), 1.25, centre(1, j, 10), centre(2, k, 11)}}, {}, 0));
        const AxisVector<double> index = coupling_indices(M);
        ASSERT_LT(sample, found.weight.size());
        for (std::size_t joint = 0; joint < 4; ++joint)
          EXPECT_NEAR(found.of(kCouplingIndex, joint)[sample], index[joint], 1e-9);
        EXPECT_NEAR(found.of(kInertiaCondition)[sample], inertia_condition(M), 1e-9);
        EXPECT_NEAR(found.pose[sample][3], centre(2, k, 11), 1e-12);
        ++sample;
      }
  EXPECT_EQ(sample, found.weight.size());
  EXPECT_GT(sample, 50u);
}

TEST(FourPpaCoupling, OnlyWhatIsDemandedAndTheSameConditioning) {
  const auto plan = columns(away());
  const auto plain = survey(nominal(), plan, {.fields = {&kConditioning}}), all = survey(nominal(), plan, kAll),
             indices = survey(nominal(), plan, {.fields = {&kCouplingIndex}});
  EXPECT_TRUE(plain.of(kCouplingIndex, 0).empty() && plain.of(kInertiaCondition).empty());
  EXPECT_TRUE(indices.of(kConditioning).empty() && indices.of(kInertiaCondition).empty());
  EXPECT_EQ(indices.of(kCouplingIndex, 3), all.of(kCouplingIndex, 3));
  EXPECT_NEAR(weighted_mean(all.weight, all.of(kConditioning)), weighted_mean(plain.weight, plain.of(kConditioning)),
              1e-12);
  // Without an uneven payload the joints change places under mirroring, and have the same mean.
  for (std::size_t i = 1; i < 4; ++i)
    EXPECT_NEAR(weighted_mean(all.weight, all.of(kCouplingIndex, i)),
                weighted_mean(all.weight, all.of(kCouplingIndex, 0)), 1e-12);
}

TEST(FourPpaCoupling, AnotherModeIsRefused) {
  const auto plan = columns(away());
  EXPECT_NO_THROW(prepare_survey(four_ppa(), plan, {.fields = {&kCouplingIndex}, .mode = "lower,lower"}));
  try {
    prepare_survey(four_ppa(), plan, {.fields = {&kInertiaCondition}, .mode = "upper,upper"});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "workspaces of mechanism 4ppa-2par are of the working mode lower,lower, so inertia is not surveyed in "
                 "the mode upper,upper");
  }
}

TEST(FourPpaCoupling, DerivativesOfMeansEqualDifferences) {
  Uniform uniform(8);
  int compared = 0, missing = 0;
  for (int k = 0; k < 12; ++k) {
    auto design = lopsided();
    std::vector<double> direction;
    for (double& value : design) value *= uniform(0.9, 1.1);
    for (const double value : design) direction.push_back(value * uniform(-1, 1));
    SurveyPlan plan = columns(away(), at_y(k % 2 ? 0.6 : design[kL0] / 2));
    column_options(plan).nodes = {3, 3};
    const auto surveyor = prepare_survey(four_ppa(), plan, kAll);
    const auto means = [&](double t) {
      std::vector<Dual4> p;
      for (std::size_t i = 0; i < design.size(); ++i) {
        p.emplace_back(design[i] + t * direction[i]);
        p.back().v[0] = direction[i];
      }
      Survey<Dual4> found;
      survey_once<Dual4>(*surveyor, p, found);
      std::vector<Dual4> all;
      for (std::size_t i = 0; i < 4; ++i) all.push_back(weighted_mean(found.weight, found.of(kCouplingIndex, i)));
      all.push_back(weighted_mean(found.weight, found.of(kInertiaCondition)));
      return all;
    };
    const auto here = means(0);
    std::vector<double> scale;
    for (const Dual4& mean : here) scale.push_back(std::fmax(std::fabs(mean.v[0]), 0.1 * mean.a));
    const auto slopes = test::differences(
        [&](double t) {
          std::vector<double> values;
          for (const Dual4& mean : means(t)) values.push_back(mean.a);
          return values;
        },
        scale);
    for (std::size_t i = 0; i < here.size(); ++i, ++compared) {
      if (slopes[i])
        EXPECT_NEAR(here[i].v[0], *slopes[i], 1e-6 * scale[i]);
      else
        ++missing;  // an entry of M_q changes its sign at a node within the least steps
    }
  }
  EXPECT_EQ(compared, 60);
  EXPECT_LE(missing, 6);
}

}  // namespace
}  // namespace pkm::testing
