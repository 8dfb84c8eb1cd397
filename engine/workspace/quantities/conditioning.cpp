// Inverse condition number of the Jacobian, its angular columns divided by a characteristic length.
#include "engine/workspace/pose_quantities.hpp"

namespace pkm {

constinit const PoseQuantity kConditioning = {
    .name = "conditioning",
    .unit = "1",
    .meaning = "inverse condition number of the Jacobian",
    .least = 0,
    .greatest = 1,
    .worst = PoseQuantity::Worst::least,
    .without_value = 0,
    .results = {{{"mean", "mean inverse condition number of the Jacobian"},
                 {"min", "least inverse condition number of the Jacobian"}}},
    .of_report = [](const PoseReport& report, double* value) { *value = report.conditioning.value_or(std::nan("")); },
};

}  // namespace pkm
