#include "engine/generic/inertia_batch.hpp"

#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/generic/joint_inertia.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm::generic {

using expression::kRow;

namespace {

std::vector<Node> nodes_of(const EquationNodes& equations) {
  std::vector<Node> nodes = equations.J;
  nodes.insert(nodes.end(), equations.M_X.begin(), equations.M_X.end());
  return nodes;
}

}  // namespace

InertiaBatch::InertiaBatch(const Evaluation& evaluation, const std::vector<int>& swept, std::size_t mode,
                           const std::vector<double>& rotors)
    : n_(evaluation.model.inputs.coordinates),
      rotors_(rotors),
      batch_(evaluation.model, nodes_of(*evaluation.model.equations), swept, mode) {
  rotors_.resize(n_);
  for (std::size_t i = 0; i < 2 * n_ * n_; ++i) (i < n_ * n_ ? J_ : M_X_).push_back(batch_.operand(i));
}

void InertiaBatch::start(const std::vector<double>& inputs, InertiaScratch& scratch) const {
  scratch.M_q.resize(n_ * n_ * kRow);
  scratch.indices.resize(n_ * kRow);
  scratch.found.resize(kRow);
  batch_.start(inputs, scratch.poses);
}

void InertiaBatch::add(const Pose<double>& pose, InertiaScratch& scratch, WorkspaceResult<double>& to) const {
  if (batch_.add(pose, scratch.poses)) finish(scratch, to);
}

void InertiaBatch::finish(InertiaScratch& scratch, WorkspaceResult<double>& to) const {
  const std::size_t count = scratch.poses.count;
  if (count == 0) return;
  const std::size_t padded = batch_.run(scratch.poses);
  const InertiaKernelData data{.J = J_.data(),
                               .M_X = M_X_.data(),
                               .registers = scratch.poses.registers.data(),
                               .rows = scratch.poses.rows.data(),
                               .n = n_,
                               .count = padded,
                               .rotors = rotors_.data(),
                               .M_q = scratch.M_q.data(),
                               .indices = scratch.indices.data(),
                               .found = scratch.found.data()};
  with_instruction_set([&]<InstructionSet set> { find_joint_inertia<set>(data); });
  auto* const indices = to.find(kCouplingIndex);
  const bool other_fields = std::ranges::any_of(
      to.fields, [](const auto& field) { return field.first->needs_inertia() && field.first != &kCouplingIndex; });
  for (std::size_t k = 0; k < count; ++k) {
    if (scratch.found[k] == 0) {
      add_inertia(inertia_of<double>(
                      [&](std::size_t output) { return PoseBatch::value(batch_.operand(output), k, scratch.poses); }),
                  to);
      continue;
    }
    for (std::size_t i = 0; indices && i < n_; ++i) indices[i].push_back(scratch.indices[i * kRow + k]);
    if (!other_fields) continue;
    AxisMatrix<double> M_q(n_, n_);
    for (std::size_t i = 0; i < M_q.size(); ++i) M_q[i] = scratch.M_q[i * kRow + k];
    add_inertia(M_q, to, &kCouplingIndex);
  }
  scratch.poses.count = 0;
}

template <class S, class OutputOf>
AxisMatrix<S> InertiaBatch::inertia_of(const OutputOf& output) const {
  PoseDynamics<S> d;
  d.J = d.M_X = AxisMatrix<S>(n_, n_);
  for (std::size_t i = 0; i < n_ * n_; ++i) {
    d.J[i] = output(i);
    d.M_X[i] = output(n_ * n_ + i);
  }
  AxisMatrix<S> M_q = joint_inertia(d);
  for (std::size_t i = 0; i < n_; ++i) M_q(i, i) += rotors_[i];
  return M_q;
}

void InertiaBatch::start(const std::vector<Dual4>& inputs, InertiaScratch& scratch) const {
  batch_.start<Dual4>(inputs, scratch.dual_registers);
}

void InertiaBatch::add(const Pose<Dual4>& pose, InertiaScratch& scratch, WorkspaceResult<Dual4>& to) const {
  batch_.run<Dual4>(pose, scratch.dual_registers);
  add_inertia(inertia_of<Dual4>([&](std::size_t output) { return scratch.dual_registers[batch_.outputs()[output]]; }),
              to);
}

}  // namespace pkm::generic
