// Derivatives of column surveys of (3CRR/R)&CRU and the Quadrupteron against central differences, on random designs,
// for every parameter and every coordinate that may be held.
//
// At a kink of the volume (two slides end at the same coordinate, or the circles of two annuli are tangent) differences
// over a step that crosses it are meaningless. They are excluded by one rule: the differences over the steps
// h and 2 h, which agree to O(h^2) where the volume is smooth, differ by more than a tenth of the tolerance.
#include <cmath>

#include <gtest/gtest.h>

#include "engine/math/statistics.hpp"
#include "tests/unit/accelerators/crr_cru/golden.hpp"

namespace pkm::testing::crr {
namespace {

constexpr double kTolerance = 1e-7;  // relative to value / parameter, or to the slope if that is larger

struct PlannedCase {
  std::string name;
  std::vector<double> p;
  WorkspacePlan plan;
};

std::vector<PlannedCase> random_plans(int count, int seed, double tolerance) {
  Uniform uniform(seed);
  std::vector<PlannedCase> cases;
  for (int i = 0; i < count; ++i) {
    const int held = i % 4;
    const auto p = random_design(uniform, 0.2);
    const double value = held == 3 ? uniform(-0.8, 0.8) : uniform(0.08, 0.32);
    const auto limits = i % 3 == 0 ? limit_spec(0, 0) : limit_spec(uniform(0.1, 0.4), uniform(0.05, 0.4));
    cases.push_back({both()[static_cast<std::size_t>(i / 4 % 2)], p,
                     plan(ColumnOptions{.tolerance = tolerance}, held, value, limits)});
  }
  return cases;
}

/// Value and slopes by all parameters of a function of a survey.
template <class Function>
std::vector<double> slopes_of(const PlannedCase& c, const FieldRequest& request, const Function& f) {
  const auto evaluator = prepare_workspace(mechanism(c.name), c.plan, request);
  Scratch scratch;
  std::vector<double> slopes;
  for (std::size_t first = 0; first < kParameters; first += 4) {
    std::vector<Dual4> p(c.p.begin(), c.p.end());
    for (std::size_t k = first; k < std::min<std::size_t>(first + 4, kParameters); ++k)
      p[k].v[static_cast<int>(k - first)] = 1;
    WorkspaceResult<Dual4> survey;
    evaluator->gradients()->evaluate(p, scratch, survey);
    const Dual4 value = f(survey);
    for (std::size_t k = first; k < std::min<std::size_t>(first + 4, kParameters); ++k)
      slopes.push_back(value.v[static_cast<int>(k - first)]);
  }
  return slopes;
}

struct Agreement {
  int compared = 0, excluded = 0;
};

template <class Function>
Agreement compare(const std::vector<PlannedCase>& cases, const FieldRequest& request, double tolerance,
                  const Function& f) {
  Agreement agreement;
  for (const PlannedCase& c : cases) {
    const auto evaluator = prepare_workspace(mechanism(c.name), c.plan, request);
    Scratch scratch;
    const auto value = [&](std::vector<double> p, std::size_t k, double by) {
      p[k] += by;
      WorkspaceResult<double> survey;
      evaluator->evaluate(p, scratch, survey);
      return f(survey);
    };
    const double here = value(c.p, 0, 0);
    if (!(here > 1e-5)) continue;
    const auto slopes = slopes_of(c, request, f);
    for (std::size_t k = 0; k < kParameters; ++k) {
      const bool angle = k >= kBeta1 && k <= kBeta3;
      const double size = angle ? 1 : std::fabs(k == kRhoMin ? 0.1 : c.p[k]), h = 1e-5 * size;
      const auto difference = [&](double step) { return (value(c.p, k, step) - value(c.p, k, -step)) / (2 * step); };
      const double near = difference(h), far = difference(2 * h);
      const double scale = std::fmax(here / size, std::fabs(near));
      if (std::fabs(near - far) > 0.1 * tolerance * scale) {
        ++agreement.excluded;
        continue;
      }
      ++agreement.compared;
      EXPECT_NEAR(slopes[k], near, tolerance * scale)
          << c.name << ", held " << c.plan.fixed[0].coordinate << " at " << c.plan.fixed[0].value << ", "
          << mechanism(c.name).info().parameters[k].name << ", far " << far << ", V " << here;
    }
  }
  return agreement;
}

const auto kVolume = [](const auto& survey) { return survey.volume; };
const auto kMeanConditioning = [](const auto& survey) {
  return weighted_mean(survey.weight, survey.field(kConditioning));
};

TEST(CrrCruDerivatives, OfTheVolumeEqualDifferences) {
  const Agreement found = compare(random_plans(96, 1, 1e-13), {}, kTolerance, kVolume);
  EXPECT_GT(found.compared, 1200);
  EXPECT_LT(found.excluded, found.compared / 20);
}

TEST(CrrCruDerivatives, OfTheMeanConditioningEqualDifferences) {
  FieldRequest request;
  request.add(kConditioning);
  const Agreement found = compare(random_plans(48, 2, 1e-12), request, kTolerance, kMeanConditioning);
  EXPECT_GT(found.compared, 500);
  EXPECT_LT(found.excluded, found.compared / 20);
}

// With values of the same bits as without derivatives. At the default tolerance of 1e-8 nearly all slopes are as good
// as 1e-7; where the adaptive rule stops early, near a component that it hardly resolves, a few are not. A hundredth of
// the tolerance leaves none.
TEST(CrrCruDerivatives, AreAsGoodAsTheTolerance) {
  const auto fine = random_plans(60, 3, 1e-13), usual = random_plans(60, 3, 1e-8), tight = random_plans(60, 3, 1e-10);
  int compared = 0, beyond = 0;
  for (std::size_t i = 0; i < fine.size(); ++i) {
    const double here = survey(usual[i].name, usual[i].p, usual[i].plan).volume;
    std::vector<Dual4> p(usual[i].p.begin(), usual[i].p.end());
    EXPECT_EQ(survey(usual[i].name, p, usual[i].plan).volume.a, here);
    const auto expected = slopes_of(fine[i], {}, kVolume), found = slopes_of(usual[i], {}, kVolume),
               better = slopes_of(tight[i], {}, kVolume);
    for (std::size_t k = 0; k < kParameters; ++k) {
      const double scale = std::fmax(here, std::fabs(expected[k] * fine[i].p[k]));
      if (!(scale > 0)) continue;
      const auto error = [&](double slope) { return std::fabs(slope - expected[k]) * std::fabs(fine[i].p[k]) / scale; };
      ++compared;
      if (error(found[k]) > 1e-7) ++beyond;
      EXPECT_LT(error(found[k]), 1e-5);
      EXPECT_LT(error(better[k]), 1e-8);
    }
  }
  EXPECT_LE(beyond, compared / 50);
}

}  // namespace
}  // namespace pkm::testing::crr
