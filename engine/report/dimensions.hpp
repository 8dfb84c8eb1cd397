// Which parameters of a mechanism are lengths that can be seen in its drawing.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// A parameter that is the distance between two ends of links.
struct Dimension {
  std::size_t parameter;
  std::size_t from, to;  ///< end 2 k is where link k begins, 2 k + 1 where it ends
};

/// The dimensions of a design at a pose, in the order of the parameters, each parameter once: along a link before
/// between two links of one part before anywhere else. A distance belongs to a parameter when it equals it, grows as it
/// does and depends on no other one, so two lengths that happen to be equal are told apart. Empty where the pose does
/// not assemble.
std::vector<Dimension> dimensions_of(const Mechanism& mechanism, std::span<const double> parameters,
                                     const Pose<double>& pose, const std::string& mode);

}  // namespace pkm
