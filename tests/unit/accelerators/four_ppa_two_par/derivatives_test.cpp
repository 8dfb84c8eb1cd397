// Derivatives of 4PPa-2PaR's workspace analyses beyond the contract suite: golden gradients, planes off the middle,
// integration over y, strokes that cut, and the critical values of theta that only a root finds.
#include <gtest/gtest.h>

#include "engine/accelerators/four_ppa_two_par/columns.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/math/statistics.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/golden.hpp"
#include "tests/unit/contracts/catalogue_problem.hpp"
#include "tests/unit/contracts/derivative_comparison.hpp"

namespace pkm::testing {
namespace {

using namespace four_ppa_two_par;

std::shared_ptr<const Mechanism> machine() { return all_mechanisms().front(); }

TEST(FourPpaDerivatives, GoldenGradientsThroughTheProblem) {
  const std::vector<std::size_t> by = {kA, kB, kLu, kLd, kD, kL0};
  const char* const keys[6] = {"a", "b", "lu", "ld", "d", "L0"};
  for (const auto& entry : golden()["workspace"]) {
    SCOPED_TRACE(entry["design"].dump());
    const DesignProblem problem = test::everything(machine(), columns(limits_of(entry)), test::Of::volume);
    ASSERT_EQ(problem.objectives()[0].name, "workspace-volume");
    ASSERT_EQ(problem.objectives()[1].name, "workspace-ratio");
    const auto p = design_of(entry);
    const auto derivatives = problem.derivatives(p, by);
    const auto& gradient = entry["volume_gradient"];
    const double volume = entry["volume_exact"], size = kPi * p[kB] * (p[kLu] + p[kLd]);
    EXPECT_NEAR(derivatives[0] / volume, 1, 1e-9);
    double largest = 0;
    for (const char* key : keys) largest = std::fmax(largest, std::fabs(gradient[key].get<double>()));
    for (std::size_t i = 0; i < by.size(); ++i) {
      const double of_volume = gradient[keys[i]];
      EXPECT_NEAR(derivatives[1 + i], of_volume, 1e-5 * largest) << keys[i];
      // V / (pi b (l_u + l_d)) by hand
      const double of_size = by[i] == kB ? size / p[kB] : by[i] == kLu || by[i] == kLd ? kPi * p[kB] : 0;
      EXPECT_NEAR(derivatives[8 + i], (of_volume - volume / size * of_size) / size, 1e-5 * largest / size) << keys[i];
    }
  }
}

// The smooth approximation of the minimum conditioning lies above it, and converges to it with increasing sharpness.
TEST(FourPpaDerivatives, SmoothApproximationConvergesToTheMinimum) {
  LimitSpec spec = no_limits(four_ppa().info());
  const double away[] = {0.1, 0.1, 1.3, 0.05, 0.2, 0.3};  // from singularities, where the minimum is 0
  std::ranges::copy(away, spec.given.begin());
  const WorkspacePlan plan = columns(spec);
  const ObjectiveEntry& entry = *find_named(all_objectives(), "conditioning");
  Options options = default_options(entry.options);
  options.set("statistic", std::string("min"));
  double gap = 1;
  for (const double sharpness : {10.0, 100.0, 1e3, 1e4, 1e5}) {
    options.set("sharpness", sharpness);
    const EntryContext context{four_ppa(), plan, options};
    ProblemParts parts;
    parts.mechanism = machine();
    parts.parameters = nominal();
    parts.plan = plan;
    parts.varies = {kA};
    parts.space = DesignSpace({{"a", "m", 0.1, 0.5}});
    entry.request(context, parts.request);
    parts.objectives.push_back({.name = entry.name, .quantity = entry.make(context)});
    const DesignProblem problem(parts);
    const double minimum = problem.report(nominal()).objectives[0], smooth = problem.derivatives(nominal(), {})[0];
    EXPECT_GT(minimum, 0.001);
    EXPECT_GE(smooth, minimum);
    EXPECT_LT(smooth - minimum, gap);
    gap = smooth - minimum;
  }
  EXPECT_LT(gap, 2e-4);
}

/// Random designs with rails so short that the stroke cuts, and directions to move them in.
struct DrawnPlane {
  std::vector<double> design, direction;
  LimitSpec limits;
  double plane;  ///< in units of L0
};
DrawnPlane draw(unsigned k) {
  Stream random(5, 0, k, Stream::Use::start);
  DrawnPlane drawn;
  drawn.limits = test::random_limits(four_ppa().info(), random);
  drawn.design = test::random_design(four_ppa().info(), random);
  drawn.design[kL0] = drawn.design[kLu] * (0.8 + random.u01());
  drawn.plane = 0.2 + 0.6 * random.u01();
  for (std::size_t i = 0; i < drawn.design.size(); ++i) drawn.direction.push_back(2 * random.u01() - 1);
  return drawn;
}

void compare(unsigned designs, FixedCoordinate::Kind kind, std::array<int, 2> nodes, double tolerance, bool volume_only,
             double excluded) {
  test::DerivativeComparison comparison;
  unsigned compared = 0;
  for (unsigned k = 0; compared < designs && k < 4 * designs; ++k) {
    SCOPED_TRACE("design " + std::to_string(k));
    const DrawnPlane drawn = draw(k);
    const FixedCoordinate fixed_y{.coordinate = 1, .kind = kind, .value = drawn.plane * drawn.design[kL0]};
    WorkspacePlan plan = columns(drawn.limits, fixed_y, tolerance);
    column_options(plan).nodes = nodes;
    if (!(survey(drawn.design, plan).volume > 0)) continue;
    comparison.compare(test::everything(machine(), plan, volume_only ? test::Of::volume : test::Of::kinematics),
                       drawn.design, drawn.direction);
    ++compared;
  }
  comparison.expect(static_cast<int>(designs), excluded);
}

TEST(FourPpaDerivatives, MiddlePlaneWithShortRails) {
  compare(1000, FixedCoordinate::Kind::default_value, {0, 0}, 1e-13, true, 0.01);
  compare(200, FixedCoordinate::Kind::default_value, {6, 6}, 0, false, 0.02);
}

TEST(FourPpaDerivatives, OffTheMiddlePlane) {
  compare(1000, FixedCoordinate::Kind::value, {0, 0}, 1e-13, true, 0.01);
  compare(200, FixedCoordinate::Kind::value, {6, 6}, 0, false, 0.02);
}

TEST(FourPpaDerivatives, VolumesIntegratedOverY) {
  compare(60, FixedCoordinate::Kind::integrated, {0, 0}, 1e-12, true, 0.1);
}

/// There are so many samples over y that every small step crosses a kink of one of them: their weights are compared to
/// rounding, their mean conditioning as far as the kinks allow.
TEST(FourPpaDerivatives, SamplesIntegratedOverY) {
  FieldRequest request;
  request.add(kConditioning);
  int compared = 0;
  for (unsigned k = 0; compared < 3 && k < 10; ++k) {
    SCOPED_TRACE("design " + std::to_string(k));
    const DrawnPlane drawn = draw(k);
    const auto evaluator = prepare_workspace(four_ppa(), columns(drawn.limits, over_y(), 1e-8), request);
    const auto sums = [&](double t) {
      std::vector<Dual4> p;
      for (std::size_t i = 0; i < drawn.design.size(); ++i) {
        const double step = drawn.design[i] * drawn.direction[i];
        p.emplace_back(drawn.design[i] + t * step);
        p.back().v[0] = step;
      }
      WorkspaceResult<Dual4> survey;
      evaluate_once<Dual4>(*evaluator, p, survey);
      Dual4 total;
      for (const Dual4& weight : survey.weight) total += weight;
      return std::array{survey.volume, total, weighted_mean(survey.weight, survey.field(kConditioning))};
    };
    const auto here = sums(0);
    if (!(here[0].a > 1e-4)) continue;
    const double derivative = here[1].v[0], scale = std::fabs(derivative);
    const auto weights = test::differences([&](double t) { return std::vector{sums(t)[1].a}; }, {scale});
    if (!weights[0]) continue;
    ++compared;
    EXPECT_NEAR(derivative, *weights[0], 1e-7 * scale);
    constexpr double kStep = 1e-5;
    EXPECT_NEAR(here[2].v[0], (sums(kStep)[2].a - sums(-kStep)[2].a) / (2 * kStep), 1e-4 * here[2].a);
    EXPECT_NEAR(here[1].a, here[0].a, 1e-2 * here[0].a);
  }
  EXPECT_EQ(compared, 3);
}

/// Critical values that a root finds, against differences over a small change of all lengths.
TEST(FourPpaDerivatives, CriticalValuesEqualDifferences) {
  int followed = 0;
  for (unsigned k = 0; k < 300; ++k) {
    SCOPED_TRACE("design " + std::to_string(k));
    const DrawnPlane drawn = draw(k);
    const auto breaks = [&](double t) {
      using Scalar = Dual<1>;
      std::vector<Scalar> p;
      for (std::size_t i = 0; i < drawn.design.size(); ++i) {
        const double step = drawn.design[i] * drawn.direction[i];
        p.push_back({drawn.design[i] + t * step, {step}});
      }
      const auto g = geometry(std::span<const Scalar>(p));
      const auto f = sliced_design(g, limits(g, drawn.limits), Scalar(drawn.plane * drawn.design[kL0]));
      ColumnScratch<Scalar> scratch;
      find_theta_intervals(f, scratch.critical_values, scratch.intervals);
      std::vector<Scalar> ends;
      for (const auto& piece : scratch.intervals) ends.insert(ends.end(), {piece.lower, piece.upper});
      return ends;
    };
    constexpr double kStep = 1e-6;
    const auto here = breaks(0), before = breaks(-kStep), after = breaks(kStep);
    if (before.size() != here.size() || after.size() != here.size()) continue;
    for (std::size_t i = 0; i < here.size(); ++i) {
      const double difference = (after[i].a - before[i].a) / (2 * kStep);
      EXPECT_NEAR(here[i].v[0], difference, 1e-6 * (1 + difference * difference)) << i;
      ++followed;
    }
  }
  EXPECT_GT(followed, 1000);
}

}  // namespace
}  // namespace pkm::testing
