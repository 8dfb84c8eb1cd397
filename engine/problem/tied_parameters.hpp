// Parameters of single limbs that have the value of the parameter that all limbs share (ProblemParts::copies).
#pragma once

#include <vector>

#include "engine/problem/design_problem.hpp"

namespace pkm {

/// Sets each parameter of a single limb that is tied to a parameter of all limbs to the value of that parameter.
inline void apply_ties(const ProblemParts& parts, std::vector<double>& parameters) {
  for (const auto& [own, common] : parts.copies) parameters[own] = parameters[common];
}

}  // namespace pkm
