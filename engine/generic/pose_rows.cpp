#include "engine/generic/pose_rows.hpp"

#include "engine/math/lanes.hpp"

namespace pkm::generic {

using expression::kRow;

PoseRows::PoseRows(const Model& model, std::vector<Node> outputs, const std::vector<int>& swept, std::size_t mode) {
  std::vector<std::optional<double>> signs(model.inputs.sign(0));
  for (const double sign : model.signs[mode]) signs.emplace_back(sign);
  const expression::Graph graph = substitute_numbers(model.graph, signs, outputs);
  Groups moving = 0;
  for (const int coordinate : swept) moving |= Inputs::coordinate_group(static_cast<std::size_t>(coordinate));
  program_ = expression::Program(graph, outputs, std::array{~moving, moving});
  stage_.emplace(program_, 1, program_.outputs());
  const auto& inputs = program_.stages()[1].inputs;
  for (std::size_t i = 0; i < inputs.size(); ++i)
    coordinates_.push_back({inputs[i].position - model.inputs.coordinate(0), stage_->inputs()[i]});
}

void PoseRows::start(const std::vector<double>& inputs, PoseRowsRoom& room) const {
  room.registers.resize(program_.registers());
  room.rows.resize(stage_->slots() * kRow);
  room.count = 0;
  program_.start<double>(room.registers);
  program_.run<double>(0, inputs, room.registers);
}

bool PoseRows::add(const Pose<double>& pose, PoseRowsRoom& room) const {
  for (const Coordinate& each : coordinates_) room.rows[each.slot * kRow + room.count] = pose[each.number];
  return ++room.count == kRow;
}

std::size_t PoseRows::run(PoseRowsRoom& room) const {
  const std::size_t count = room.count, whole = (count + kLanes - 1) / kLanes * kLanes;
  for (const Coordinate& each : coordinates_)
    for (std::size_t k = count; k < whole; ++k)
      room.rows[each.slot * kRow + k] = room.rows[each.slot * kRow + count - 1];
  stage_->run(room.registers.data(), room.rows.data(), whole);
  return whole;
}

}  // namespace pkm::generic
