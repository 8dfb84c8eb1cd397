#include "engine/report/dimensions.hpp"

#include <cmath>
#include <optional>

namespace pkm {
namespace {

/// Distances between all pairs of link ends. With n ends, element i * n + j is the distance between ends i and j.
std::vector<double> end_distances(const std::vector<PlacedLink>& links) {
  std::vector<Point3<double>> ends;
  for (const PlacedLink& link : links) {
    ends.push_back(link.body.axis.from);
    ends.push_back(link.body.axis.to);
  }
  std::vector<double> distances;
  for (const auto& a : ends)
    for (const auto& b : ends) distances.push_back(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
  return distances;
}

/// Rank of a distance between two link ends as a dimension of the drawing; the lowest rank is preferred. 0: the
/// distance is along one link, 1: within one part, 2: between two parts.
int preference(const std::vector<PlacedLink>& links, std::size_t from, std::size_t to) {
  if (from / 2 == to / 2) return 0;
  return links[from / 2].part == links[to / 2].part ? 1 : 2;
}

}  // namespace

std::vector<Dimension> dimensions_of(const Mechanism& mechanism, std::span<const double> parameters,
                                     const Pose<double>& pose, const std::string& mode) {
  constexpr double kRelativeStep = 1e-4;  // step of the forward differences, relative to the parameter
  // Derivatives of distances that differ from 0 or 1 by less than this are regarded as 0 or 1, because forward
  // differences have truncation errors.
  constexpr double kTolerance = 1e-2;
  const auto& infos = mechanism.info().parameters;
  const std::vector<PlacedLink> links = mechanism.links()->place(parameters, pose, mode);
  const std::vector<double> length = end_distances(links);
  const std::size_t ends = 2 * links.size();

  // For each length parameter, the derivatives of all distances with respect to it; empty if the mechanism cannot be
  // assembled at the pose after the step.
  std::vector<std::vector<double>> derivatives(infos.size());
  for (std::size_t p = 0; p < infos.size(); ++p) {
    if (infos[p].unit != "m" || !(parameters[p] > 0)) continue;
    std::vector<double> changed(parameters.begin(), parameters.end());
    const double step = kRelativeStep * parameters[p];
    changed[p] += step;
    if (mechanism.refuse(changed)) continue;
    const std::vector<double> changed_length = end_distances(mechanism.links()->place(changed, pose, mode));
    if (changed_length.size() != length.size()) continue;
    for (std::size_t i = 0; i < length.size(); ++i) derivatives[p].push_back((changed_length[i] - length[i]) / step);
  }

  std::vector<Dimension> found;
  for (std::size_t p = 0; p < infos.size(); ++p) {
    if (derivatives[p].empty()) continue;
    std::optional<Dimension> best;
    for (std::size_t from = 0; from < ends; ++from)
      for (std::size_t to = from + 1; to < ends; ++to) {
        const std::size_t i = from * ends + to;
        if (std::abs(length[i] - parameters[p]) > 1e-9 * parameters[p]) continue;
        bool fits = std::abs(derivatives[p][i] - 1) < kTolerance;
        for (std::size_t other = 0; other < infos.size(); ++other)
          fits = fits && (other == p || derivatives[other].empty() || std::abs(derivatives[other][i]) < kTolerance);
        if (fits && (!best || preference(links, from, to) < preference(links, best->from, best->to)))
          best = Dimension{p, from, to};
      }
    if (best) found.push_back(*best);
  }
  return found;
}

}  // namespace pkm
