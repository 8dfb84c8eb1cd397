#include "objectives/all.hpp"

#include "objectives/list.hpp"

namespace pkm {

const std::vector<ObjectiveEntry>& all_objectives() {
  static const std::vector<ObjectiveEntry> list = {
      workspace_volume(),     workspace_ratio(),
      conditioning(),         dci(),
      dci_uniformity(),       inertia_condition_objective(),
      peak_force(),           peak_power(),
      expression_objective(),
  };
  return list;
}

}  // namespace pkm
