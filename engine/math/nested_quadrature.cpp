#include "engine/math/nested_quadrature.hpp"

namespace pkm {

const NestedRule& nested_rule() {
  // Nodes and weights on [-1, 1], non-negative half, computed with 60 digits: those of the 3-point Gauss rule, then
  // twice the zeros of the polynomial that makes the rule with them the most exact.
  static constexpr std::array<double, 8> x = {0.0,
                                              0.77459666924148337704,
                                              0.434243749346802558,
                                              0.96049126870802028342,
                                              0.22338668642896688163,
                                              0.62110294673722640294,
                                              0.88845923287225699889,
                                              0.99383196321275502221};
  static constexpr std::array<double, 8> all = {0.22551049979820668739,  0.13441525524378422036, 0.20062852937698902103,
                                                0.051603282997079739697, 0.2191568584015874964,  0.17151190913639138079,
                                                0.092927195315124537686, 0.017001719629940260339};
  static constexpr std::array<double, 4> first = {0.45091653865847414235, 0.26848808986833344073,
                                                  0.40139741477596222291, 0.10465622602646726519};
  static constexpr std::array<double, 2> least = {0.88888888888888888889, 0.55555555555555555556};
  static const NestedRule rule = [] {
    NestedRule r{};
    std::size_t n = 0;
    const auto add = [&](std::size_t i, double sign) {
      r.node[n] = 0.5 + sign * 0.5 * x[i];
      r.weight[n] = 0.5 * all[i];
      if (i < first.size()) r.first_weight[n] = 0.5 * first[i];
      if (i < least.size()) r.least_weight[n] = 0.5 * least[i];
      ++n;
    };
    add(0, 0);
    for (std::size_t i = 1; i < x.size(); ++i)
      for (const double sign : {-1.0, 1.0}) add(i, sign);
    return r;
  }();
  return rule;
}

}  // namespace pkm
