#include "engine/generic/report_limits.hpp"

#include <stdexcept>

namespace pkm::generic {

const PoseQuantity* first_report_limit(const Model& model, const LimitSpec& limits) {
  for (const ReportLimit& each : model.report_limits)
    if (limits.given[each.limit]) return each.quantity;
  return nullptr;
}

void refuse_report_limits(const Model& model, const LimitSpec& limits, const std::string& what) {
  if (const PoseQuantity* const found = first_report_limit(model, limits))
    throw std::invalid_argument("mechanism " + model.info.name + " has no " + what + " with a limit of " + found->name +
                                ", which is not given by a formula; set workspace.method = \"voxels\", " +
                                "or limit a [[quantity]] with a formula");
}

}  // namespace pkm::generic
