// Samples at nodes between the ends of the ranges of corner curves, against samples at nodes between critical values
// that are bracketed by slices.
#include <gtest/gtest.h>

#include "tests/unit/contracts/catalogue_problem.hpp"
#include "tests/unit/generic/slices_of.hpp"

namespace pkm {
namespace {

/// Integrals of 1, t, t v, v^2 and z t over the nodes, where t is the outer coordinate.
std::array<Dual4, 5> moments_of_nodes(const test::SlicesOf& slices, generic::IntegralScratch& scratch,
                                      const std::vector<Dual4>& inputs) {
  std::array<Dual4, 5> sums{};
  const GaussRule rule = gauss_legendre(4);
  slices.volume.slices().for_each_node<Dual4>(
      inputs, rule, rule, scratch,
      [&](const std::vector<Dual4>& outer, const Dual4& v, const Dual4& z, const Dual4& weight) {
        const Dual4& t = outer[0];
        const std::array<Dual4, 5> terms{Dual4(1.0), t, t * v, v * v, z * t};
        for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = sums[i] + weight * terms[i];
      });
  return sums;
}

class SampleNodes : public ::testing::TestWithParam<std::string> {};

TEST_P(SampleNodes, LieBetweenTheEndsOfRanges) {
  const Mechanism& mechanism = *test::described(GetParam());
  for (unsigned k = 0; k < 4; ++k) {
    Stream random(31, 0, k, Stream::Use::start);
    const std::vector<double> design =
        k == 0 ? test::nominal(mechanism.info()) : test::random_design(mechanism.info(), random);
    WorkspacePlan plan = test::columns(mechanism.info());
    if (k == 2) plan.limits = test::random_limits(mechanism.info(), random);
    if (mechanism.refuse(design)) continue;
    SCOPED_TRACE("design " + std::to_string(k) + ": " + test::told(mechanism.info(), design, plan));
    test::SlicesOf slices(mechanism, design, plan);
    std::vector<Dual4> parameters(design.begin(), design.end()), inputs;
    for (std::size_t i = 0; i < std::min<std::size_t>(4, design.size()); ++i)
      parameters[i] = Dual4::variable(design[i], static_cast<int>(i));
    generic::evaluation_of(mechanism)->fill_inputs<Dual4>(parameters, plan, 0, inputs);

    slices.volume.place_nodes(slices.inputs, true, slices.scratch);
    const long few = slices.scratch.integral.evaluations;
    const auto placed = moments_of_nodes(slices, slices.scratch.integral, inputs);
    const Integral<double> measured = slices.measure();
    const auto searched = moments_of_nodes(slices, slices.scratch.integral, inputs);
    EXPECT_LT(few, 0.7 * static_cast<double>(measured.evaluations)) << "the critical values were searched for";
    EXPECT_NEAR(placed[0].a, measured.value, 1e-2 * measured.value);  // four nodes for each interval
    // Slices can find a critical value that is none, or merge two: then one interval more or less has four nodes.
    constexpr double kValue = 1e-5, kDerivative = 1e-2;
    for (std::size_t i = 0; i < placed.size(); ++i) {
      EXPECT_NEAR(placed[i].a, searched[i].a, kValue * measured.value) << i;
      double size = measured.value;
      for (std::size_t d = 0; d < 4; ++d) size = std::max(size, std::fabs(searched[i].v.d[d]));
      for (std::size_t d = 0; d < 4; ++d) EXPECT_NEAR(placed[i].v.d[d], searched[i].v.d[d], kDerivative * size) << i;
    }
  }
}

/// In the working mode +,+,+ of the rotary Delta, rounding errors change the type of slices along cusps of the
/// boundary.
TEST(SampleNodesOfCusps, FillTheWorkspace) {
  std::string text = test::text_of_mechanism("rotary-delta");
  const std::string branch = "branch   = \"-\"";
  const std::size_t at = text.find(branch);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, branch.size(), "branch = \"+\"");
  const auto mechanism = read_mechanism_toml(text, "rotary-delta.toml");
  const std::vector<double> design = test::design_with(mechanism->info(), {{"q_max", 150 * kPi / 180}});
  const WorkspacePlan plan = test::columns(mechanism->info());
  const WorkspaceResult<double> edges = test::survey(*mechanism, design, plan);
  EXPECT_LT(edges.error, 1e-9);
  const WorkspaceResult<double> sampled = test::survey(*mechanism, design, plan, {.fields = {&kConditioning}});
  EXPECT_EQ(sampled.volume, edges.volume);
  EXPECT_LT(sampled.error, 1e-8);
  EXPECT_LT(sampled.columns, 2'000'000);  // two seconds; without the rule for noise, 20 millions
  double sum = 0;
  for (const double weight : sampled.weight) sum += weight;
  EXPECT_NEAR(sum, edges.volume, 1e-3 * edges.volume);  // six nodes for each interval
}

/// Beyond its budget the search for critical values ends, and the error includes the parts that are undecided.
TEST(SlicesOfABudget, HaveAnErrorThatIncludesWhatIsUndecided) {
  const Mechanism& mechanism = *test::described("rotary-delta");
  const std::vector<double> design = test::nominal(mechanism.info());
  const WorkspacePlan plan = test::columns(mechanism.info());
  const double volume = test::survey(mechanism, design, plan).volume;
  test::SlicesOf slices(mechanism, design, plan);
  for (const long evaluations : {1'000, 15'000, 20'000, 40'000, 80'000}) {
    const Integral<double> found =
        slices.volume.slices().measure(slices.inputs, slices.scratch.integral, {.evaluations = evaluations});
    EXPECT_LT(found.evaluations, evaluations + 20'000);
    EXPECT_LE(std::fabs(found.value - volume), found.error) << evaluations;
  }
}

INSTANTIATE_TEST_SUITE_P(All, SampleNodes,
                         ::testing::Values("3-rpr", "gough", "linear-delta", "orthoglide", "4ppa-2par"),
                         [](const auto& name) { return test::test_name(name.param); });

}  // namespace
}  // namespace pkm
