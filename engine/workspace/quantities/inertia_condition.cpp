// Inverse condition number of the joint-space inertia M_q: 1 where every joint feels the same mass and none couples.
// All entries of M_q are in kg, so it is free of units.
#include "engine/dynamics/coupling.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm {

constinit const PoseQuantity kInertiaCondition = {
    .name = "inertia_condition",
    .unit = "1",
    .meaning = "inverse condition number of the joint-space inertia",
    .least = 0,
    .greatest = 1,
    .worst = PoseQuantity::Worst::least,
    .without_value = 0,
    .of_inertia = [](const auto& M_q, auto* value) { *value = inertia_condition(M_q); },
};

}  // namespace pkm
