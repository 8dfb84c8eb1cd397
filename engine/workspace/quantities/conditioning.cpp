// Inverse condition number of the Jacobian, whose columns for rotations are divided by a characteristic length.
#include "engine/workspace/pose_quantities.hpp"

namespace pkm {

constinit const PoseQuantity kConditioning = {
    .name = "conditioning",
    .unit = "1",
    .meaning = "inverse condition number of the Jacobian",
    .lower = 0,
    .upper = 1,
    .worst = PoseQuantity::Worst::minimum,
    .value_if_undefined = 0,
    .results = {{{"mean", "mean inverse condition number of the Jacobian"},
                 {"min", "minimum inverse condition number of the Jacobian"}}},
    .from_report = [](const PoseReport& report, double* value) { *value = report.conditioning.value_or(std::nan("")); },
};

}  // namespace pkm
