// The settings of breeding, and the options from which a study sets them.
#pragma once

#include <string>
#include <vector>

#include "engine/core/options.hpp"
#include "engine/core/parameter.hpp"
#include "engine/optimisers/evolutionary/operators.hpp"
#include "engine/optimisers/start.hpp"

namespace pkm {

struct BreedingPlan {
  std::size_t population = 20;
  Start start = Start::sobol;
  Selection selection;
  Crossover crossover;
  double crossover_probability = 0.85;
  Mutation mutation;
  double mutation_probability = 0.05;  ///< of each variable of each child
  bool unique = true;                  ///< a child that is already known is changed until it is new
};

/// The options that `breeding_plan` reads: for the catalogue entries of population-based optimisers.
std::vector<OptionSpec> breeding_options();
BreedingPlan breeding_plan(Options options, const DesignSpace& space);

/// Fills in the options whose default depends on the variables: population and mutation_probability.
void resolve_breeding(Options& options, const DesignSpace& space);

}  // namespace pkm
