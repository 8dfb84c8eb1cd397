#include "engine/generic/corner_curves/coincidence.hpp"

#include <algorithm>

namespace pkm::generic::corner_curves {
namespace {

using CurvePair = DecompositionScratch::Pair;

/// Whether a curve that touches `other` without crossing it lies outside it. This is decided at the one of several
/// points of the curve that is farthest from `other`.
bool is_outside(const CurveAt& curve, const CurveAt& other) {
  double largest = 0;
  const double radius = std::sqrt(std::fmax(0, curve.c));
  for (const double sign : {1.0, -1.0})
    for (const Vector e : {Vector{0.6, 0.8}, Vector{-0.8, 0.6}}) {
      const Vector p = curve.is_circle ? Vector{curve.u + sign * radius * e.x, curve.w + sign * radius * e.y}
                                       : Vector{-curve.c * curve.u - sign * curve.w * (1 + e.x),
                                                -curve.c * curve.w + sign * curve.u * (1 + e.x)};
      const double h = other.h(p);
      if (std::fabs(h) > std::fabs(largest)) largest = h;
    }
  return largest > 0;
}

/// For three curves of which two touch each other for all tau: appends to each of the two other pairs the constant sign
/// which the touching curve that does not belong to the pair has at the crossings of the pair.
/// @param pairs     pairs (0, 1), (0, 2) and (1, 2) of the triple
/// @param touching  index (0 to 2) in `pairs` of the two curves that touch
void resolve_contact(const std::vector<BoundaryCurve>& curves, const std::array<std::size_t, 3>& triple,
                     const std::array<CurvePair*, 3>& pairs, std::size_t touching) {
  // For each pair, the indices in the triple of the two curves of the pair.
  constexpr std::size_t kMembers[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  const auto [a, b] = kMembers[touching];
  const std::size_t first = triple[a], second = triple[b], middle = kNodes / 2;
  const CurveAt f = curves[first].at_node(middle), g = curves[second].at_node(middle);
  for (std::size_t p = 0; p < 3; ++p) {
    if (p == touching) continue;
    const bool has_first = kMembers[p][0] == a || kMembers[p][1] == a;
    pairs[p]->constants.push_back(
        {static_cast<std::uint8_t>(has_first ? second : first), 0, has_first ? is_outside(f, g) : is_outside(g, f)});
  }
}

/// For a triple in which every two curves cross, and a pair of them: appends, for each branch of the pair's crossings,
/// the constant sign of the function h of the third curve or, if the third curve does not pass through this branch for
/// all tau, the values of tau at which it does (events).
/// @param third  index of the third curve
/// @param moved  index of that curve of the three which the perturbation moves outward
/// @param roots  scratch memory
/// @return false if the degeneracy is not supported
bool resolve_pair(const std::vector<BoundaryCurve>& curves, CurvePair& pair, std::size_t third, std::size_t moved,
                  std::vector<Root>& roots) {
  // Values of tau at which the discriminant of the pair is smaller, relative to its maximum, are not used as samples.
  constexpr double kWellConditioned = 0.01;
  constexpr double kCoincide = 1e-11;
  const Samples& d = pair.discriminant.values;
  const double smallest = pair.has_branches ? kWellConditioned * *std::ranges::max_element(d) : 0;
  const bool is_everywhere = !pair.has_branches || (pair.ends.empty() && d[0] > 0);
  const std::size_t fixed = pair.first == moved ? pair.second : pair.first;
  for (const double branch : {1.0, -1.0}) {
    if (branch < 0 && !pair.has_branches) break;
    Sampled h{};
    double largest = 0;
    int samples = 0, outside = 0;
    for (std::size_t n = 0; n < kNodes; ++n) {
      if (pair.has_branches && !(d[n] > 0)) continue;
      const Vector p = crossing(curves[pair.first].at_node(n), curves[pair.second].at_node(n), branch);
      h.values[n] = curves[third].at_node(n).h(p);
      if (pair.has_branches && d[n] < smallest) continue;
      largest = std::max(largest, std::fabs(h.values[n]));
      ++samples;
      // The perturbation moves the crossing along the other curve of the pair, to the point where h + epsilon = 0 for
      // the moved curve.
      const Vector along = curves[fixed].at_node(n).gradient(p);
      outside += third == moved || determinant(along, curves[third].at_node(n).gradient(p)) *
                                           determinant(along, curves[moved].at_node(n).gradient(p)) <
                                       0;
    }
    if (samples == 0) return false;
    if (largest <= kCoincide) {
      if (outside != 0 && outside != samples) return false;
      pair.constants.push_back(
          {static_cast<std::uint8_t>(third), static_cast<std::int8_t>(branch), outside == samples});
      continue;
    }
    if (!is_everywhere) return false;
    Samples series;
    to_coefficients(h.values, series);
    const double error = interpolation_error(series, 1e-14);
    if (error > 1e-9 * largest) return false;
    roots.clear();
    isolate_roots(series, error, roots);
    for (const Root& root : roots)
      pair.events.push_back({root.at, root.width, static_cast<std::uint8_t>(third), static_cast<std::int8_t>(branch)});
  }
  return true;
}

}  // namespace

bool resolve_coincidence(const std::vector<BoundaryCurve>& curves, const std::array<std::size_t, 3>& triple,
                         const std::array<CurvePair*, 3>& pairs, std::vector<Root>& roots) {
  const auto touching = std::ranges::count(pairs, nullptr);
  if (touching > 1) return false;
  if (touching == 1) {
    resolve_contact(curves, triple, pairs, static_cast<std::size_t>(std::ranges::find(pairs, nullptr) - pairs.begin()));
    return true;
  }
  const auto& [i, j, k] = triple;
  return resolve_pair(curves, *pairs[0], k, k, roots) && resolve_pair(curves, *pairs[1], j, k, roots) &&
         resolve_pair(curves, *pairs[2], i, k, roots);
}

}  // namespace pkm::generic::corner_curves
