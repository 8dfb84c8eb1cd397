#include "engine/mechanism/reactions_along.hpp"

#include <algorithm>
#include <cmath>

namespace pkm {
namespace {

// Relative differences between loads up to this are rounding errors. Forces [N] and couples [N m] are compared with
// each other as if the lever arm were 1 m.
constexpr double kRounding = 1e-12;

/// Computes peak and RMS of the force or the couple in the joint with index `joint`.
/// @param kind  &JointReaction::force or &JointReaction::couple
LoadSummary load_of(const Trajectory& trajectory, std::size_t joint,
                    std::array<std::optional<double>, 3> JointReaction::*kind) {
  const auto at = [&](const TrajectoryPoint& p) -> const auto& { return p.reactions->joints[joint].*kind; };
  LoadSummary load;
  for (const TrajectoryPoint& p : trajectory.points)
    for (std::size_t k = 0; k < 3; ++k) load.determined[k] = load.determined[k] && at(p)[k];
  std::vector<double> sizes;
  for (const TrajectoryPoint& p : trajectory.points) {
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k)
      if (load.determined[k]) square += std::pow(*at(p)[k], 2);
    sizes.push_back(std::sqrt(square));
    load.rms += square / static_cast<double>(trajectory.points.size());
  }
  load.rms = std::sqrt(load.rms);
  load.peak = std::ranges::max(sizes);
  const auto is_peak = [&load](double size) { return size >= load.peak * (1 - kRounding); };
  load.at = static_cast<std::size_t>(std::ranges::find_if(sizes, is_peak) - sizes.begin());
  return load;
}

/// Sets a load to zero if it is a rounding error compared with the other one: the couple of a joint that transmits
/// forces only, or the force of a joint that transmits couples only.
void clear_rounding(LoadSummary& load, const LoadSummary& other) {
  if (load.peak < kRounding * other.peak) load.peak = load.rms = 0;
}

}  // namespace

void add_reactions(const Mechanism& mechanism, std::span<const double> parameters, const std::string& mode,
                   const Wrench<double>& wrench, Trajectory& trajectory) {
  for (TrajectoryPoint& p : trajectory.points) {
    p.reactions.emplace();
    if (p.joints)
      p.reactions = mechanism.reactions()->find(parameters, mode, {p.motion.pose, p.motion.velocity},
                                                p.motion.acceleration, wrench);
    else
      p.reactions->reason = p.reason;
  }
}

std::vector<ReactionLoads> reaction_loads(const Trajectory& trajectory) {
  std::vector<ReactionLoads> loads;
  const std::vector<JointReaction>& first = trajectory.points.front().reactions->joints;
  for (std::size_t joint = 0; joint < first.size(); ++joint) {
    LoadSummary force = load_of(trajectory, joint, &JointReaction::force),
                couple = load_of(trajectory, joint, &JointReaction::couple);
    clear_rounding(couple, force);
    clear_rounding(force, couple);
    loads.push_back({first[joint].name, first[joint].on, force, couple});
  }
  return loads;
}

}  // namespace pkm
