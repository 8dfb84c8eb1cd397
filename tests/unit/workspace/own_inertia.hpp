// A quantity of the joint-space inertia that is smooth, unlike coupling indices and condition numbers.
#pragma once

#include <cmath>

#include "engine/mechanism/pose_quantity.hpp"

namespace pkm::test {

/// Inertia of each joint while the others do not accelerate: the diagonal of M_q.
inline constexpr PoseQuantity kOwnInertia = {
    .name = "own_inertia",
    .unit = "kg",
    .meaning = "inertia of a joint",
    .lower = -INFINITY,
    .upper = INFINITY,
    .worst = PoseQuantity::Worst::maximum,
    .value_if_undefined = 0,
    .per_joint = true,
    .from_inertia =
        [](const auto& M_q, auto* inertia) {
          for (std::size_t i = 0; i < M_q.rows(); ++i) inertia[i] = M_q(i, i);
        },
};

}  // namespace pkm::test
