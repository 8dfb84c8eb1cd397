// Dynamic coupling index of joint i: DCI_i = 1 - exp(-sum over k != i of |M_q(i,k)| / |M_q(i,i)|). It is 0 if an
// acceleration of the other joints needs no force at this one. An empty workspace counts as 1, the worst value.
#include "engine/dynamics/coupling.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm {

constinit const PoseQuantity kCouplingIndex = {
    .name = "dci",
    .unit = "1",
    .meaning = "dynamic coupling index",
    .lower = 0,
    .upper = 1,
    .worst = PoseQuantity::Worst::maximum,
    .value_if_undefined = 1,
    .per_joint = true,
    .results = {{{"mean", "mean coupling index over poses and joints"},
                 {"worst", "mean over the poses of their largest coupling index"}}},
    .from_inertia = [](const auto& M_q, auto* indices) { std::ranges::copy(coupling_indices(M_q), indices); },
};

}  // namespace pkm
