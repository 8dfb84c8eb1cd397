// How parents make a child. Operators work on physical values, scaled by nothing: they are linear in the parents, so a
// variable's unit does not matter. What leaves the bounds is moved to the nearest bound by the caller: an optimum in a
// corner is then hit exactly.
#pragma once

#include <cstddef>
#include <span>

#include "engine/math/random.hpp"

namespace pkm {

struct Crossover {
  enum class Kind {
    /// child = first + F (guide - first) + F (p - q): a step towards one of the best tenth plus the difference of two
    /// random members, three times of four taken from the worse to the better; F uniform in [0.45, 1.35]; nine
    /// variables of ten take the step. After differential evolution's current-to-pbest (Zhang & Sanderson 2009).
    differential,
    sbx,       ///< simulated binary crossover (Deb & Agrawal 1995), spread index `eta`, each variable with 1/2
    blend,     ///< BLX-0.5: uniform on the parents' interval widened by half of its length to both sides
    scattered  ///< each variable from either parent: discrete recombination
  };
  Kind kind = Kind::differential;
  double eta = 15;
};

/// The designs of a population in their order of preference, best first, one after the other.
struct Pool {
  std::span<const double> designs;
  std::size_t dimension = 0;
  std::size_t size() const { return designs.size() / dimension; }
  std::span<const double> design(std::size_t i) const { return designs.subspan(i * dimension, dimension); }
};

/// Makes a child of members `first` and `second` (differential: of `first` and members it draws itself).
void cross(const Crossover& crossover, const Pool& pool, std::size_t first, std::size_t second, Stream& stream,
           std::span<double> child);

}  // namespace pkm
