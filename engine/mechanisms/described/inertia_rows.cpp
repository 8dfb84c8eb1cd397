#include "engine/mechanisms/described/inertia_rows.hpp"

#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/math/lanes.hpp"
#include "engine/mechanisms/described/joint_inertia.hpp"
#include "engine/survey/pose_quantities.hpp"

namespace pkm::described {

using graph::kRow;

InertiaRows::InertiaRows(const Evaluation& evaluation, const std::vector<int>& swept, std::size_t mode,
                         const std::vector<double>& rotors)
    : n_(evaluation.model.inputs.coordinates), rotors_(rotors) {
  rotors_.resize(n_);
  const Model& model = evaluation.model;
  std::vector<std::optional<double>> signs(model.inputs.sign(0));
  for (const double sign : model.signs[mode]) signs.emplace_back(sign);
  std::vector<Node> outputs = model.equations->J;
  outputs.insert(outputs.end(), model.equations->M_X.begin(), model.equations->M_X.end());
  const graph::Graph graph = with_numbers(model.graph, signs, outputs);
  Groups moving = 0;
  for (const int coordinate : swept) moving |= Inputs::coordinate_group(static_cast<std::size_t>(coordinate));
  program_ = graph::Program(graph, outputs, std::array{~moving, moving});
  stage_.emplace(program_, 1, program_.outputs());
  const auto& inputs = program_.stages()[1].inputs;
  for (std::size_t i = 0; i < inputs.size(); ++i)
    coordinates_.push_back({inputs[i].position - model.inputs.coordinate(0), stage_->inputs()[i]});
  for (std::size_t i = 0; i < outputs.size(); ++i)
    (i < n_ * n_ ? J_ : M_X_).push_back(stage_->operand(program_.outputs()[i]));
}

void InertiaRows::start(const std::vector<double>& inputs, InertiaRoom& room) const {
  room.registers.resize(program_.registers());
  room.rows.resize(stage_->slots() * kRow);
  room.M_q.resize(n_ * n_ * kRow);
  room.indices.resize(n_ * kRow);
  room.found.resize(kRow);
  room.count = 0;
  program_.start<double>(room.registers);
  program_.run<double>(0, inputs, room.registers);
}

void InertiaRows::add(const Pose<double>& pose, InertiaRoom& room, Survey<double>& to) const {
  for (const Coordinate& each : coordinates_) room.rows[each.slot * kRow + room.count] = pose[each.number];
  if (++room.count == kRow) finish(room, to);
}

void InertiaRows::finish(InertiaRoom& room, Survey<double>& to) const {
  const std::size_t count = room.count, whole = (count + kLanes - 1) / kLanes * kLanes;
  if (count == 0) return;
  for (const Coordinate& each : coordinates_)  // lanes beyond the last pose are like it
    for (std::size_t k = count; k < whole; ++k)
      room.rows[each.slot * kRow + k] = room.rows[each.slot * kRow + count - 1];
  stage_->run(room.registers.data(), room.rows.data(), whole);
  const InertiaRow row{.J = J_.data(),
                       .M_X = M_X_.data(),
                       .registers = room.registers.data(),
                       .rows = room.rows.data(),
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
      add_inertia(one_by_one(k, room), to);
      continue;
    }
    for (std::size_t i = 0; indices && i < n_; ++i) indices[i].push_back(room.indices[i * kRow + k]);
    if (!others) continue;
    AxisMatrix<double> M_q(n_, n_);
    for (std::size_t i = 0; i < M_q.size(); ++i) M_q[i] = room.M_q[i * kRow + k];
    add_inertia(M_q, to, &kCouplingIndex);
  }
  room.count = 0;
}

AxisMatrix<double> InertiaRows::one_by_one(std::size_t pose, const InertiaRoom& room) const {
  const auto value = [&](const graph::Operand& of) {
    return of.row ? room.rows[of.index * kRow + pose] : room.registers[of.index];
  };
  PoseDynamics<double> d;
  d.J = d.M_X = AxisMatrix<double>(n_, n_);
  for (std::size_t i = 0; i < n_ * n_; ++i) {
    d.J[i] = value(J_[i]);
    d.M_X[i] = value(M_X_[i]);
  }
  AxisMatrix<double> M_q = joint_inertia(d);
  for (std::size_t i = 0; i < n_; ++i) M_q(i, i) += rotors_[i];
  return M_q;
}

}  // namespace pkm::described
