#include "engine/config/mechanism_mobility.hpp"

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/generic/mobility.hpp"

namespace pkm {

std::string mobility_text(const Mechanism& mechanism, std::span<const double> parameters, const Pose<double>& pose,
                          std::size_t rank, const std::string& cause) {
  constexpr std::size_t kBody = 6;  // number of degrees of freedom of a rigid body in space
  const MechanismInfo& info = mechanism.info();
  const std::size_t coordinates = info.coordinates.size();
  const std::string loose =
      rank < coordinates ? ": the platform can move while the drives are locked, or the pose is singular; " + cause
                         : "";
  const auto determined = [&](std::size_t degrees) {
    return "the drives determine " + std::to_string(rank) + " of " + std::to_string(degrees) +
           " degrees of freedom at this pose" + loose;
  };
  const auto mobility = generic::platform_mobility(mechanism, parameters, pose, info.modes.front());
  if (!mobility) {
    if (coordinates == kBody) return determined(kBody);
    return "the drives determine " +
           (loose.empty() ? "the coordinates" : std::to_string(rank) + " of the coordinates") + " at this pose" +
           loose + "; unknown whether the joints constrain the platform's other degrees of freedom: " +
           mechanism.why_no_reactions();
  }
  const generic::PlatformMobility& found = *mobility;
  const std::size_t described = found.of_coordinates.value_or(std::min(coordinates, found.of_joints));
  if (described < coordinates)
    return determined(coordinates) + ", but the joints of the file allow only " + std::to_string(described) +
           " of the coordinates' motions";
  const std::size_t assumed = found.of_joints - described;
  if (assumed == 0) return determined(coordinates);
  return determined(coordinates + assumed) + (loose.empty() ? ": " : "; ") + "the joints of the file do not prevent " +
         (!found.assumed.empty() ? join(found.assumed)
          : assumed == 1         ? "1 other motion"
                                 : std::to_string(assumed) + " other motions") +
         ", which is assumed to be impossible";
}

}  // namespace pkm
