// The shape types of 4PPa-2PaR's workspace: quantities of its mechanism file.
#include <cmath>

#include <gtest/gtest.h>

#include "engine/accelerators/four_ppa_two_par/model.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/golden.hpp"

namespace pkm::testing {
namespace {

using namespace four_ppa_two_par;

// The shape types of section 3.3, by counting the connected parts of a fine section of both branches.
TEST(FourPpaShape, TypesMatchTheConnectedParts) {
  const auto parts = [](const Geometry<double>& g, double c) {
    constexpr int n = 300;
    std::vector<int> cell(n * n, 0);
    const double w = g.b - g.a * c, top = g.l_u + 1.1 * g.l_d;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double x1 = g.l_d * (i + 0.5) / n, x2 = w - x1, z = -top + 2 * top * (j + 0.5) / n;  // height of D
        if (x2 < 0 || x2 > g.l_d) continue;
        bool ok = true;
        for (const double x : {x1, x2}) {
          const double sigma = std::sqrt(g.l_d * g.l_d - x * x);
          const auto below = [&](double z_c) { return z_c <= 0 && z_c >= -g.l_u; };
          ok = ok && (below(z + sigma) || below(z - sigma));
        }
        cell[static_cast<std::size_t>(i * n + j)] = ok;
      }
    int count = 0;
    std::vector<int> stack;
    for (int start = 0; start < n * n; ++start) {
      if (cell[static_cast<std::size_t>(start)] != 1) continue;
      int size = 0;
      stack.push_back(start);
      cell[static_cast<std::size_t>(start)] = 2;
      while (!stack.empty()) {
        const int at = stack.back(), i = at / n, j = at % n;
        stack.pop_back();
        ++size;
        for (const auto& [a, b] : {std::pair{i + 1, j}, {i - 1, j}, {i, j + 1}, {i, j - 1}})
          if (a >= 0 && a < n && b >= 0 && b < n && cell[static_cast<std::size_t>(a * n + b)] == 1) {
            cell[static_cast<std::size_t>(a * n + b)] = 2;
            stack.push_back(a * n + b);
          }
      }
      count += size > 20;
    }
    return count;
  };
  auto p = nominal();
  p[kA] = 0.2, p[kB] = 1.0, p[kLu] = 0.4;
  LimitSpec turning = no_limits(four_ppa().info());
  turning.given[kCosThetaMin] = 0.5;
  const struct {
    double l_d;
    int type, parts;
  } cases[] = {{0.39, 1, 0}, {0.42, 2, 1}, {0.445, 3, 1}, {0.48, 4, 2}, {0.7, 5, 2}};
  for (const auto& c : cases) {
    p[kLd] = c.l_d;
    const NamedValues of_design = quantities_of_design(four_ppa(), p, no_limits(four_ppa().info()));
    EXPECT_EQ(named(of_design, "shape_type_at_theta_0"), c.type) << c.l_d;
    EXPECT_EQ(parts(geometry(std::span<const double>(p)), 1.0), c.parts) << c.l_d;
    // b - a cos(theta) is the same for a larger b at another theta
    auto wide = p;
    wide[kB] = 0.9;
    EXPECT_EQ(named(quantities_of_design(four_ppa(), wide, turning), "shape_type_at_greatest_theta"), c.type) << c.l_d;
    const PoseReport report =
        four_ppa().inspect(wide, pkm::Pose<double>{0.45, 1.25, -0.15 - c.l_d, kPi / 3}, "lower,lower", turning);
    EXPECT_EQ(report.assembles, c.l_d > 0.4) << report.reason;
    if (report.assembles) {
      EXPECT_EQ(named(report.indices, "section_type"), c.type) << c.l_d;
    }
  }
}

}  // namespace
}  // namespace pkm::testing
