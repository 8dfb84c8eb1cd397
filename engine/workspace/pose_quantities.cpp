#include "engine/workspace/pose_quantities.hpp"

#include <stdexcept>

#include "engine/core/catalogue.hpp"

namespace pkm {

const std::vector<const PoseQuantity*>& pose_quantities() {
  static const std::vector<const PoseQuantity*> list = {&kConditioning, &kCouplingIndex, &kInertiaCondition};
  return list;
}

std::vector<const PoseQuantity*> pose_quantities(const MechanismInfo& info) {
  std::vector<const PoseQuantity*> list = pose_quantities();
  for (const QuantityInfo& quantity : info.quantities)
    if (quantity.of_pose) list.push_back(quantity.of_pose.get());
  return list;
}

const PoseQuantity& pose_quantity_called(const MechanismInfo& info, const std::string& name) {
  std::vector<std::string> known;
  for (const PoseQuantity* const quantity : pose_quantities(info)) {
    if (quantity->name == name) return *quantity;
    known.emplace_back(quantity->name);
  }
  if (const QuantityInfo* const found = find_named(info.quantities, name))
    throw std::invalid_argument("quantity '" + name + "' " +
                                (found->of_design   ? "depends on the design alone"
                                 : found->of_motion ? "depends on rates of the motion"
                                                    : "belongs to a single limb, and is listed at single poses only") +
                                "; expected a quantity of the workspace");
  for (const UndefinedQuantity& quantity : info.undefined_quantities)
    if (name == quantity.name || name.starts_with(quantity.name + "_"))
      throw std::invalid_argument("quantity '" + name + "' is undefined for mechanism " + info.name + ": " +
                                  quantity.why);
  const std::string expected = join(known);
  for (const UndefinedQuantity& quantity : info.undefined_quantities) known.push_back(quantity.name);
  throw std::invalid_argument("mechanism " + info.name + " has no quantity '" + name + "'; expected one of " +
                              expected + did_you_mean(name, known));
}

}  // namespace pkm
