// Genetic operators for real variables: parent selection, crossover and mutation.
//
// Selection uses only the rank in the population (index 0 is the best) and therefore serves one and several objectives.
// Crossover is linear in the parents' physical values and therefore independent of the unit of a variable. Mutation
// steps are fractions of the variable's range [lower, upper]. The caller projects the results onto the bounds, so that
// an optimum at a vertex of the design space is found exactly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/core/parameter.hpp"
#include "engine/math/random.hpp"

namespace pkm {

struct Selection {
  enum class Kind {
    tournament,     ///< the best of `tournament_size` randomly drawn members
    linear_ranking  ///< fitness decreases linearly with the rank; stochastic universal sampling (Baker 1987)
  };
  Kind kind = Kind::tournament;
  std::int64_t tournament_size = 2;
  /// Linear ranking: expected number of draws of the best member, relative to the average, in [1, 2].
  double pressure = 2;
};

/// Selects parents: fills `parents` with indices in [0, population), 0 being the best.
void select_parents(const Selection& selection, std::size_t population, Stream& stream,
                    std::span<std::uint32_t> parents);

struct Crossover {
  enum class Kind {
    /// Differential evolution, similar to current-to-pbest/1 (Zhang and Sanderson 2009):
    ///   child = first + F (guide - first) + F (p - q)
    /// `guide` is a random one of the best tenth (at least two); p and q are random members, where p is the better
    /// one with probability 7/8; F is uniform in [0.45, 1.35]. Each variable is changed with probability 0.9, but at
    /// least one, chosen at random; the other variables are copied from `first`.
    differential,
    sbx,    ///< simulated binary crossover (Deb and Agrawal 1995) with index `eta`; each variable with probability 1/2
    blend,  ///< BLX-0.5: uniform on the parents' interval, extended by half of its length on both sides
    scattered  ///< discrete recombination: each variable is copied from one of the two parents, chosen at random
  };
  Kind kind = Kind::differential;
  double eta = 15;
};

/// The designs of a population, best first, stored contiguously.
struct ParentPool {
  std::span<const double> designs;
  std::size_t dimension = 0;
  std::size_t size() const { return designs.size() / dimension; }
  std::span<const double> design(std::size_t i) const { return designs.subspan(i * dimension, dimension); }
};

/// Crossover of the members `first` and `second`; differential evolution uses `first` and randomly drawn members.
void recombine(const Crossover& crossover, const ParentPool& pool, std::size_t first, std::size_t second,
               Stream& stream, std::span<double> child);

struct Mutation {
  enum class Kind {
    multiscale,  ///< normal steps with standard deviation sigma 10^(-4 u), u uniform in [0, 1)
    gaussian,    ///< normally distributed steps with standard deviation sigma
    polynomial,  ///< polynomial mutation (Deb and Goyal 1996) with distribution index `eta`
    uniform      ///< uniformly distributed over the range of the variable
  };
  Kind kind = Kind::multiscale;
  double sigma = 0.3;
  double eta = 20;
};

/// Returns the mutated value of a variable. It may lie outside the variable's bounds; the caller projects it onto them.
double mutate(const Mutation& mutation, const Variable& variable, double value, Stream& stream);

}  // namespace pkm
