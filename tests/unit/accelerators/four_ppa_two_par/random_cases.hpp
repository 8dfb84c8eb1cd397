// Random designs of 4PPa-2PaR, with limits and a plane y.
#pragma once

#include <vector>

#include "tests/unit/accelerators/four_ppa_two_par/golden.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/plain_pose.hpp"

namespace pkm::testing {

using namespace four_ppa_two_par;

struct Case {
  std::vector<double> p;
  LimitSpec limits;
  double y;
};

/// Random designs around the paper's ranges; every second one with limits, every third off the middle plane, every
/// fifth with rails so short that the stroke cuts.
inline std::vector<Case> random_cases(int count, unsigned seed) {
  Uniform uniform(seed);
  std::vector<Case> cases;
  for (int i = 0; i < count; ++i) {
    Case c{nominal(), no_limits(four_ppa().info()), 0};
    c.p[kA] = uniform(0.15, 0.6);
    c.p[kB] = c.p[kA] + uniform(0.1, 1.0);
    c.p[kLu] = uniform(0.3, 1.2);
    c.p[kLd] = uniform(0.5, 1.2) * std::fmax(0.4, 0.5 * c.p[kB]) * 1.6;
    c.p[kD] = uniform(0, 0.3);
    c.p[kL0] = i % 5 == 4 ? uniform(0.8, 1.8) * c.p[kLu] : 2.5;
    if (i % 2 == 1) {
      const double drawn[] = {uniform(0, 0.3),  uniform(0, 0.3), uniform(1.0, 1.5),
                              uniform(0, 0.12), uniform(0, 0.5), uniform(0, 0.4)};
      std::ranges::copy(drawn, c.limits.given.begin());
    }
    c.y = i % 3 == 2 ? c.p[kL0] * uniform(0.2, 0.8) : c.p[kL0] / 2;
    cases.push_back(c);
  }
  return cases;
}

}  // namespace pkm::testing
