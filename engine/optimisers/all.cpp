#include "engine/optimisers/list.hpp"

namespace pkm {

const std::vector<OptimiserEntry>& all_optimisers() {
  static const std::vector<OptimiserEntry> entries = {genetic_algorithm(), nsga2(), sweep(), nlopt_stage(),
                                                      ipopt_stage()};
  return entries;
}

}  // namespace pkm
