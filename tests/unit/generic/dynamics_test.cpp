// Equations of motion of mechanisms from files: their laws for every file with masses, and masses that a designer can
// tell by hand. PKM_POWER_STATES: how many random states of each the balance of power is tried on.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/dynamics/simulation.hpp"
#include "engine/math/random.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm {
namespace {

template <class S>
PoseDynamics<S> dynamics_of(const Mechanism& mechanism, const std::vector<S>& design, const std::string& mode,
                            const MotionState<S>& state) {
  PoseDynamics<S> d;
  mechanism.dynamics()->equations(std::span<const S>(design), mode, {&state, 1}, {&d, 1});
  return d;
}
template <class S, class M>
M of_scalar(const MatrixUpTo<double, kMaxJoints>& values) {
  M same(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) same[i] = S(values[i]);
  return same;
}

class DescribedDynamics : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!mechanism().dynamics()) GTEST_SKIP() << info().name << " has no masses";
  }
  const Mechanism& mechanism() const { return *test::described(GetParam()); }
  const MechanismInfo& info() const { return mechanism().info(); }
  std::size_t size() const { return info().coordinates.size(); }

  /// Feasible poses of the default design, spread over the workspace.
  std::vector<Pose<double>> poses(std::size_t most) const {
    const std::vector<double> design = test::nominal(info());
    const auto ranges = *mechanism().ranges(design);
    Stream random(31, 0, 0, Stream::Use::start);
    std::vector<Pose<double>> found;
    for (std::size_t tried = 0; tried < 400 * std::max<std::size_t>(most, 1000) && found.size() < most; ++tried) {
      Pose<double> pose(size());
      for (std::size_t i = 0; i < size(); ++i)
        pose[i] = (ranges[i][0] + ranges[i][1]) / 2 +
                  (info().coordinates[i].turns() ? 0.2 : 0.8) * (random.u01() - 0.5) * (ranges[i][1] - ranges[i][0]);
      const PoseReport report = mechanism().inspect(design, pose, info().modes.front(), no_limits(info()));
      if (report.feasible && report.conditioning.value_or(1) > 0.02) found.push_back(pose);
    }
    return found;
  }
  AxisVector<double> some(std::size_t seed, double scale) const {
    Stream random(seed, 0, 0, Stream::Use::start);
    AxisVector<double> v(size());
    for (double& x : v) x = scale * (2 * random.u01() - 1);
    return v;
  }
};

// Power in is power out: tau . qdot is the rate of the kinetic energy and of the height's, less what the wrench brings.
// The kinetic energy's rate is that of derivative scalars, of which h_X knows nothing.
TEST_P(DescribedDynamics, PowerOfTheDrivesIsTheRateOfTheEnergy) {
  const std::vector<double> design = test::nominal(info());
  const std::vector<Dual4> moving_design(design.begin(), design.end());
  const char* const asked = std::getenv("PKM_POWER_STATES");
  const std::size_t states = asked ? static_cast<std::size_t>(std::atoi(asked)) : 300;
  const std::vector<Pose<double>> found = poses(states);
  ASSERT_GE(found.size(), states / 5);
  double worst = 0;
  for (std::size_t k = 0; k < found.size(); ++k) {
    const AxisVector<double> v = some(k, 1.5), a = some(k + 1'000'000, 8);
    const Wrench<double> wrench{{3, -4, 5, 0.6, -0.5, 0.4}};
    MotionState<Dual4> moving{of_scalar<Dual4, Pose<Dual4>>(found[k]), of_scalar<Dual4, AxisVector<Dual4>>(v)};
    for (std::size_t i = 0; i < size(); ++i) {  // by the time, variable 0
      moving.pose[i].v[0] = v[i];
      moving.velocity[i].v[0] = a[i];
    }
    const PoseDynamics<double> d = dynamics_of<double>(mechanism(), design, info().modes.front(), {found[k], v});
    const PoseDynamics<Dual4> in_time = dynamics_of(mechanism(), moving_design, info().modes.front(), moving);
    ASSERT_TRUE(d.assembles && in_time.assembles);
    if (is_singular(d.J)) continue;
    const AxisVector<double> tau = drive_forces(d, a, wrench), speeds = d.J * v;
    double in = 0, largest = 0;
    for (std::size_t i = 0; i < tau.size(); ++i) {
      in += tau[i] * speeds[i];
      largest = std::fmax(largest, std::fabs(tau[i] * speeds[i]));
    }
    const double out =
        kinetic_energy(in_time, moving.velocity).v[0] + dot(d.G_X, v) - dot(transpose(d.J_wrench) * wrench, v);
    worst = std::fmax(worst, std::fabs(in - out) / largest);
  }
  RecordProperty("states", static_cast<int>(found.size()));
  RecordProperty("worst", std::to_string(worst * 1e12) + "e-12");
  EXPECT_LT(worst, 1e-9);
}

// h_X = sum of (dM_ij/dX_k - dM_jk/dX_i / 2) Xdot_j Xdot_k (Lagrange), with derivatives of M_X by derivative scalars.
TEST_P(DescribedDynamics, CentrifugalForcesFollowFromTheInertia) {
  const std::vector<double> design = test::nominal(info());
  const std::vector<Dual4> dual_design(design.begin(), design.end());
  const std::size_t n = size();
  for (const Pose<double>& pose : poses(30)) {
    const AxisVector<double> v = some(7, 2);
    AxisVector<double> expected(n);
    for (std::size_t first = 0; first < n; first += 4) {
      MotionState<Dual4> state{of_scalar<Dual4, Pose<Dual4>>(pose), AxisVector<Dual4>(n)};
      for (std::size_t k = first; k < std::min(first + 4, n); ++k) state.pose[k].v[static_cast<int>(k - first)] = 1;
      const PoseDynamics<Dual4> d = dynamics_of(mechanism(), dual_design, info().modes.front(), state);
      for (std::size_t k = first; k < std::min(first + 4, n); ++k)
        for (std::size_t i = 0; i < n; ++i)
          for (std::size_t j = 0; j < n; ++j) {
            const double slope = d.M_X(i, j).v[static_cast<int>(k - first)];
            expected[i] += slope * v[j] * v[k];
            expected[k] -= 0.5 * slope * v[i] * v[j];
          }
    }
    const PoseDynamics<double> d = dynamics_of<double>(mechanism(), design, info().modes.front(), {pose, v});
    double largest = 0;
    for (const double h : expected) largest = std::fmax(largest, std::fabs(h));
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(d.h_X[i], expected[i], 1e-10 * std::fmax(largest, 1e-9));
  }
}

TEST_P(DescribedDynamics, StatesOfARowHaveTheBitsOfOneByOne) {
  const std::vector<double> design = test::nominal(info());
  std::vector<MotionState<double>> states;
  for (const Pose<double>& pose : poses(90)) states.push_back({pose, some(states.size(), 1)});
  states[3].pose[0] = std::nan("");
  std::vector<PoseDynamics<double>> found(states.size());
  mechanism().dynamics()->equations(std::span<const double>(design), info().modes.front(), states, found);
  EXPECT_FALSE(found[3].assembles);
  for (std::size_t k = 0; k < states.size(); ++k) {
    const PoseDynamics<double> one = dynamics_of<double>(mechanism(), design, info().modes.front(), states[k]);
    ASSERT_EQ(one.assembles, found[k].assembles);
    if (!one.assembles) continue;
    EXPECT_TRUE(one.J == found[k].J && one.M_X == found[k].M_X && one.h_X == found[k].h_X && one.G_X == found[k].G_X &&
                one.J_rate_X == found[k].J_rate_X && one.J_wrench == found[k].J_wrench);
  }
}

TEST_P(DescribedDynamics, SimulationsKeepTheirEnergy) {
  const std::vector<double> design = test::nominal(info());
  const Pose<double> start = poses(1).front();
  const auto at_rest =
      dynamics_of<double>(mechanism(), design, info().modes.front(), {start, AxisVector<double>(size())});
  const AxisVector<double> hold = drive_forces(at_rest, AxisVector<double>(size()), {});
  const SimulationSetup setup{.dynamics =
                                  [&](const MotionState<double>& state) {
                                    return dynamics_of<double>(mechanism(), design, info().modes.front(), state);
                                  },
                              .forces = [&](double time) { return hold * (1 + 0.1 * std::sin(20 * time)); },
                              .wrench = Wrench<double>{{0.3, 0.2, -0.1, 0.01, 0.02, 0.03}},
                              .refuse = {},
                              .duration = 0.05,
                              .step = 0.001};
  const Simulation run = simulate(setup, start, some(3, 0.05));
  EXPECT_EQ(run.stopped, "");
  EXPECT_EQ(run.states.size(), 51u);
  EXPECT_LE(run.imbalance, 1e-9 * run.turned_over);
  EXPECT_GT(run.turned_over, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(All, DescribedDynamics, ::testing::ValuesIn(test::mechanism_files()),
                         [](const auto& name) { return test::test_name(name.param); });

/// A gantry: the platform follows three slides, and turns as three more joints say.
std::string gantry(const std::string& masses) {
  return R"(
[mechanism]
name = "gantry"
[parameters]
l = { default = "0.5 m", min = "0.1 m", max = "2 m" }
m = { default = "3 kg", min = "-5 kg", max = "5 kg" }
[platform]
coordinates = { x = "along x", y = "along y", z = "along z", alpha = "about x", beta = "about y", gamma = "about z" }
characteristic_length = 1
)" + masses +
         R"(
[survey]
box = { x = [-1, 1], y = [-1, 1], z = [-1, 1] }
[[limb]]
name = "all"
drive = "formula"
joints = { q1 = "x", q2 = "y", q3 = "z", q4 = "alpha", q5 = "beta", q6 = "gamma" }
)";
}

PoseDynamics<double> of_gantry(const std::string& masses, const Pose<double>& pose, const AxisVector<double>& v) {
  const auto mechanism = read_mechanism_toml(gantry(masses), "gantry.toml");
  return dynamics_of<double>(*mechanism, test::nominal(mechanism->info()), "unique", {pose, v});
}

// omega = (rates about moving axes), E = m v^2 / 2 + omega . I omega / 2, Euler's gyroscopic moment.
TEST(DescribedBodies, APlatformIsARigidBodyInSpace) {
  const Pose<double> pose = {0.1, -0.2, 0.3, 0.5, -0.4, 0.8};
  const AxisVector<double> v = {0, 0, 0, 0.7, -1.1, 0.9};
  const auto d = of_gantry("mass = \"m\"\ninertia = [0.02, 0.03, 0.04]\n", pose, v);
  using Three = Matrix<double, 3, 3>;
  const auto turn = [](std::size_t axis, double angle) {
    Three R = Three::identity();
    const std::size_t i = (axis + 1) % 3, j = (axis + 2) % 3;
    R(i, i) = R(j, j) = std::cos(angle);
    R(j, i) = std::sin(angle);
    R(i, j) = -std::sin(angle);
    return R;
  };
  const Three A = turn(0, 0.5), AB = A * turn(1, -0.4), R = AB * turn(2, 0.8);
  Three principal;
  for (std::size_t k = 0; k < 3; ++k) principal(k, k) = 0.02 + 0.01 * static_cast<double>(k);
  const Three I = R * principal * transpose(R);
  Matrix<double, 3, 3> J;
  for (std::size_t row = 0; row < 3; ++row) {
    J(row, 0) = row == 0;
    J(row, 1) = A(row, 1);
    J(row, 2) = AB(row, 2);
  }
  const Three M = transpose(J) * I * J;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_NEAR(d.M_X(3 + i, 3 + j), M(i, j), 1e-15);
      EXPECT_NEAR(d.J_wrench(3 + i, 3 + j), J(i, j), 1e-15);
      EXPECT_NEAR(d.M_X(i, j), i == j ? 3 : 0, 1e-15);
    }
  EXPECT_NEAR(d.G_X[2], 3 * kGravity, 1e-12);
  const Vector<double, 3> rates{{0.7, -1.1, 0.9}}, omega = J * rates;
  const auto column = [](const Three& m, std::size_t k) { return Vector<double, 3>{{m(0, k), m(1, k), m(2, k)}}; };
  const Vector<double, 3> ex{{1, 0, 0}};
  const Vector<double, 3> bias =
      cross(ex * 0.7, column(A, 1) * -1.1) + cross(ex * 0.7 + column(A, 1) * -1.1, column(AB, 2) * 0.9);
  const Vector<double, 3> h = transpose(J) * (I * bias + cross(omega, I * omega));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(d.h_X[3 + i], h[i], 1e-14);
}

/// The mass that drive forces lift, and the inertia about y through the origin: of a part of a crank turned by q.
std::pair<double, double> of_crank(const std::string& keys) {
  const auto mechanism = read_mechanism_toml(R"toml(
[mechanism]
name = "lever"
[parameters]
l = { default = "0.4 m", min = "0.1 m", max = "2 m" }
[platform]
coordinates = { phi = "about y" }
[[limb]]
name = "arm"
drive = "crank"
base = [0, 0, 0]
axis = [0, -1, 0]
zero = [1, 0, 0]
crank = "l"
rod = "0.7 m"
end = ["0.4*cos(phi) + 0.7", 0, "0.4*sin(phi)"]
branch = "+"
)toml" + keys,
                                             "lever.toml");
  const auto d = dynamics_of<double>(*mechanism, test::nominal(mechanism->info()), "+", {{0.3}, {0.0}});
  return {d.G_X[0] / (kGravity * 0.2 * std::cos(0.3)), d.M_X(0, 0)};
}

TEST(DescribedBodies, MassesFollowLengthsAndCrossSections) {
  const auto [mass, inertia] = of_crank("crank_mass = \"0.6 kg\"\n");
  EXPECT_NEAR(mass, 0.6, 1e-12);
  EXPECT_NEAR(inertia, 0.6 * 0.4 * 0.4 / 3, 1e-12);
  EXPECT_NEAR(of_crank("crank_mass_per_length = \"2 kg/m\"\n").first, 0.8, 1e-12);
  EXPECT_NEAR(of_crank("crank_mass = \"0.6 kg\"\ncrank_inertia = 0.05\n").second, 0.6 * 0.04 + 0.05, 1e-12);
  const double area = kPi / 4 * (0.03 * 0.03 - 0.02 * 0.02), tube = 7800 * area * 0.4;
  const auto section = of_crank("crank_section = { density = 7800, outer = \"30 mm\", inner = \"20 mm\" }\n");
  EXPECT_NEAR(section.first, tube, 1e-12);
  EXPECT_NEAR(section.second, tube * (0.4 * 0.4 / 3 + (0.03 * 0.03 + 0.02 * 0.02) / 16), 1e-12);
  const auto rod = of_crank("crank_section = { density = 7800, outer = \"30 mm\" }\n");
  EXPECT_NEAR(rod.first, 7800 * kPi / 4 * 0.03 * 0.03 * 0.4, 1e-12);
  // the rod stays parallel to x: it only goes round
  EXPECT_NEAR(of_crank("rod_mass = \"0.5 kg\"\n").second, 0.5 * 0.4 * 0.4, 1e-12);
}

TEST(DescribedBodies, WhatIsNotPositiveIsRefusedByName) {
  const auto mechanism = read_mechanism_toml(gantry("mass = \"m\"\n"), "gantry.toml");
  try {
    dynamics_of<double>(*mechanism, {0.5, -2}, "unique", {Pose<double>(6), AxisVector<double>(6)});
    FAIL() << "a negative mass is taken";
  } catch (const DesignError& error) {
    EXPECT_STREQ(error.what(), "the mass of the platform is not positive: -2 kg");
  }
  EXPECT_TRUE(why_no_joint_forces(*read_mechanism_toml(gantry(""), "gantry.toml")));
}

TEST(DescribedBodies, ABodyTurnsWithALinkOrThePlatformOrNotAtAll) {
  const std::string link =
      "\n[[link]]\nname = \"stick\"\nfrom = [0, 0, 0]\nto = [\"cos(gamma)\", \"sin(gamma)\", 0]\n"
      "radius = 0.01\n";
  const auto with = [&](const std::string& keys) {
    const auto mechanism = read_mechanism_toml(
        gantry("mass = 1\n") + link + "[[body]]\nname = \"load\"\ncentre = [\"x\", 0, 0]\n" + keys, "gantry.toml");
    return dynamics_of<double>(*mechanism, test::nominal(mechanism->info()), "unique",
                               {{0.1, 0, 0, 0, 0, 0.4}, AxisVector<double>(6)})
        .M_X;
  };
  EXPECT_NEAR(with("mass = 2\n")(0, 0), 3, 1e-15);
  EXPECT_NEAR(with("mass = 2\ninertia = [1, 2, 4]\n")(5, 5), 0, 1e-15);
  EXPECT_NEAR(with("mass = 2\ninertia = [1, 2, 4]\nrotation = \"platform\"\n")(5, 5), 4, 1e-14);
  EXPECT_NEAR(with("mass = 2\ninertia = [1, 2, 2]\nrotation = \"stick\"\n")(5, 5), 2, 1e-14);
  EXPECT_NEAR(with("mass = 2\ninertia = [1, 2, 2]\nrotation = \"stick\"\n")(3, 3), 0, 1e-14);
}

}  // namespace
}  // namespace pkm
