#include "engine/report/dimensions.hpp"

#include <cmath>
#include <optional>

namespace pkm {
namespace {

/// Distances between all ends of links, those of end i from i * ends on.
std::vector<double> distances(const std::vector<PlacedLink>& links) {
  std::vector<Point3<double>> ends;
  for (const PlacedLink& link : links) {
    ends.push_back(link.body.axis.from);
    ends.push_back(link.body.axis.to);
  }
  std::vector<double> all;
  for (const auto& a : ends)
    for (const auto& b : ends) all.push_back(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
  return all;
}

/// 0: along one link, 1: within one part, 2: elsewhere.
int rank_of(const std::vector<PlacedLink>& links, std::size_t from, std::size_t to) {
  if (from / 2 == to / 2) return 0;
  return links[from / 2].part == links[to / 2].part ? 1 : 2;
}

}  // namespace

std::vector<Dimension> dimensions_of(const Mechanism& mechanism, std::span<const double> parameters,
                                     const Pose<double>& pose, const std::string& mode) {
  constexpr double kStep = 1e-4;   // of the parameter
  constexpr double kLevel = 1e-2;  // of the step: a change below it is none
  const auto& known = mechanism.info().parameters;
  const std::vector<PlacedLink> links = mechanism.links()->place(parameters, pose, mode);
  const std::vector<double> length = distances(links);
  const std::size_t ends = 2 * links.size();

  // How each distance follows each parameter; empty where the pose no longer assembles.
  std::vector<std::vector<double>> follows(known.size());
  for (std::size_t p = 0; p < known.size(); ++p) {
    if (known[p].unit != "m" || !(parameters[p] > 0)) continue;
    std::vector<double> changed(parameters.begin(), parameters.end());
    const double step = kStep * parameters[p];
    changed[p] += step;
    if (mechanism.refuse(changed)) continue;
    const std::vector<double> longer = distances(mechanism.links()->place(changed, pose, mode));
    if (longer.size() != length.size()) continue;
    for (std::size_t i = 0; i < length.size(); ++i) follows[p].push_back((longer[i] - length[i]) / step);
  }

  std::vector<Dimension> found;
  for (std::size_t p = 0; p < known.size(); ++p) {
    if (follows[p].empty()) continue;
    std::optional<Dimension> best;
    for (std::size_t from = 0; from < ends; ++from)
      for (std::size_t to = from + 1; to < ends; ++to) {
        const std::size_t i = from * ends + to;
        if (std::abs(length[i] - parameters[p]) > 1e-9 * parameters[p]) continue;
        bool alone = std::abs(follows[p][i] - 1) < kLevel;
        for (std::size_t other = 0; other < known.size(); ++other)
          alone = alone && (other == p || follows[other].empty() || std::abs(follows[other][i]) < kLevel);
        if (alone && (!best || rank_of(links, from, to) < rank_of(links, best->from, best->to)))
          best = Dimension{p, from, to};
      }
    if (best) found.push_back(*best);
  }
  return found;
}

}  // namespace pkm
