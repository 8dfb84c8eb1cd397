// Joint-space inertia of 4PPa-2PaR: its closed form, and coupling indices over the workspace, against the equations of
// motion and against each other.
#include <cmath>

#include <gtest/gtest.h>

#include "engine/accelerators/four_ppa_two_par/coupling.hpp"
#include "engine/dynamics/coupling.hpp"
#include "engine/math/statistics.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/golden.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/random_states.hpp"
#include "tests/unit/contracts/derivative_comparison.hpp"

namespace pkm::testing {
namespace {

using namespace four_ppa_two_par;

TEST(FourPpaCoupling, KernelEqualsTheEquationsOfMotion) {
  int compared = 0;
  for (const Drawn& s : random_states(800, 7)) {
    if (s.mode != 0) continue;
    const auto g = geometry(std::span<const double>(s.p));
    const auto limb = limbs_at(g, {s.X[0], s.X[1], s.X[2], s.X[3]}, kLowerMode);
    ASSERT_TRUE(limb);
    const auto [sine, cosine] = sincos(s.X[3]);
    const auto fast = four_ppa_two_par::joint_inertia(g, masses(std::span<const double>(s.p)), sine, cosine, limb->x,
                                                      limb->sigma, limb->z_c);
    const auto full = pkm::joint_inertia(dynamics(s.p, s.X, s.V, 0));
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR(fast(i, j), full(i, j), 1e-11 * full(i, i));
    ++compared;
  }
  EXPECT_EQ(compared, 200);
}

const FieldRequest kAll{.fields = {&kConditioning, &kCouplingIndex, &kInertiaCondition}, .poses = true};

TEST(FourPpaCoupling, WhereInertiaHasNoValueTheWorstIsTaken) {
  auto M = Matrix<double, 4, 4>::identity();
  const auto values = [&M] {
    WorkspaceResult<double> survey;
    survey.clear(kAll.fields);
    add_inertia(M, survey);
    return std::array{survey.field(kCouplingIndex)[0], survey.field(kInertiaCondition)[0]};
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

void expect_lengths(const WorkspaceResult<double>& s) {
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(s.field(kCouplingIndex, i).size(), s.weight.size());
  EXPECT_EQ(s.field(kInertiaCondition).size(), s.weight.size());
  EXPECT_EQ(s.field(kConditioning).size(), s.weight.size());
  EXPECT_EQ(s.pose.size(), s.weight.size());
}

/// Every sample of a column survey is what the equations of motion give at its pose, and feasible.
void expect_poses(const std::vector<double>& p, const WorkspaceResult<double>& s, const LimitSpec& limits) {
  ASSERT_GT(s.pose.size(), 100u);
  for (std::size_t k = 0; k < s.pose.size(); k += 17) {
    const pkm::Pose<double>& at = s.pose[k];
    const auto M = joint_inertia(dynamics(p, fixed<4>(at), {}, 0));
    const AxisVector<double> index = coupling_indices(M);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(s.field(kCouplingIndex, i)[k], index[i], 1e-8);
    EXPECT_NEAR(s.field(kInertiaCondition)[k], inertia_condition(M), 1e-8);
    const PoseReport report = four_ppa().inspect(p, at, "lower,lower", limits);
    EXPECT_TRUE(report.feasible) << report.reason;
    EXPECT_NEAR(s.field(kConditioning)[k], *report.conditioning, 1e-8);
  }
}

void expect_alike(const WorkspaceResult<double>& exact, const WorkspaceResult<double>& cells, double accuracy) {
  expect_lengths(exact);
  expect_lengths(cells);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(weighted_mean(cells.weight, cells.field(kCouplingIndex, i)),
                weighted_mean(exact.weight, exact.field(kCouplingIndex, i)), accuracy)
        << i;
  EXPECT_NEAR(weighted_mean(cells.weight, cells.field(kInertiaCondition)),
              weighted_mean(exact.weight, exact.field(kInertiaCondition)), accuracy);
}

TEST(FourPpaCoupling, VoxelsConvergeToColumns) {
  const auto p = lopsided();
  for (const double y : {1.25, 0.55, 1.9}) {  // both limbs free or alike; one or the other short of stroke
    const FixedCoordinate fixed_y = at_y(y);
    const auto exact = survey(p, columns(away(), fixed_y), kAll);
    expect_alike(exact, survey(p, voxels(away(), {50, 56, 60}, fixed_y), kAll), 2e-3);
    double sum = 0;
    for (const double w : exact.weight) sum += w;
    EXPECT_NEAR(sum, exact.volume, 1e-4 * exact.volume);
    expect_poses(p, exact, away());
    // the joints do differ, so the comparison tells them apart
    EXPECT_GT(std::fabs(weighted_mean(exact.weight, exact.field(kCouplingIndex, 0)) -
                        weighted_mean(exact.weight, exact.field(kCouplingIndex, 2))),
              0.006);
  }
}

TEST(FourPpaCoupling, IntegratedOverY) {
  auto p = lopsided();
  p[kL0] = 1.4;
  const WorkspacePlan cells = voxels(away(), {24, 28, 30}, over_y(24));
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
          EXPECT_NEAR(found.field(kCouplingIndex, joint)[sample], index[joint], 1e-9);
        EXPECT_NEAR(found.field(kInertiaCondition)[sample], inertia_condition(M), 1e-9);
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
  EXPECT_TRUE(plain.field(kCouplingIndex, 0).empty() && plain.field(kInertiaCondition).empty());
  EXPECT_TRUE(indices.field(kConditioning).empty() && indices.field(kInertiaCondition).empty());
  EXPECT_EQ(indices.field(kCouplingIndex, 3), all.field(kCouplingIndex, 3));
  EXPECT_NEAR(weighted_mean(all.weight, all.field(kConditioning)),
              weighted_mean(plain.weight, plain.field(kConditioning)), 1e-12);
  // Without an uneven payload the joints change places under mirroring, and have the same mean.
  for (std::size_t i = 1; i < 4; ++i)
    EXPECT_NEAR(weighted_mean(all.weight, all.field(kCouplingIndex, i)),
                weighted_mean(all.weight, all.field(kCouplingIndex, 0)), 1e-12);
}

// The accelerators are of the lower mode; others are the generic engine's.
TEST(FourPpaCoupling, OfAnotherModeIsThatOfItsEquationsOfMotion) {
  const auto p = lopsided();
  FieldRequest upper = kAll;
  upper.mode = "upper,upper";
  const auto found = survey(p, voxels(away(), {9, 10, 11}), upper);
  ASSERT_GT(found.pose.size(), 20u);
  expect_lengths(found);
  EXPECT_NE(found.feasible_cells, survey(p, voxels(away(), {9, 10, 11}), kAll).feasible_cells);
  for (std::size_t k = 0; k < found.pose.size(); ++k) {
    EXPECT_TRUE(four_ppa().inspect(p, found.pose[k], upper.mode, away()).feasible);
    const auto M = joint_inertia(dynamics(p, fixed<4>(found.pose[k]), {}, 3));
    const AxisVector<double> index = coupling_indices(M);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(found.field(kCouplingIndex, i)[k], index[i], 1e-9);
    EXPECT_NEAR(found.field(kInertiaCondition)[k], inertia_condition(M), 1e-9);
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
    WorkspacePlan plan = columns(away(), at_y(k % 2 ? 0.6 : design[kL0] / 2));
    column_options(plan).nodes = {3, 3};
    const auto evaluator = prepare_workspace(four_ppa(), plan, kAll);
    const auto means = [&](double t) {
      std::vector<Dual4> p;
      for (std::size_t i = 0; i < design.size(); ++i) {
        p.emplace_back(design[i] + t * direction[i]);
        p.back().v[0] = direction[i];
      }
      WorkspaceResult<Dual4> found;
      evaluate_once<Dual4>(*evaluator, p, found);
      std::vector<Dual4> all;
      for (std::size_t i = 0; i < 4; ++i) all.push_back(weighted_mean(found.weight, found.field(kCouplingIndex, i)));
      all.push_back(weighted_mean(found.weight, found.field(kInertiaCondition)));
      return all;
    };
    const auto here = means(0);
    std::vector<double> scale;
    for (const Dual4& mean : here) scale.push_back(std::fmax(std::fabs(mean.v[0]), 0.1 * mean.a));
    const auto expected = test::differences(
        [&](double t) {
          std::vector<double> values;
          for (const Dual4& mean : means(t)) values.push_back(mean.a);
          return values;
        },
        scale);
    for (std::size_t i = 0; i < here.size(); ++i, ++compared) {
      if (expected[i])
        EXPECT_NEAR(here[i].v[0], *expected[i], 1e-6 * scale[i]);
      else
        ++missing;  // an element of M_q changes its sign at a node within the smallest steps
    }
  }
  EXPECT_EQ(compared, 60);
  EXPECT_LE(missing, 6);
}

}  // namespace
}  // namespace pkm::testing
