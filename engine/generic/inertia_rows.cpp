#include "engine/generic/inertia_rows.hpp"

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

InertiaRows::InertiaRows(const Evaluation& evaluation, const std::vector<int>& swept, std::size_t mode,
                         const std::vector<double>& rotors)
    : n_(evaluation.model.inputs.coordinates),
      rotors_(rotors),
      rows_(evaluation.model, nodes_of(*evaluation.model.equations), swept, mode) {
  rotors_.resize(n_);
  for (std::size_t i = 0; i < 2 * n_ * n_; ++i) (i < n_ * n_ ? J_ : M_X_).push_back(rows_.operand(i));
}

void InertiaRows::start(const std::vector<double>& inputs, InertiaRoom& room) const {
  room.M_q.resize(n_ * n_ * kRow);
  room.indices.resize(n_ * kRow);
  room.found.resize(kRow);
  rows_.start(inputs, room.poses);
}

void InertiaRows::add(const Pose<double>& pose, InertiaRoom& room, Survey<double>& to) const {
  if (rows_.add(pose, room.poses)) finish(room, to);
}

void InertiaRows::finish(InertiaRoom& room, Survey<double>& to) const {
  const std::size_t count = room.poses.count;
  if (count == 0) return;
  const std::size_t whole = rows_.run(room.poses);
  const InertiaRow row{.J = J_.data(),
                       .M_X = M_X_.data(),
                       .registers = room.poses.registers.data(),
                       .rows = room.poses.rows.data(),
                       .n = n_,
                       .count = whole,
                       .rotors = rotors_.data(),
                       .M_q = room.M_q.data(),
                       .indices = room.indices.data(),
                       .found = room.found.data()};
  with_instruction_set([&]<InstructionSet set> { find_joint_inertia<set>(row); });
  auto* const indices = to.find(kCouplingIndex);
  const bool others = std::ranges::any_of(
      to.fields, [](const auto& field) { return field.first->needs_inertia() && field.first != &kCouplingIndex; });
  for (std::size_t k = 0; k < count; ++k) {
    if (room.found[k] == 0) {
      add_inertia(
          one_by_one<double>([&](std::size_t output) { return PoseRows::value(rows_.operand(output), k, room.poses); }),
          to);
      continue;
    }
    for (std::size_t i = 0; indices && i < n_; ++i) indices[i].push_back(room.indices[i * kRow + k]);
    if (!others) continue;
    AxisMatrix<double> M_q(n_, n_);
    for (std::size_t i = 0; i < M_q.size(); ++i) M_q[i] = room.M_q[i * kRow + k];
    add_inertia(M_q, to, &kCouplingIndex);
  }
  room.poses.count = 0;
}

template <class S, class OutputOf>
AxisMatrix<S> InertiaRows::one_by_one(const OutputOf& output) const {
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

void InertiaRows::start(const std::vector<Dual4>& inputs, InertiaRoom& room) const {
  rows_.start<Dual4>(inputs, room.moving);
}

void InertiaRows::add(const Pose<Dual4>& pose, InertiaRoom& room, Survey<Dual4>& to) const {
  rows_.run<Dual4>(pose, room.moving);
  add_inertia(one_by_one<Dual4>([&](std::size_t output) { return room.moving[rows_.outputs()[output]]; }), to);
}

}  // namespace pkm::generic
