#include "engine/generic/rod_loads.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/catalogue.hpp"
#include "engine/generic/evaluation.hpp"
#include "engine/generic/mechanism.hpp"

namespace pkm::generic {
namespace {

using Vec = Vector<double, 3>;

/// Component of a joint's force along the unit vector u; std::nullopt if the equilibrium equations do not determine it.
std::optional<double> along(const Vec& u, const std::array<std::optional<double>, 3>& force) {
  // Components of u that are smaller count as 0, so that undetermined force components normal to u have no effect.
  constexpr double kNormal = 1e-9;
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (std::fabs(u[k]) < kNormal) continue;
    if (!force[k]) return {};
    sum += u[k] * *force[k];
  }
  return sum;
}

/// The rods of a model, and the nodes of the numbers that their loads depend on.
struct Rods {
  // Number of values for each rod: three coordinates of each end, E I, and the area.
  static constexpr std::size_t kNumbers = 8;
  std::vector<std::size_t> solids;
  std::vector<Node> nodes;

  explicit Rods(const JointedBodies& bodies) {
    for (std::size_t i = 0; i < bodies.solids.size(); ++i) {
      const auto& beam = bodies.solids[i].beam;
      if (!beam || !beam->is_rod) continue;
      solids.push_back(i);
      nodes.insert(nodes.end(), beam->near.begin(), beam->near.end());
      nodes.insert(nodes.end(), beam->far.begin(), beam->far.end());
      nodes.insert(nodes.end(), {beam->EI, beam->area});
    }
  }
};

}  // namespace

std::vector<RodLoad> rod_loads(const Mechanism& mechanism, std::span<const double> parameters, const std::string& mode,
                               const Pose<double>& pose, const Reactions& reactions) {
  std::vector<RodLoad> loads;
  const Evaluation* const e = evaluation_of(mechanism);
  if (!e || !e->model.jointed) return loads;
  const JointedBodies& bodies = *e->model.jointed;
  const Rods rods(bodies);
  if (rods.solids.empty()) return loads;
  std::vector<double> inputs = e->inputs(parameters, no_limits(e->model.info), mode_index(e->model.info, mode));
  std::ranges::copy(pose, inputs.begin() + static_cast<std::ptrdiff_t>(e->model.inputs.coordinate(0)));
  const std::vector<double> values = outputs_of(expression::Program(e->model.graph, rods.nodes), inputs);
  for (std::size_t i = 0; i < rods.solids.size(); ++i) {
    const double* const at = &values[i * Rods::kNumbers];
    const Vec v{{at[3] - at[0], at[4] - at[1], at[5] - at[2]}};
    const double square = dot(v, v);
    const Vec u = v * (1 / std::sqrt(square));
    RodLoad load{
        .name = bodies.solids[rods.solids[i]].name, .area = at[7], .buckling_force = kPi * kPi * at[6] / square};
    std::array<std::optional<double>, 2> ends;
    bool are_known = true;
    for (std::size_t j = 0; j < bodies.joints.size(); ++j) {
      const JointNodes& joint = bodies.joints[j];
      if (joint.on != rods.solids[i] && joint.from != rods.solids[i]) continue;
      const bool is_far = j != bodies.solids[rods.solids[i]].beam->near_joint, is_on_rod = joint.on == rods.solids[i];
      const JointReaction* const reaction = find_named(reactions.joints, joint.name);
      are_known = are_known && reaction;
      if (!reaction) continue;
      if (const auto force = along(u, reaction->force)) ends[is_far] = is_far == is_on_rod ? *force : -*force;
    }
    if (!are_known) continue;
    if (ends[0] && ends[1]) load.ends = {*ends[0], *ends[1]};
    loads.push_back(load);
  }
  return loads;
}

std::vector<PeakRodLoad> peak_rod_loads(const Mechanism& mechanism, std::span<const double> parameters,
                                        const std::string& mode, const Trajectory& trajectory) {
  std::vector<PeakRodLoad> peaks;
  for (std::size_t k = 0; k < trajectory.points.size(); ++k) {
    const TrajectoryPoint& point = trajectory.points[k];
    const std::vector<RodLoad> loads = rod_loads(mechanism, parameters, mode, point.motion.pose, *point.reactions);
    if (k == 0)
      for (const RodLoad& load : loads) peaks.push_back({.name = load.name, .buckling_force = load.buckling_force});
    for (std::size_t i = 0; i < loads.size(); ++i) {
      PeakRodLoad& peak = peaks[i];
      if (!loads[i].ends) {
        peak.is_determined = false;
        continue;
      }
      for (const double force : *loads[i].ends) peak.tension = std::max(peak.tension, force);
      peak.compression = std::max(peak.compression, loads[i].compression());
      peak.stress = std::max(peak.stress, std::fabs(loads[i].axial()) / loads[i].area);
      const std::optional<double> reserve = loads[i].reserve();
      if (!reserve || (peak.reserve && *reserve >= *peak.reserve)) continue;
      peak.reserve = reserve;
      peak.critical = k;
    }
  }
  return peaks;
}

}  // namespace pkm::generic
