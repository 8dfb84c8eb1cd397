#include "objectives/all.hpp"

#include <algorithm>
#include <iterator>

#include "objectives/list.hpp"

namespace pkm {

const std::vector<ObjectiveEntry>& all_objectives() {
  static const std::vector<ObjectiveEntry> list = [] {
    std::vector<ObjectiveEntry> all = {workspace_volume(), workspace_ratio()};
    all.push_back(orientation_workspace());
    std::ranges::copy(largest_solid_objectives(), std::back_inserter(all));
    std::ranges::copy(pose_objectives(), std::back_inserter(all));
    all.push_back(quantity_objective());
    std::ranges::copy(peak_objectives(), std::back_inserter(all));
    all.push_back(energy());
    all.push_back(cycle_time());
    std::ranges::copy(size_objectives(), std::back_inserter(all));
    all.push_back(yield_objective());
    all.push_back(expression_objective());
    all.push_back(python_objective());
    return all;
  }();
  return list;
}

}  // namespace pkm
