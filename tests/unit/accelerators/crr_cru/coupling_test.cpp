// (3CRR/R)&CRU and Quadrupteron: joint-space inertia of surveys, and statistics of their coupling indices.
#include "engine/accelerators/crr_cru/coupling.hpp"

#include <gtest/gtest.h>

#include "engine/math/statistics.hpp"
#include "engine/problem/pose_statistic.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "tests/unit/accelerators/crr_cru/golden.hpp"

namespace pkm::testing::crr {
namespace {

FieldRequest coupling(const std::string& mode = "") {
  FieldRequest request;
  request.fields = {&kCouplingIndex, &kInertiaCondition};
  request.poses = true;
  request.mode = mode;
  return request;
}

/// M_q from the equations of motion of the generic engine.
Matrix<double, 4, 4> reference(const Mechanism& m, const std::vector<double>& p, const pkm::Pose<double>& pose,
                               const std::string& mode) {
  const MotionState<double> state{pose, {0, 0, 0, 0}};
  PoseDynamics<double> d;
  m.dynamics()->equations(std::span<const double>(p), mode, {&state, 1}, {&d, 1});
  return fixed<4, 4>(joint_inertia(d));
}

/// Compares every `step`-th sample.
void expect_samples_of_reference(const Mechanism& m, const std::vector<double>& p, const std::string& mode,
                                 const WorkspaceResult<double>& s, std::size_t step) {
  ASSERT_GT(s.weight.size(), 10u);
  for (std::size_t k = 0; k < s.weight.size(); k += step) {
    const Matrix<double, 4, 4> M = reference(m, p, s.pose[k], mode);
    const Vector<double, 4> index = coupling_indices(M);
    for (std::size_t i = 0; i < 4; ++i) ASSERT_NEAR(s.field(kCouplingIndex, i)[k], index[i], 1e-10);
    ASSERT_NEAR(s.field(kInertiaCondition)[k], inertia_condition(M), 1e-10);
  }
}

WorkspacePlan voxels(int held, double value, const std::array<std::int64_t, 3>& cells,
                     const std::optional<Box>& box = {}) {
  return plan(VoxelOptions{.cells = cells, .box = box}, held, value, limit_spec(0.2, 0.1));
}

TEST(CrrCruCoupling, GoldenStatistics) {
  for (const auto& entry : golden()["dci_stats"]) {
    Box box;
    for (std::size_t k = 0; k < 3; ++k) box[k] = {entry["lo"][k].get<double>(), entry["hi"][k].get<double>()};
    WorkspacePlan p = voxels(3, entry["phi"], {entry["n"][0], entry["n"][1], entry["n"][2]}, box);
    p.limits = limit_spec(entry["smin"], entry["cmin"]);
    const auto s = survey(entry["mechanism"], nominal(), p, coupling(mode_name(mode_of(entry["sigma"]))));
    ASSERT_EQ(s.feasible_cells, entry["feasible"].get<std::int64_t>());
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(maximum(s.field(kCouplingIndex, i)), entry["max"][i].get<double>(), 1e-10);
      EXPECT_NEAR(weighted_mean(s.weight, s.field(kCouplingIndex, i)), entry["mean"][i].get<double>(), 1e-10);
      EXPECT_NEAR(weighted_standard_deviation(s.weight, s.field(kCouplingIndex, i)), entry["std"][i].get<double>(),
                  1e-8);
      EXPECT_NEAR(weighted_quantile(s.weight, s.field(kCouplingIndex, i), 0.95), entry["p95"][i].get<double>(), 1e-10);
    }
  }
}

TEST(CrrCruCoupling, SamplesEqualTheEquationsOfMotion) {
  Uniform uniform(5);
  for (const std::string& name : both())
    for (const int held : {3, 0, 1, 2})
      for (const bool by_columns : {false, true}) {
        SCOPED_TRACE(name + " held " + std::to_string(held));
        const auto p = random_design(uniform, 0.1);
        const std::string mode = "+,-,-,+";
        WorkspacePlan sweep = voxels(held, held == 3 ? 0.2 : 0.19, {5, 6, 7});
        if (by_columns) sweep.method = ColumnOptions{.tolerance = 1e-10, .nodes = {2, 2}};
        expect_samples_of_reference(mechanism(name), p, mode, survey(name, p, sweep, coupling(mode)), 7);
      }
}

TEST(CrrCruCoupling, MassesMayFollowTheGeometry) {
  Uniform uniform(6);
  for (const std::string& name : both()) {
    const auto m = mechanism(name).dynamics()->with_masses("geometry");
    std::vector<double> p;
    for (const Parameter& parameter : m->info().parameters) p.push_back(parameter.nominal * (1 + uniform(-0.1, 0.1)));
    p[kSlideMass] = 0.2;
    p[kPayload] = 0.3;
    p[kPayloadOffset] = 0.05;
    for (const bool by_columns : {false, true}) {
      WorkspacePlan sweep = voxels(3, 0.2, {5, 6, 7});
      if (by_columns) sweep.method = ColumnOptions{.tolerance = 1e-10, .nodes = {2, 2}};
      WorkspaceResult<double> s;
      evaluate_once<double>(*prepare_workspace(*m, sweep, coupling()), p, s);
      expect_samples_of_reference(*m, p, "-,-,+,-", s, 7);
    }
  }
}

TEST(CrrCruCoupling, ThereIsNoneInAParallelSingularity) {
  for (const Platform platform : {Platform::jointed, Platform::rigid}) {
    const std::string name = platform == Platform::jointed ? "3crr-r-cru" : "quadrupteron";
    const std::vector<double> p = nominal();
    const auto g = geometry(platform, std::span<const double>(p));
    const auto b = masses(MassModel::table, std::span<const double>(p));
    const double singular = kPi / 2 - offset(yaw(g));
    const auto inertia = [&](double phi) {
      return joint_inertia(g, b, yaw_inertia(g, b, phi), {0.15, 0.15, 0.2}, WorkingMode{-1, -1, 1, -1});
    };
    for (const double phi : {singular - 1e-9, singular + 1e-9})
      for (const double index : coupling_indices(inertia(phi))) EXPECT_TRUE(std::isfinite(index)) << name;
    for (const double phi : {singular - 1e-14, singular, singular + 1e-14}) {
      for (const double index : coupling_indices(inertia(phi))) EXPECT_TRUE(std::isnan(index)) << name;
      EXPECT_EQ(inertia_condition(inertia(phi)), 0) << name;
      std::vector<Dual4> dual(p.begin(), p.end());
      const auto slopes = yaw_inertia(geometry(platform, std::span<const Dual4>(dual)),
                                      masses(MassModel::table, std::span<const Dual4>(dual)), Dual4(phi));
      EXPECT_TRUE(std::isnan(slopes.k.a)) << name;
    }
  }
}

TEST(CrrCruCoupling, ColumnsAgreeWithFineVoxelsInABox) {
  for (const std::string& name : both()) {
    const Box box = {{{0.05, 0.25}, {0.06, 0.30}, {0.12, 0.30}}};
    const WorkspacePlan fine = voxels(3, 0.35, {40, 40, 40}, box);
    const WorkspacePlan exact = plan(ColumnOptions{.tolerance = 1e-10, .box = box}, 3, 0.35, limit_spec(0.2, 0.1));
    const auto coarse = survey(name, nominal(), fine, coupling()), columns = survey(name, nominal(), exact, coupling());
    EXPECT_NEAR(coarse.volume / columns.volume, 1, 2e-3);
    double sum = 0;
    for (const double weight : columns.weight) sum += weight;
    EXPECT_NEAR(sum / columns.volume, 1, 1e-3);  // a fixed rule
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(weighted_mean(columns.weight, columns.field(kCouplingIndex, i)),
                  weighted_mean(coarse.weight, coarse.field(kCouplingIndex, i)), 2e-3);
  }
}

TEST(CrrCruCoupling, DerivativesOfStatisticsEqualDifferences) {
  Uniform uniform(11);
  int compared = 0, kinks = 0;
  for (const std::string& name : both())
    for (int round = 0; round < 4; ++round) {
      const auto p = random_design(uniform, 0.03);
      const WorkspacePlan region = {
          .method = ColumnOptions{.tolerance = 1e-10, .box = {{{{0.12, 0.2}, {0.12, 0.2}, {0.17, 0.24}}}}},
          .fixed = {{.coordinate = 3, .kind = FixedCoordinate::Kind::listed, .values = {-0.6, 0.1, 0.5}}},
          .limits = limit_spec(0.2, 0.1)};
      const auto evaluator = prepare_workspace(mechanism(name), region, coupling());
      const std::array<std::size_t, 4> by = {kL11, kL42, kL, kRodMass + 3};
      const auto statistics = [](const auto& s) {
        Scratch scratch;
        const auto worst = reduced_field(s, kCouplingIndex, "worst", scratch);
        return std::array{weighted_mean(s.weight, worst), weighted_standard_deviation(s.weight, worst),
                          soft_max(s.weight, worst, 100), weighted_mean(s.weight, s.field(kInertiaCondition))};
      };
      std::vector<Dual4> dual(p.begin(), p.end());
      for (std::size_t k = 0; k < 4; ++k) dual[by[k]].v[static_cast<int>(k)] = 1;
      WorkspaceResult<Dual4> derived;
      evaluate_once<Dual4>(*evaluator, dual, derived);
      const auto slopes = statistics(derived);
      for (std::size_t k = 0; k < 4; ++k) {
        const double step = 1e-5 * p[by[k]];
        const auto at = [&](double shift) {
          auto moved = p;
          moved[by[k]] += shift;
          WorkspaceResult<double> s;
          evaluate_once<double>(*evaluator, moved, s);
          return statistics(s);
        };
        const auto up = at(step), down = at(-step), up2 = at(2 * step), down2 = at(-2 * step);
        for (std::size_t q = 0; q < slopes.size(); ++q) {
          const double wide = (up2[q] - down2[q]) / (4 * step), narrow = (up[q] - down[q]) / (2 * step);
          const double difference = narrow + (narrow - wide) / 3;
          ++compared;
          // An index has a kink where an element of M_q passes 0 at a sample: there the steps disagree.
          if (std::fabs(narrow - wide) > 1e-6 * (1 + std::fabs(difference))) {
            ++kinks;
            continue;
          }
          EXPECT_NEAR(slopes[q].v[static_cast<int>(k)], difference, 1e-6 * (1 + std::fabs(difference)))
              << name << " statistic " << q << " parameter " << by[k];
        }
      }
    }
  EXPECT_LT(kinks, 0.2 * compared);
}

TEST(CrrCruCoupling, TheFourthIndexIsTheSameEverywhereAtPhiZero) {
  const auto s = survey("3crr-r-cru", nominal(), voxels(3, 0, {12, 12, 12}), coupling());
  for (const double index : s.field(kCouplingIndex, 3)) ASSERT_NEAR(index, 0.029011448, 2e-9);
}

}  // namespace
}  // namespace pkm::testing::crr
