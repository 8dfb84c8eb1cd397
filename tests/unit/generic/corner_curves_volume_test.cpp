// Volumes of mechanism files by corner curves or edges, compared with those of slices and with certified bounds.
// PKM_CORNER_DESIGNS: number of random designs of each mechanism; PKM_CORNER_FIRST: number of the first one, to repeat
// a case.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "engine/workspace/pose_quantities.hpp"
#include "tests/unit/contracts/catalogue_problem.hpp"
#include "tests/unit/generic/slices_of.hpp"

namespace pkm {
namespace {

class CornerCurveVolumes : public ::testing::TestWithParam<std::string> {};

TEST_P(CornerCurveVolumes, AreThoseOfSlices) {
  const Mechanism& mechanism = *test::described(GetParam());
  const WorkspacePlan plan = test::columns(mechanism.info());
  const std::vector<double> design = test::nominal(mechanism.info());
  const WorkspaceResult<double> curves = test::survey(mechanism, design, plan),
                                sampled = test::survey(mechanism, design, plan, {.fields = {&kConditioning}});
  const Integral<double> slices = test::SlicesOf(mechanism, design, plan).measure();
  EXPECT_GT(curves.volume, 0);
  EXPECT_NE(curves.columns, slices.evaluations);  // by different methods
  EXPECT_EQ(curves.volume, sampled.volume);
  EXPECT_LT(curves.error, 1e-8);
  EXPECT_LE(sampled.error, curves.error + 1e-10);
  EXPECT_NEAR(curves.volume, slices.value, slices.error + (curves.error + 1e-10) * curves.volume);
}

/// Volumes without samples: of the Deltas, the Orthoglide and the Gough platform by edges where these are closed,
/// otherwise by corner curves. Slices may miss a component of a thin workspace: where both volumes differ, certified
/// bounds have to contain the one without slices.
TEST_P(CornerCurveVolumes, OfRandomDesignsAreThoseOfSlices) {
  const auto number = [](const char* name, unsigned otherwise) {
    const char* const text = std::getenv(name);
    return text ? static_cast<unsigned>(std::atoi(text)) : otherwise;
  };
  const unsigned designs = number("PKM_CORNER_DESIGNS", 5), first = number("PKM_CORNER_FIRST", 0);
  const Mechanism& mechanism = *test::described(GetParam());
  unsigned compared = 0, different = 0, uncertain = 0;
  double largest = 0;
  for (unsigned k = first; compared < designs && k < first + 40 * designs; ++k) {
    Stream random(23, 0, k, Stream::Use::start);
    std::vector<double> design = test::random_design(mechanism.info(), random);
    if (k % 4 >= 2)  // round numbers, for which constraints meet
      for (std::size_t i = 0; i < design.size(); ++i)
        if (random.chance(0.5)) design[i] = mechanism.info().parameters[i].nominal;
    WorkspacePlan plan = test::columns(mechanism.info());
    if (k % 3 > 0) plan.limits = test::random_limits(mechanism.info(), random);
    if (mechanism.refuse(design)) continue;
    const WorkspaceResult<double> curves = test::survey(mechanism, design, plan);
    if (!(curves.volume > 0)) continue;
    ++compared;
    uncertain += curves.error > 1e-6;
    const Integral<double> slices = test::SlicesOf(mechanism, design, plan).measure();
    const double difference = (std::fabs(curves.volume - slices.value) - slices.error) / curves.volume - curves.error;
    if (difference <= 1e-8) {
      largest = std::max(largest, difference);
      continue;
    }
    ++different;
    SCOPED_TRACE("design " + std::to_string(k) + ": " + test::told(mechanism.info(), design, plan));
    const VolumeBounds bounds = mechanism.bounds()->volume(design, plan, "", {.gap = 1e-3, .max_boxes = 100'000U});
    const double allowed = (curves.error + 1e-9) * curves.volume;
    EXPECT_LE(bounds.lower, curves.volume + allowed);
    EXPECT_GE(bounds.upper, curves.volume - allowed);
  }
  EXPECT_EQ(compared, designs);
  EXPECT_LE(uncertain, 1 + designs / 100);
  std::cout << GetParam() << ": " << compared << " volumes, largest relative difference beyond the errors of slices "
            << largest << ", " << different << " with components that slices miss, " << uncertain
            << " with errors above 1e-6\n";
}

INSTANTIATE_TEST_SUITE_P(All, CornerCurveVolumes,
                         ::testing::Values("3-rpr", "gough", "linear-delta", "orthoglide", "4ppa-2par", "rotary-delta",
                                           "2t1r-p-hybrid"),
                         [](const auto& name) { return test::test_name(name.param); });

/// A limit on x and theta that is no polynomial, |sin(beta_1 + beta_2)| of 4PPa-2PaR, between thresholds that cut all
/// and nothing: its boundaries x(theta) appear, merge and leave the range. Volumes against those of slices, derivatives
/// against differences.
TEST(CornerCurveDesigns, OfLimitsOfTwoCoordinatesAreThoseOfSlices) {
  const Mechanism& mechanism = *test::described("4ppa-2par");
  const auto& limits = mechanism.info().limits;
  const auto limit =
      static_cast<std::size_t>(std::ranges::find(limits, "sin_par_min", &LimitInfo::name) - limits.begin());
  unsigned compared = 0;
  for (unsigned k = 0; compared < 12; ++k) {
    Stream random(29, 0, k, Stream::Use::start);
    std::vector<double> design = test::random_design(mechanism.info(), random);
    WorkspacePlan plan = test::columns(mechanism.info());
    plan.limits.given[limit] = 0.4 + 0.59 * random.u01();
    if (mechanism.refuse(design)) continue;
    SCOPED_TRACE("design " + std::to_string(k) + ": " + test::told(mechanism.info(), design, plan));
    const auto volume = [&] { return test::survey(mechanism, design, plan); };
    const WorkspaceResult<double> found = volume();
    if (!(found.volume > 1e-3)) continue;
    ++compared;
    EXPECT_LT(found.error, 1e-8);
    const Integral<double> slices = test::SlicesOf(mechanism, design, plan).measure();
    EXPECT_NEAR(found.volume, slices.value, slices.error + 1e-8 * found.volume);
    std::vector<Dual4> duals(design.begin(), design.end());
    for (std::size_t i = 0; i < 4; ++i) duals[i] = Dual4::variable(design[i], static_cast<int>(i));
    WorkspaceResult<Dual4> with_derivatives;
    evaluate_once<Dual4>(*prepare_workspace(mechanism, plan, {}), duals, with_derivatives);
    for (std::size_t i = 0; i < 4; ++i) {
      constexpr double kStep = 1e-6;
      const double own = design[i];
      design[i] = own + kStep;
      const double above = volume().volume;
      design[i] = own - kStep;
      const double below = volume().volume;
      design[i] = own;
      EXPECT_NEAR(with_derivatives.volume.v[static_cast<int>(i)], (above - below) / (2 * kStep), 2e-5 * found.volume);
    }
  }
}

/// Where the two lines that bound a constraint are about to merge, their rounding errors are larger than those of other
/// curves, and equal lines of several constraints differ by them.
TEST(CornerCurveDesigns, WithLinesThatMergeAreNotLeftToSlices) {
  for (const char* name : {"3crr-r-cru", "quadrupteron"}) {
    const Mechanism& mechanism = *test::described(name);
    const WorkspacePlan plan = test::columns(mechanism.info());
    constexpr unsigned kDesigns = 60;
    unsigned by_slices = 0;
    for (unsigned k = 0; k < kDesigns; ++k) {
      Stream random(31, 0, k, Stream::Use::start);
      std::vector<double> design = test::nominal(mechanism.info());
      for (double& each : design) each *= 0.95 + 0.1 * random.u01();
      const WorkspaceResult<double> found = test::survey(mechanism, design, plan);
      EXPECT_GT(found.volume, 0);
      EXPECT_LT(found.error, 1e-8);
      by_slices += found.is_sampled;
    }
    EXPECT_LE(by_slices, 1U) << name;
  }
}

/// Legs with a stroke of 13 mm: slices miss most of the components. The bounds are those of `pkmopt certify`.
TEST(CornerCurveDesigns, OfThinStrokesLieInTheCertifiedBounds) {
  const Mechanism& mechanism = *test::described("3-rpr");
  const std::vector<double> design = test::design_with(mechanism.info(), {{"A1x", 0.10170110103847341},
                                                                          {"A1y", 0.6979337325463222},
                                                                          {"A2x", 0.6173104886345318},
                                                                          {"A2y", 1.0111841100685468},
                                                                          {"A3x", -0.6836775189068626},
                                                                          {"A3y", -0.23010072147958027},
                                                                          {"B1x", -0.3267446415819135},
                                                                          {"B1y", 0.6562173059281193},
                                                                          {"B2x", -0.406658967902914},
                                                                          {"B2y", 0.6971880839967595},
                                                                          {"B3x", 0.6152891032779118},
                                                                          {"B3y", -0.4950647695248427},
                                                                          {"rmin", 0.3396263003514622},
                                                                          {"rmax", 0.3523600781097925},
                                                                          {"phi_min", -3.1},
                                                                          {"phi_max", 3.1}});
  const WorkspaceResult<double> found = test::survey(mechanism, design, test::columns(mechanism.info()));
  EXPECT_GT(found.volume, 5.614e-6);
  EXPECT_LT(found.volume, 5.902e-6);
  EXPECT_LT(found.error, 1e-6);
}

/// The bend of the hybrid robot's auxiliary chain bounds its slices by hyperbolas. Derivatives against differences, and
/// the volume against certified bounds.
TEST(CornerCurveDesigns, BoundedByConicsHaveTheDerivativesOfDifferences) {
  const Mechanism& mechanism = *test::described("2t1r-p-hybrid");
  std::vector<double> design = test::nominal(mechanism.info());
  for (std::size_t i = 0; i < design.size(); ++i) design[i] *= 1 + 0.002 * static_cast<double>(i % 7);
  const WorkspacePlan plan = test::columns(mechanism.info());
  const auto evaluator = mechanism.columns()->prepare(plan, *plan.columns(), {});
  const auto volume = [&](const std::vector<double>& changed) {
    WorkspaceResult<double> result;
    evaluate_once<double>(*evaluator, changed, result);
    return result;
  };
  const WorkspaceResult<double> found = volume(design);
  EXPECT_LT(found.error, 1e-8);
  EXPECT_NE(found.columns, test::SlicesOf(mechanism, design, plan).measure().evaluations);  // by different methods
  const VolumeBounds bounds = mechanism.bounds()->volume(design, plan, "", {.gap = 0.1, .max_boxes = 100'000U});
  EXPECT_LT(bounds.lower, found.volume);
  EXPECT_GT(bounds.upper, found.volume);
  for (const char* name : {"a", "c", "d", "e", "L1", "L3", "f", "fp", "h1", "phi_max", "mu_max", "psiC_max"}) {
    SCOPED_TRACE(name);
    const auto i = static_cast<std::size_t>(std::ranges::find(mechanism.info().parameters, name, &Parameter::name) -
                                            mechanism.info().parameters.begin());
    std::vector<Dual4> duals(design.begin(), design.end());
    duals[i] = Dual4::variable(design[i], 0);
    WorkspaceResult<Dual4> with_derivative;
    evaluate_once<Dual4>(*evaluator, duals, with_derivative);
    constexpr double kStep = 1e-6;
    std::vector<double> above = design, below = design;
    above[i] += kStep;
    below[i] -= kStep;
    EXPECT_NEAR(with_derivative.volume.v[0], (volume(above).volume - volume(below).volume) / (2 * kStep), 2e-7);
  }
}

/// Symmetry puts several events at one place, at which rounding decides single signs.
TEST(CornerCurveDesigns, OfSymmetricDesignsFollowAllSigns) {
  const Mechanism& mechanism = *test::described("linear-delta");
  const std::vector<double> design = test::design_with(mechanism.info(), {{"R", 0.19227194288633276},
                                                                          {"r", 0.062142444450779211},
                                                                          {"l", 0.49528575096282645},
                                                                          {"q_max", 0.41382026699502439}});
  EXPECT_NEAR(test::survey(mechanism, design, test::columns(mechanism.info())).volume, 0.11670080582235, 1e-9);
}

}  // namespace
}  // namespace pkm
