// Between the breaks of beta sections keep their structure, and at each break it changes.
#include <gtest/gtest.h>

#include "engine/accelerators/hybrid/critical_values.hpp"
#include "tests/unit/accelerators/hybrid/golden.hpp"

namespace pkm::testing::hybrid {
namespace {

template <class S>
Frame<S> unlimited_frame(const std::vector<double>& design, const WorkingMode& mode) {
  const std::vector<S> p(design.begin(), design.end());
  const std::span<const S> all(p);
  return frame(geometry(all), limits(all, no_limits(mechanism().info())), mode, 1);
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

TEST(HybridBreaks, SectionsKeepTheirStructureInBetween) {
  constexpr int kBetas = 60;
  int breaks = 0;
  BreakScratch scratch;
  StripScratch strips;
  Structure structure;
  for (const std::vector<double>& design : designs(30)) {
    const auto f = unlimited_frame<double>(design, {1, -1, -1});
    const auto at = [&](double beta) -> const Structure& {
      find_strips(section(f, beta), strips, structure);
      return structure;
    };
    find_stretches(f, unlimited_frame<Dual<1>>(design, {1, -1, -1}), scratch);
    double before = f.l.beta_min;
    for (std::size_t i = 0; i < scratch.count; ++i) {
      const Stretch& s = scratch.stretches[i];
      ASSERT_GE(s.lower, before);
      const double length = s.upper - s.lower;
      const double inside = std::fmin(0.1 * length, 1e-6 * (f.l.beta_max - f.l.beta_min));  // of a break not followed
      if (s.lower > before) {
        EXPECT_TRUE(at(0.5 * (before + s.lower)).strips.empty());
      }
      EXPECT_FALSE(s.structure.strips.empty());
      for (int k = 0; k <= kBetas; ++k)
        ASSERT_TRUE(alike(at(s.lower + inside + (length - 2 * inside) * k / kBetas), s.structure))
            << "stretch " << i << " [" << s.lower << ", " << s.upper << "] " << k;
      if (s.at_lower) {
        const double beside = std::fmin(1e-5, 0.1 * length);
        EXPECT_FALSE(alike(at(s.lower - beside), s.structure));
        ++breaks;
      }
      before = s.upper;
    }
    if (before < f.l.beta_max) {
      EXPECT_TRUE(at(0.5 * (before + f.l.beta_max)).strips.empty());
    }
  }
  EXPECT_GT(breaks, 300);
}

}  // namespace
}  // namespace pkm::testing::hybrid
