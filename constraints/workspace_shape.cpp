// The workspace's shape is one that can be used (4PPa-2PaR: eq 21, upper and lower part separate).
#include "constraints/design_test.hpp"
#include "constraints/list.hpp"

namespace pkm {

ConstraintEntry workspace_shape() {
  return {
      .name = "workspace-shape",
      .meaning = "the workspace has a usable shape",
      .pose_level = false,
      .options = [](const MechanismInfo&) { return std::vector<OptionSpec>(); },
      .unit = [](const EntryContext& context) { return design_test_unit(context, "workspace-shape"); },
      .refusal = [](const Mechanism& mechanism) { return refuse_without_test(mechanism, "workspace-shape"); },
      .limits = nullptr,
      .make = [](const EntryContext& context) { return make_design_test(context, "workspace-shape"); },
  };
}

}  // namespace pkm
