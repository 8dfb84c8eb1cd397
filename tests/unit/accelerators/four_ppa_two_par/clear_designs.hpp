// Designs of 4PPa-2PaR whose links come near each other, and their clearance.
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "engine/accelerators/four_ppa_two_par/clear_volume.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/golden.hpp"

namespace pkm::testing {

using namespace four_ppa_two_par;

using Changes = std::vector<std::pair<ParameterIndex, double>>;

inline constexpr double kRoundoff = 1e-12;

using Vector3 = Eigen::Vector3d;

inline Vector3 at(const Point3<double>& p) { return {p[0], p[1], p[2]}; }

inline std::vector<double> with(const Changes& changes) {
  auto p = nominal();
  for (const auto& [index, value] : changes) p[index] = value;
  return p;
}

inline LimitSpec no_limits_of_four_ppa() { return no_limits(four_ppa().info()); }

inline LimitSpec clearance(double min) {
  LimitSpec spec = no_limits_of_four_ppa();
  spec.given[kClearanceMin] = min;
  return spec;
}

/// Designs in which more than the sliders matters: thick links, a large minimum clearance, rails near to each other.
struct Exotic {
  Changes changes;
  double min_clearance;  ///< clearance_min [m]
};

inline std::vector<Exotic> exotics() {
  return {
      {{{kA, 0.3}, {kB, 0.35}, {kRs, 0.1}, {kRu, 0.05}, {kD, 0.4}}, 0.22},   // sliders and bars of different rails
      {{{kA, 0.3}, {kB, 0.3}, {kRs, 0.01}, {kD, 0.5}, {kDd, 0.01}}, 0.275},  // all links of different limbs
      {{{kA, 0.25}, {kB, 0.55}, {kLd, 0.3}, {kD, 0.6}, {kDd, 0.01}, {kRp, 0.35}, {kRu, 0.15}},
       0.2},  // a thick platform
      {{{kA, 0.4}, {kB, 0.45}, {kLd, 0.3}, {kLu, 0.5}, {kD, 0.6}, {kDd, 0.02}, {kRd, 0.02}, {kRs, 0.01}}, 0.28},
  };
}

/// Random designs of every proportion, thick and thin.
struct ClearanceCase {
  std::vector<double> p;
  double min_clearance;  ///< clearance_min [m]
};

inline ClearanceCase random_clearance_case(Uniform& uniform) {
  auto p = nominal();
  p[kA] = uniform(0.05, 0.6);
  p[kB] = uniform(0.05, 1.2);
  p[kLu] = uniform(0.3, 1.2);
  p[kLd] = uniform(0.3, 1.0);
  p[kD] = uniform(0, 0.4);
  p[kDd] = uniform(0.01, 0.3);
  p[kDu] = uniform(0.01, 0.2);
  p[kRu] = uniform(0, 0.1);
  p[kRs] = uniform(0, 0.1);
  p[kRd] = uniform(0, 0.01);
  p[kRp] = uniform(0, 0.01);
  return {p, uniform(-0.05, 0.15)};
}

}  // namespace pkm::testing
