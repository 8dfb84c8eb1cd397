#include "engine/workspace/installation_space.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "engine/core/stop.hpp"
#include "engine/core/team.hpp"

namespace pkm {
namespace {

/// Bounding box and link lengths over the poses that one worker thread has evaluated.
struct Extents {
  std::optional<Bounds<double>> box;
  std::vector<double> lengths;  ///< maximum length of the axis of each link [m], by link; 0 for links of the frame

  void add(const std::vector<PlacedLink>& links) {
    lengths.resize(links.size());
    for (std::size_t i = 0; i < links.size(); ++i) {
      const Capsule<double>& capsule = links[i].body;
      Bounds<double> own = bounds_of(capsule.axis);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        own.lower[axis] -= capsule.radius;
        own.upper[axis] += capsule.radius;
      }
      box = box ? joined(*box, {own.lower, own.upper}) : own;
      if (links[i].part == kFramePart) continue;
      const Point3<double> axis = difference(capsule.axis.to, capsule.axis.from);
      lengths[i] = std::max(lengths[i], std::sqrt(dot(axis, axis)));
    }
  }
  void add(const Extents& other) {
    if (!other.box) return;
    box = box ? joined(*box, {other.box->lower, other.box->upper}) : *other.box;
    lengths.resize(other.lengths.size());
    for (std::size_t i = 0; i < lengths.size(); ++i) lengths[i] = std::max(lengths[i], other.lengths[i]);
  }
};

}  // namespace

std::optional<InstallationSpace> installation_space(const Mechanism& mechanism, std::span<const double> parameters,
                                                    const std::string& mode, std::span<const Pose<double>> poses) {
  std::vector<Extents> by_worker(workers());
  std::atomic<bool> assemble = true;
  parallel_for(poses.size(), [&](std::size_t begin, std::size_t end, std::size_t worker) {
    for (std::size_t k = begin; k < end && assemble; ++k) {
      check_stop();
      const std::vector<PlacedLink> links = mechanism.links()->place(parameters, poses[k], mode);
      if (links.empty()) assemble = false;
      by_worker[worker].add(links);
    }
  });
  if (!assemble) return {};
  Extents all;
  for (const Extents& own : by_worker) all.add(own);
  if (!all.box) return {};
  return InstallationSpace{*all.box, std::accumulate(all.lengths.begin(), all.lengths.end(), 0.0)};
}

}  // namespace pkm
