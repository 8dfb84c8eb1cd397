// Definition of a satisfied constraint, common to poses, voxels, columns, motions and certified bounds.
#pragma once

#include <limits>

namespace pkm {

/// A constraint f >= 0 is satisfied where f is a finite number >= 0. Where f is undefined or infinite, it is violated.
inline bool is_satisfied(double f) { return f >= 0 && f <= std::numeric_limits<double>::max(); }

}  // namespace pkm
