#include "constraints/all.hpp"

#include "constraints/list.hpp"

namespace pkm {

const std::vector<ConstraintEntry>& all_constraints() {
  static const std::vector<ConstraintEntry> list = {
      interference(),   singularity_margin(), clearance(), workspace_shape(),       rail_length(),
      task_workspace(), motion_constraint(),  linear(),    expression_constraint(),
  };
  return list;
}

}  // namespace pkm
