#include "engine/generic/design_checks.hpp"

#include "engine/core/unit.hpp"

namespace pkm::generic {

Unsupported refuse_design(const Evaluation& e, std::span<const double> parameters) {
  const Model& model = e.model;
  const std::vector<double> values = outputs_of(e.requirements, e.inputs(parameters, no_limits(model.info), 0));
  auto value = values.begin();
  for (const JointRange& range : model.ranges) {
    const double from = *value++, to = *value++;
    if (!(from < to))
      return "the range of joint " + range.joint + " is empty: from " + with_unit(from, range.unit) + " to " +
             with_unit(to, range.unit);
  }
  for (const Result& required : model.required) {
    const double margin = *value++;
    if (!(margin >= 0)) return required.name + " is violated: " + with_unit(margin, required.unit) + " < 0";
  }
  return {};
}

}  // namespace pkm::generic
