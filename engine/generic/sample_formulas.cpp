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

void SampleFormulas::add(const Pose<double>& pose, FormulaScratch& scratch, WorkspaceResult<double>& to) const {
  if (batch_.add(pose, scratch.poses)) finish(scratch, to);
}

void SampleFormulas::finish(FormulaScratch& scratch, WorkspaceResult<double>& to) const {
  const std::size_t count = scratch.poses.count;
  if (count == 0) return;
  batch_.run(scratch.poses);
  for (std::size_t i = 0; i < quantities_.size(); ++i) {
    std::vector<double>& field = *to.find(*quantities_[i]);
    const expression::Operand value = batch_.operand(i);
    for (std::size_t k = 0; k < count; ++k) field.push_back(PoseBatch::value(value, k, scratch.poses));
  }
  scratch.poses.count = 0;
}

void SampleFormulas::add(const Pose<Dual4>& pose, FormulaScratch& scratch, WorkspaceResult<Dual4>& to) const {
  batch_.run<Dual4>(pose, scratch.dual_registers);
  for (std::size_t i = 0; i < quantities_.size(); ++i)
    to.find(*quantities_[i])->push_back(scratch.dual_registers[batch_.outputs()[i]]);
}

}  // namespace pkm::generic
