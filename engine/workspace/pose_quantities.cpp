#include "engine/workspace/pose_quantities.hpp"

namespace pkm {

const std::vector<const PoseQuantity*>& pose_quantities() {
  static const std::vector<const PoseQuantity*> list = {&kConditioning, &kCouplingIndex, &kInertiaCondition};
  return list;
}

}  // namespace pkm
