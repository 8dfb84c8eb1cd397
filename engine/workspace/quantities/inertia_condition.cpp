// Inverse condition number of the joint-space inertia M_q: 1 if all joints have the same inertia and are decoupled.
#include "engine/dynamics/coupling.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm {

constinit const PoseQuantity kInertiaCondition = {
    .name = "inertia_condition",
    .unit = "1",
    .meaning = "inverse condition number of the joint-space inertia",
    .lower = 0,
    .upper = 1,
    .worst = PoseQuantity::Worst::minimum,
    .value_if_undefined = 0,
    .from_inertia = [](const auto& M_q, auto* value) { *value = inertia_condition(M_q); },
};

}  // namespace pkm
