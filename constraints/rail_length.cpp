// The rails are long enough for the links (4PPa-2PaR: eq 18).
#include "constraints/design_test.hpp"
#include "constraints/list.hpp"

namespace pkm {

ConstraintEntry rail_length() {
  return {
      .name = "rail-length",
      .meaning = "the rails are long enough for the links",
      .pose_level = false,
      .options = [](const MechanismInfo&) { return std::vector<OptionSpec>(); },
      .unit = [](const EntryContext& context) { return design_test_unit(context, "rail-length"); },
      .refusal = [](const Mechanism& mechanism) { return refuse_without_test(mechanism, "rail-length"); },
      .limits = nullptr,
      .make = [](const EntryContext& context) { return make_design_test(context, "rail-length"); },
  };
}

}  // namespace pkm
