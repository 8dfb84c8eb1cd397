// A quantity of the joints' inertia that is smooth, unlike coupling indices and condition numbers.
#pragma once

#include <cmath>

#include "engine/mechanism/pose_quantity.hpp"

namespace pkm::test {

/// What each joint feels while the others are free to stay.
inline constexpr PoseQuantity kOwnInertia = {
    .name = "own_inertia",
    .unit = "kg",
    .meaning = "inertia of a joint",
    .least = -INFINITY,
    .greatest = INFINITY,
    .worst = PoseQuantity::Worst::greatest,
    .without_value = 0,
    .per_joint = true,
    .of_inertia =
        [](const auto& M_q, auto* inertia) {
          for (std::size_t i = 0; i < M_q.rows(); ++i) inertia[i] = M_q(i, i);
        },
};

}  // namespace pkm::test
