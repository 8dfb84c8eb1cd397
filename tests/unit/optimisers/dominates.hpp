// Pareto dominance by its definition, as a reference for tests.
#pragma once

#include <cstddef>

namespace pkm {

inline bool dominates(const double* a, const double* b, std::size_t objectives) {
  bool better = false;
  for (std::size_t k = 0; k < objectives; ++k) {
    if (a[k] > b[k]) return false;
    better = better || a[k] < b[k];
  }
  return better;
}

}  // namespace pkm
