#include "objectives/all.hpp"

#include <algorithm>
#include <iterator>

#include "objectives/list.hpp"

namespace pkm {

const std::vector<ObjectiveEntry>& all_objectives() {
  static const std::vector<ObjectiveEntry> list = [] {
    std::vector<ObjectiveEntry> all = {workspace_volume(), workspace_ratio()};
    for (auto& family : {pose_objectives(), peak_objectives()}) std::ranges::copy(family, std::back_inserter(all));
    all.push_back(expression_objective());
    return all;
  }();
  return list;
}

}  // namespace pkm
