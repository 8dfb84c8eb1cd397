// Parameters of single limbs that have the value of the common parameter (ProblemParts::copies).
#pragma once

#include <vector>

#include "engine/problem/design_problem.hpp"

namespace pkm {

/// Sets the parameters of single limbs that are tied to a common parameter to its value.
inline void apply_ties(const ProblemParts& parts, std::vector<double>& parameters) {
  for (const auto& [own, common] : parts.copies) parameters[own] = parameters[common];
}

}  // namespace pkm
