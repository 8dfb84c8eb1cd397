// How a population is varied: who becomes a parent, how parents make a child, and small and large accidents of one
// variable.
//
// Selection sees only the order of preference in a population (index 0 is the best), so it serves one objective and
// several alike. Crossover works on physical values, scaled by nothing: it is linear in the parents, so a variable's
// unit does not matter. Steps of mutation are fractions of the variable's range [lower, upper]. What leaves the bounds
// is moved to the nearest bound by the caller: an optimum in a corner is then hit exactly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/core/parameter.hpp"
#include "engine/math/random.hpp"

namespace pkm {

struct Selection {
  enum class Kind {
    tournament,     ///< the best of `tournament_size` members drawn at random
    linear_ranking  ///< fitness falls linearly with the rank; drawn by stochastic universal sampling (Baker 1987)
  };
  Kind kind = Kind::tournament;
  std::int64_t tournament_size = 2;
  double pressure = 2;  ///< linear ranking: expected share of the best relative to the average, in [1, 2]
};

/// Fills `parents` with indices in [0, population).
void select_parents(const Selection& selection, std::size_t population, Stream& stream,
                    std::span<std::uint32_t> parents);

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

struct Mutation {
  enum class Kind {
    multiscale,  ///< normal, its deviation sigma 10^(-4 u), u uniform in [0, 1): coarse and fine steps equally often
    gaussian,    ///< normal with deviation sigma
    polynomial,  ///< Deb & Goyal 1996, index `eta`
    uniform      ///< any value of the range
  };
  Kind kind = Kind::multiscale;
  double sigma = 0.3;
  double eta = 20;
};

double mutated(const Mutation& mutation, const Variable& variable, double value, Stream& stream);

}  // namespace pkm
