// No interference between the two bars of a parallelogram (4PPa-2PaR: eq 17). The angle thresholds are derived from the
// radii and the spacing of the bars; they therefore change with the design if these parameters vary.
#include "constraints/list.hpp"
#include "constraints/pose_level.hpp"

namespace pkm {

ConstraintEntry interference() {
  return {
      .name = "interference",
      .meaning = "links of one limb do not collide; thresholds are derived from the sizes of the links",
      .refusal = check_limits("interference"),
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
