#include "engine/math/quadrature.hpp"

#include "engine/math/roots.hpp"

namespace pkm {

GaussRule gauss_legendre(int n) {
  GaussRule rule;
  rule.node.resize(static_cast<std::size_t>(n));
  rule.weight.resize(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    double x = -portable::cos(kPi * (i + 0.75) / (n + 0.5));  // starting value with an error of O(1/n^2)
    double derivative = 1;
    const auto newton_step = [&](double at) {
      double previous = 1, value = at;  // Legendre polynomials P_0 and P_1 at x
      for (int k = 2; k <= n; ++k) {
        const double next = ((2 * k - 1) * at * value - (k - 1) * previous) / k;
        previous = value;
        value = next;
      }
      if (n == 1) previous = 1;
      derivative = n * (at * value - previous) / (at * at - 1);
      return -value / derivative;
    };
    // 12 steps are sufficient, even if rounding errors of P_n keep the last one above the limit.
    x = iterate_newton(newton_step, x, -1, 1, 12, [](double, double step) { return std::fabs(step) < 1e-16; }).x;
    rule.node[static_cast<std::size_t>(i)] = 0.5 * (1 + x);
    rule.weight[static_cast<std::size_t>(i)] = 1 / ((1 - x * x) * derivative * derivative);
  }
  return rule;
}

const NestedRule& kronrod_rule() {
  // Non-negative nodes on [-1, 1] with their weights (w: Kronrod, g: Gauss), computed from the Stieltjes polynomial
  // with 50 digits.
  static constexpr std::array<double, 8> x = {0.0,
                                              0.2077849550078984676,
                                              0.4058451513773971669,
                                              0.5860872354676911303,
                                              0.7415311855993944399,
                                              0.8648644233597690728,
                                              0.9491079123427585245,
                                              0.9914553711208126392};
  static constexpr std::array<double, 8> w = {0.209482141084727828,   0.2044329400752988924, 0.1903505780647854099,
                                              0.1690047266392679028,  0.1406532597155259187, 0.1047900103222501838,
                                              0.06309209262997855329, 0.02293532201052922496};
  static constexpr std::array<double, 8> g = {0.4179591836734693878, 0, 0.381830050505118945,  0,
                                              0.2797053914892766679, 0, 0.1294849661688696933, 0};
  static const NestedRule rule = [] {
    NestedRule r{.node = {}, .level = {{.nodes = 15, .weight = {}, .fewer = {}}}};
    NestedRule::Level& level = r.level[0];
    for (std::size_t i = 0; i < 8; ++i) {
      r.node[7 + i] = 0.5 + 0.5 * x[i];
      r.node[7 - i] = 0.5 - 0.5 * x[i];
      level.weight[7 + i] = level.weight[7 - i] = 0.5 * w[i];
      level.fewer[7 + i] = level.fewer[7 - i] = 0.5 * g[i];
    }
    return r;
  }();
  return rule;
}

const NestedRule& patterson_rule() {
  // Non-negative nodes on [-1, 1] with their weights, computed with 60 digits: the nodes of the 3-point Gauss rule,
  // followed by the nodes that the 7-point and the 15-point rule add, which maximise the degree of exactness.
  static constexpr std::array<double, 8> x = {0.0,
                                              0.77459666924148337704,
                                              0.434243749346802558,
                                              0.96049126870802028342,
                                              0.22338668642896688163,
                                              0.62110294673722640294,
                                              0.88845923287225699889,
                                              0.99383196321275502221};
  static constexpr std::array<double, 8> fifteen = {
      0.22551049979820668739, 0.13441525524378422036, 0.20062852937698902103,  0.051603282997079739697,
      0.2191568584015874964,  0.17151190913639138079, 0.092927195315124537686, 0.017001719629940260339};
  static constexpr std::array<double, 4> seven = {0.45091653865847414235, 0.26848808986833344073,
                                                  0.40139741477596222291, 0.10465622602646726519};
  static constexpr std::array<double, 2> gauss = {0.88888888888888888889, 0.55555555555555555556};
  static const NestedRule rule = [] {
    NestedRule r{.node = {},
                 .level = {{.nodes = 7, .weight = {}, .fewer = {}}, {.nodes = 15, .weight = {}, .fewer = {}}}};
    std::size_t n = 0;
    const auto add = [&](std::size_t i, double sign) {
      r.node[n] = 0.5 + sign * 0.5 * x[i];
      r.level[1].weight[n] = 0.5 * fifteen[i];
      if (i < seven.size()) r.level[0].weight[n] = r.level[1].fewer[n] = 0.5 * seven[i];
      if (i < gauss.size()) r.level[0].fewer[n] = 0.5 * gauss[i];
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
