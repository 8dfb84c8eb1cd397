#include "engine/workspace/installation_box.hpp"

#include <atomic>

#include "engine/core/stop.hpp"
#include "engine/core/team.hpp"

namespace pkm {
namespace {

/// Extends a box to contain a capsule.
void extend(std::optional<Bounds<double>>& box, const Capsule<double>& capsule) {
  Bounds<double> own = bounds_of(capsule.axis);
  for (std::size_t i = 0; i < 3; ++i) {
    own.lower[i] -= capsule.radius;
    own.upper[i] += capsule.radius;
  }
  box = box ? joined(*box, {own.lower, own.upper}) : own;
}

}  // namespace

std::optional<Bounds<double>> installation_box(const Mechanism& mechanism, std::span<const double> parameters,
                                               const std::string& mode, std::span<const Pose<double>> poses) {
  std::vector<std::optional<Bounds<double>>> by_worker(workers());
  std::atomic<bool> assemble = true;
  parallel_for(poses.size(), [&](std::size_t begin, std::size_t end, std::size_t worker) {
    for (std::size_t k = begin; k < end && assemble; ++k) {
      check_stop();
      const std::vector<PlacedLink> links = mechanism.links()->place(parameters, poses[k], mode);
      if (links.empty()) assemble = false;
      for (const PlacedLink& link : links) extend(by_worker[worker], link.body);
    }
  });
  std::optional<Bounds<double>> box;
  for (const auto& own : by_worker)
    if (own) box = box ? joined(*box, {own->lower, own->upper}) : own;
  return assemble ? box : std::nullopt;
}

}  // namespace pkm
