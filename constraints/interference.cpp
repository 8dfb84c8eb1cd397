// The two bars of a parallelogram stay clear of each other (4PPa-2PaR: eq 17). The thresholds follow from the bars'
// radii and spacing, so they move with the design when those vary.
#include "constraints/list.hpp"
#include "constraints/pose_level.hpp"

namespace pkm {

ConstraintEntry interference() {
  return {
      .name = "interference",
      .meaning = "links of one limb stay clear of each other; thresholds from the links' sizes",
      .refusal = refuse_without_limits("interference"),
      .limits =
          [](const MechanismInfo& mechanism, const Options&) {
            LimitSpec spec = no_limits(mechanism);
            for (const std::size_t i : limits_of(mechanism, "interference"))
              spec.derived[i] = !mechanism.limits[i].derivation.empty();
            return spec;
          },
  };
}

}  // namespace pkm
