// Dynamic coupling indices: DCI_i = 1 - exp(-sum of |M_q(i,k)| / |M_q(i,i)|), k != i: 0 where a joint moves without
// forcing the others. Where no pose is feasible it counts as 1, so that an empty workspace is no good design.
#include "engine/dynamics/coupling.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm {

constinit const PoseQuantity kCouplingIndex = {
    .name = "dci",
    .unit = "1",
    .meaning = "dynamic coupling index",
    .least = 0,
    .greatest = 1,
    .worst = PoseQuantity::Worst::greatest,
    .without_value = 1,
    .per_joint = true,
    .results = {{{"mean", "mean coupling index over poses and joints"},
                 {"worst", "mean over the poses of their largest coupling index"}}},
    .of_inertia = [](const auto& M_q, auto* indices) { std::ranges::copy(coupling_indices(M_q), indices); },
};

}  // namespace pkm
