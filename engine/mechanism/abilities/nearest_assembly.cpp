#include "engine/mechanism/abilities/nearest_assembly.hpp"

#include <algorithm>

#include "engine/math/scalar.hpp"

namespace pkm {

std::optional<AssemblyMode> nearest_assembly(const Mechanism& mechanism, std::span<const double> parameters,
                                             const AxisVector<double>& joints, const Pose<double>& from) {
  const ForwardKinematics* const forward = mechanism.forward();
  if (!forward) return {};
  const auto& coordinates = mechanism.info().coordinates;
  const auto distance = [&](const AssemblyMode& mode) {
    double square = 0;
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      const double difference = mode.pose[i] - from[i];
      const double step = coordinates[i].turns() ? wrapped(difference) : difference;
      square += step * step;
    }
    return square;
  };
  const std::vector<AssemblyMode> modes = forward->assemblies_near(parameters, joints, from);
  const auto nearest = std::ranges::min_element(modes, {}, distance);
  return nearest == modes.end() ? std::nullopt : std::optional(*nearest);
}

}  // namespace pkm
