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

std::string_view words(StopReason reason) {
  switch (reason) {
    case StopReason::generations:
      return "generation limit";
    case StopReason::evaluations:
      return "evaluation limit";
    case StopReason::target:
      return "target reached";
    case StopReason::stall:
      return "no further improvement";
    case StopReason::tolerance:
      return "converged";
    case StopReason::exhausted:
      return "every design evaluated";
    case StopReason::interrupted:
      return "interrupted";
    case StopReason::time:
      return "time limit";
    case StopReason::failed:
      return "failed";
    case StopReason::starts:
      return "every start has ended";
  }
  return "";
}

}  // namespace pkm
