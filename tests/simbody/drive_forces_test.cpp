// Drive forces of (3CRR/R)&CRU and the Quadrupteron against Simbody: the oscillation of the paper, quintic moves along
// x, y, z and a diagonal, and random states under wrenches, for nominal and random designs.
#include <gtest/gtest.h>

#include "tests/simbody/closed_loop.hpp"
#include "tests/unit/accelerators/crr_cru/states.hpp"

namespace pkm::simbody {
namespace {

using testing::crr::State, testing::crr::Uniform;

constexpr double kAccuracy = 1e-9;  // relative to the largest drive force of a state

Parameters parameters_of(const std::string& mechanism, const std::vector<double>& p) {
  using namespace crr_cru;
  Parameters q{};
  q.one_platform = mechanism == "quadrupteron";
  for (std::size_t i = 0; i < 4; ++i) {
    q.l_1[i] = p[kL11 + 2 * i];
    q.l_2[i] = p[kL12 + 2 * i];
    q.m_1[i] = p[kRodMass + 2 * i];
    q.m_2[i] = p[kRodMass + 2 * i + 1];
    q.I_1[i] = p[kRodInertia + 2 * i];
    q.I_2[i] = p[kRodInertia + 2 * i + 1];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    q.beta[k] = p[kBeta1 + k];
    q.I[k] = p[kInertia + k];
    q.I_middle[k] = p[kInertia1 + k];
  }
  q.r = p[kR];
  q.h = p[kH];
  q.l = p[kL];
  q.L = p[kRails];
  q.m = p[kMass];
  q.c = p[kCentre];
  q.m_middle = p[kMass1];
  q.slide = p[kSlideMass];
  q.payload = p[kPayload];
  q.c_payload = p[kPayloadOffset];
  return q;
}

/// Compares drive forces at states of one design, and records the largest difference.
class Comparison {
 public:
  Comparison(std::string mechanism, std::vector<double> design)
      : name_(std::move(mechanism)), design_(std::move(design)), loops_(parameters_of(name_, design_)) {}

  void check(State s) {
    s.parameters = design_;
    const Pose<double>& X = s.motion.pose;
    const Solution theirs =
        loops_.solve({s.mode, fixed<4>(X).m, fixed<4>(s.motion.velocity).m, fixed<4>(s.acceleration).m, s.wrench.m});
    const PoseDynamics<double> d = testing::crr::dynamics_of(name_, s);
    ASSERT_TRUE(d.assembles);
    const AxisVector<double> ours = drive_forces(d, s.acceleration, s.wrench);
    double largest = 0, error = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      largest = std::max(largest, std::fabs(theirs.drive_forces[i]));
      error = std::max(error, std::fabs(ours[i] - theirs.drive_forces[i]));
    }
    EXPECT_LE(error, kAccuracy * largest) << name_ << " at " << X[0] << ", " << X[1] << ", " << X[2] << ", " << X[3];
    worst_ = std::max(worst_, error / largest);
    // Simbody's solution satisfies the loop-closure equations and the equations of motion, and has the expected number
    // of redundant constraints.
    EXPECT_LE(theirs.closure_error, 1e-9);
    EXPECT_LE(theirs.force_error, 1e-9 * largest);
    EXPECT_EQ(theirs.constraints - theirs.constraint_rank, name_ == "quadrupteron" ? 3 : 4);
  }
  double worst() const { return worst_; }
  const std::string& name() const { return name_; }
  const std::vector<double>& design() const { return design_; }

 private:
  std::string name_;
  std::vector<double> design_;
  ClosedLoop loops_;
  double worst_ = 0;
};

/// A random design whose plates have physically possible inertias (triangle inequality), as Simbody requires.
std::vector<double> random_design(Uniform& uniform) {
  std::vector<double> p = testing::crr::random_design(uniform, 0.15);
  const std::vector<double> nominal = testing::crr::nominal();
  for (const std::size_t plate : {crr_cru::kInertia, crr_cru::kInertia1}) {
    const double factor = uniform(0.7, 1.4);
    for (std::size_t k = 0; k < 3; ++k) p[plate + k] = nominal[plate + k] * factor;
  }
  p[crr_cru::kSlideMass] = uniform(0, 0.5);
  p[crr_cru::kPayload] = uniform(0.01, 0.5);
  p[crr_cru::kPayloadOffset] = uniform(-0.05, 0.1);
  return p;
}

/// Calls check() for the nominal design of each mechanism and for `count` random designs.
template <class Check>
void for_designs(int count, const Check& check) {
  Uniform uniform(21);
  double worst = 0;
  for (const std::string& name : testing::crr::both())
    for (int k = 0; k <= count; ++k) {
      Comparison comparison(name, k == 0 ? testing::crr::nominal() : random_design(uniform));
      check(comparison, uniform);
      worst = std::max(worst, comparison.worst());
    }
  ::testing::Test::RecordProperty("largest_difference", std::to_string(worst * 1e15) + "e-15");
}

const crr_cru::WorkingMode kNominalMode = {-1, -1, 1, -1};

/// X = X0 + A (sin wt, cos wt, sin wt, 0), A = 0.01 m, w = 2 pi / s (eq 35).
State oscillation(const std::array<double, 4>& X0, double t) {
  const double A = 0.01, w = 2 * kPi;
  const auto [s, c] = sincos(w * t);
  return {{},
          kNominalMode,
          {{X0[0] + A * s, X0[1] + A * c, X0[2] + A * s, X0[3]}, {A * w * c, -A * w * s, A * w * c, 0}},
          {-A * w * w * s, -A * w * w * c, -A * w * w * s, 0},
          {}};
}

TEST(DriveForces, AgreeAlongTheOscillation) {
  for_designs(3, [](Comparison& comparison, Uniform&) {
    for (int k = 0; k <= 40; ++k) comparison.check(oscillation({0.2, 0.17, 0.22, 0}, k / 40.0));
    for (int k = 0; k <= 40; ++k) comparison.check(oscillation({0.2, 0.17, 0.22, 0.6}, k / 40.0));
  });
}

/// Rest-to-rest move by the quintic law 10 u^3 - 15 u^4 + 6 u^5 over the stroke; peak acceleration of D: `peak`
/// [m/s^2].
State quintic(const std::array<double, 4>& start, const std::array<double, 4>& stroke, double peak, double u) {
  const double length = std::sqrt(stroke[0] * stroke[0] + stroke[1] * stroke[1] + stroke[2] * stroke[2]);
  const double T = std::sqrt(10 * length / (std::sqrt(3.0) * peak));
  const double s = u * u * u * (10 - 15 * u + 6 * u * u), v = 30 * u * u * (1 - u) * (1 - u) / T,
               a = 60 * u * (1 - u) * (1 - 2 * u) / (T * T);
  State state{{}, kNominalMode, {Pose<double>(4), AxisVector<double>(4)}, AxisVector<double>(4), {}};
  for (std::size_t k = 0; k < 4; ++k) {
    state.motion.pose[k] = start[k] + s * stroke[k];
    state.motion.velocity[k] = v * stroke[k];
    state.acceleration[k] = a * stroke[k];
  }
  return state;
}

TEST(DriveForces, AgreeAlongQuinticMoves) {
  const std::array<double, 4> start = {0.1975, 0.137, 0.2319, 0};
  const std::array<std::array<double, 4>, 5> strokes = {{{-0.0906, 0, 0, 0},
                                                         {0, 0.05, 0, 0},
                                                         {0, 0, 0.0518, 0},
                                                         {-0.0906, 0.05, 0.0518, 0},
                                                         {-0.0906, 0.05, 0.0518, 0.8}}};
  for_designs(3, [&](Comparison& comparison, Uniform&) {
    for (const auto& stroke : strokes)
      for (const double peak : {3.0, 7.0, 11.0})
        for (int k = 0; k <= 20; ++k) comparison.check(quintic(start, stroke, peak, k / 20.0));
  });
}

TEST(DriveForces, AgreeAtRandomStatesUnderWrenches) {
  for_designs(25, [](Comparison& comparison, Uniform& uniform) {
    for (int k = 0; k < 48; ++k)
      comparison.check(testing::crr::random_state(uniform, comparison.name(), testing::crr::mode_number(k % 16),
                                                  comparison.design()));
  });
}

}  // namespace
}  // namespace pkm::simbody
