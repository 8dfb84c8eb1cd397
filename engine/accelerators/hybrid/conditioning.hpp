// Hybrid robot: inverse condition numbers of poses, kLanes side by side.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "engine/core/instruction_set.hpp"
#include "engine/math/lanes.hpp"

namespace pkm::hybrid {

/// Poses at some heights and beta; x and y do not count.
struct PoseList {
  std::vector<double> z, sine, cosine;  ///< [m], of beta

  void clear() {
    for (auto* list : {&z, &sine, &cosine}) list->clear();
  }
  std::size_t size() const { return z.size(); }
};

/// What conditioning depends on in a design. Nothing but numbers, as in cells.hpp.
struct ConditioningDesign {
  double L1, L2, L3, d, e;      ///< as in Geometry [m]
  std::array<double, 3> signs;  ///< of n1, n2, n3
  double roundoff;              ///< relative: a limb nearer than this to being across its rail is singular
  double length;                ///< characteristic [m]
};

/// Inverse condition numbers of whole lanes of poses, `count` of them; 0 for poses that do not assemble or are serially
/// singular.
template <InstructionSet set>
void inverse_conditions(const ConditioningDesign& design, const double* z, const double* sine, const double* cosine,
                        std::size_t count, double* result);

}  // namespace pkm::hybrid
