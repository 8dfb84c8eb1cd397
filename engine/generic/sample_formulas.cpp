#include "engine/generic/sample_formulas.hpp"

namespace pkm::generic {
namespace {

std::vector<const PoseQuantity*> formulas_of(const std::vector<const PoseQuantity*>& fields) {
  std::vector<const PoseQuantity*> found;
  for (const PoseQuantity* const quantity : fields)
    if (quantity->formula) found.push_back(quantity);
  return found;
}

std::vector<Node> nodes_of(const Model& model, const std::vector<const PoseQuantity*>& quantities) {
  std::vector<Node> nodes;
  for (const PoseQuantity* const quantity : quantities) nodes.push_back(model.quantities[*quantity->formula]);
  return nodes;
}

}  // namespace

SampleFormulas::SampleFormulas(const Evaluation& evaluation, const std::vector<const PoseQuantity*>& fields,
                               const std::vector<int>& swept, std::size_t mode)
    : quantities_(formulas_of(fields)),
      batch_(evaluation.model, nodes_of(evaluation.model, quantities_), swept, mode) {}

}  // namespace pkm::generic
