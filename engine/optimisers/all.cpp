#include "engine/optimisers/evolutionary/genetic_algorithm.hpp"
#include "engine/optimisers/evolutionary/nsga2.hpp"
#include "engine/optimisers/optimiser.hpp"
#include "engine/optimisers/solvers/ipopt.hpp"
#include "engine/optimisers/solvers/nlopt.hpp"
#include "engine/optimisers/sweep.hpp"

namespace pkm {

const std::vector<OptimiserEntry>& all_optimisers() {
  static const std::vector<OptimiserEntry> entries = {genetic_algorithm(), nsga2(), sweep(), nlopt_stage(),
                                                      ipopt_stage()};
  return entries;
}

}  // namespace pkm
