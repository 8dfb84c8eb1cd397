// Conditioning of 4PPa-2PaR: its closed form at a pose, and over the workspace by columns and by voxels.
#include <cmath>

#include <gtest/gtest.h>

#include "engine/accelerators/four_ppa_two_par/columns.hpp"
#include "engine/accelerators/four_ppa_two_par/voxels.hpp"
#include "engine/math/statistics.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/limbs_at.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/random_cases.hpp"

namespace pkm::testing {
namespace {

using namespace four_ppa_two_par;

TEST(FourPpaConditioning, SamplesAddUpAndVoxelsConvergeToThem) {
  for (const Case& c : random_cases(12, 9)) {
    const FixedCoordinate fixed_y = at_y(c.y);
    FieldRequest request;
    request.add(kConditioning);
    const auto exact = survey(c.p, columns(c.limits, fixed_y), request);
    double sum = 0;
    for (const double w : exact.weight) sum += w;
    EXPECT_NEAR(sum, exact.volume, 1e-5 * exact.volume);
    if (exact.volume < 0.05) continue;
    const auto cells = survey(c.p, voxels(c.limits, {64, 68, 80}, fixed_y), request);
    double counted = 0;  // a sample stands for its mirror images too
    for (const double w : cells.weight) counted += w / cells.cell_volume;
    EXPECT_NEAR(counted, static_cast<double>(cells.feasible_cells), 1e-6);
    EXPECT_NEAR(weighted_mean(cells.weight, cells.field(kConditioning)),
                weighted_mean(exact.weight, exact.field(kConditioning)), 3e-3);
    for (const double value : exact.field(kConditioning)) ASSERT_TRUE(value >= 0 && value <= 1);
  }
}

TEST(FourPpaConditioning, KernelEqualsTheGenericEngine) {
  Uniform uniform(10);
  int compared = 0;
  for (const Case& c : random_cases(60, 10)) {
    const auto g = geometry(std::span<const double>(c.p));
    for (int i = 0; i < 100; ++i) {
      const SchoenfliesPose<double> pose{uniform(0, c.p[kB]), c.y, uniform(-(c.p[kLu] + c.p[kLd]), 0),
                                         uniform(-kPi / 2, kPi / 2)};
      const PoseReport r = four_ppa().inspect(c.p, pose, "lower,lower", no_limits(four_ppa().info()));
      if (!r.feasible || !r.J) continue;
      const auto limb = limbs_at(g, pose, kLowerMode);
      ASSERT_TRUE(limb);
      const auto [s, co] = sincos(pose.angle);
      const double fast = conditioning<double, double>({g.l_u, 1.0, s, co, limb->x, limb->sigma}, limb->z_c);
      EXPECT_NEAR(fast, *r.conditioning, 1e-12);
      ++compared;
    }
  }
  EXPECT_GT(compared, 300);
}

}  // namespace
}  // namespace pkm::testing
