// Settings of reproduction (population, selection, crossover, mutation), and the study options that define them.
#pragma once

#include <string>
#include <vector>

#include "engine/core/options.hpp"
#include "engine/core/parameter.hpp"
#include "engine/optimisers/evolutionary/operators.hpp"
#include "engine/optimisers/sampling.hpp"

namespace pkm {

struct BreedingPlan {
  std::size_t population = 20;
  Start sampling = Start::sobol;  ///< sampling method of the initial population
  Selection selection;
  Crossover crossover;
  double crossover_probability = 0.85;
  Mutation mutation;
  double mutation_probability = 0.05;  ///< probability of each variable of a child to be mutated
  bool unique = true;                  ///< true: a child that equals an evaluated design is changed until it is new
};

/// Specifications of the options that `breeding_plan` reads, for the catalogue entries of population-based optimisers.
std::vector<OptionSpec> breeding_options();
BreedingPlan breeding_plan(Options options, const DesignSpace& space);

/// Sets the options `population` and `mutation_probability` if they are unset: their default values depend on the
/// number of variables.
void resolve_breeding(Options& options, const DesignSpace& space);

}  // namespace pkm
