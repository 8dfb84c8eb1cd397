// Between critical values of beta, slices have one combinatorial type; at each critical value it changes.
#include <gtest/gtest.h>

#include "engine/accelerators/hybrid/critical_values.hpp"
#include "tests/unit/accelerators/hybrid/golden.hpp"

namespace pkm::testing::hybrid {
namespace {

template <class S>
SlicedDesign<S> unlimited_design(const std::vector<double>& design, const WorkingMode& mode) {
  const std::vector<S> p(design.begin(), design.end());
  const std::span<const S> all(p);
  return sliced_design(geometry(all), limits(all, no_limits(mechanism().info())), mode, 1);
}

/// Designs of the golden data, each shifted a little, so that nearly all have a workspace.
std::vector<std::vector<double>> designs(int count) {
  Uniform uniform(21);
  std::vector<std::vector<double>> all;
  const auto& golden_ones = golden()["designs"];
  for (int i = 0; i < count; ++i) {
    all.push_back(design_from(golden_ones[static_cast<std::size_t>(i) % golden_ones.size()]));
    for (double& value : all.back()) value *= 1 + uniform(-0.04, 0.04);
  }
  return all;
}

TEST(HybridCriticalValues, SlicesKeepTheirTypeBetweenCriticalValues) {
  constexpr int kBetas = 60;
  int critical_values = 0;
  CriticalValueScratch scratch;
  StripScratch strips;
  Decomposition decomposition;
  for (const std::vector<double>& design : designs(30)) {
    const auto f = unlimited_design<double>(design, {1, -1, -1});
    const auto at = [&](double beta) -> const Decomposition& {
      decompose(slice(f, beta), strips, decomposition);
      return decomposition;
    };
    find_beta_intervals(f, unlimited_design<Dual<1>>(design, {1, -1, -1}), scratch);
    double before = f.l.beta_min;
    for (std::size_t i = 0; i < scratch.count; ++i) {
      const BetaInterval& s = scratch.intervals[i];
      ASSERT_GE(s.lower, before);
      const double length = s.upper - s.lower;
      const double inside =
          std::fmin(0.1 * length, 1e-6 * (f.l.beta_max - f.l.beta_min));  // of an inaccurate critical value
      if (s.lower > before) {
        EXPECT_TRUE(at(0.5 * (before + s.lower)).strips.empty());
      }
      EXPECT_FALSE(s.decomposition.strips.empty());
      for (int k = 0; k <= kBetas; ++k)
        ASSERT_TRUE(same_type(at(s.lower + inside + (length - 2 * inside) * k / kBetas), s.decomposition))
            << "interval " << i << " [" << s.lower << ", " << s.upper << "] " << k;
      if (s.at_lower) {
        const double beside = std::fmin(1e-5, 0.1 * length);
        EXPECT_FALSE(same_type(at(s.lower - beside), s.decomposition));
        ++critical_values;
      }
      before = s.upper;
    }
    if (before < f.l.beta_max) {
      EXPECT_TRUE(at(0.5 * (before + f.l.beta_max)).strips.empty());
    }
  }
  EXPECT_GT(critical_values, 300);
}

}  // namespace
}  // namespace pkm::testing::hybrid
