#include "engine/generic/pose_batch.hpp"

#include "engine/math/lanes.hpp"

namespace pkm::generic {

using expression::kRow;

PoseBatch::PoseBatch(const Model& model, std::vector<Node> outputs, const std::vector<int>& swept, std::size_t mode) {
  std::vector<std::optional<double>> signs(model.inputs.sign(0));
  for (const double sign : model.signs[mode]) signs.emplace_back(sign);
  const expression::Graph graph = substitute_numbers(model.graph, signs, outputs);
  Groups swept_groups = 0;
  for (const int coordinate : swept) swept_groups |= Inputs::coordinate_group(static_cast<std::size_t>(coordinate));
  program_ = expression::Program(graph, outputs, std::array{~swept_groups, swept_groups});
  stage_.emplace(program_, 1, program_.outputs());
  const auto& inputs = program_.stages()[1].inputs;
  for (std::size_t i = 0; i < inputs.size(); ++i)
    coordinates_.push_back({inputs[i].position - model.inputs.coordinate(0), stage_->inputs()[i]});
}

void PoseBatch::start(const std::vector<double>& inputs, PoseBatchScratch& scratch) const {
  scratch.registers.resize(program_.registers());
  scratch.rows.resize(stage_->slots() * kRow);
  scratch.count = 0;
  program_.start<double>(scratch.registers);
  program_.run<double>(0, inputs, scratch.registers);
}

bool PoseBatch::add(const Pose<double>& pose, PoseBatchScratch& scratch) const {
  for (const Coordinate& each : coordinates_) scratch.rows[each.slot * kRow + scratch.count] = pose[each.number];
  return ++scratch.count == kRow;
}

std::size_t PoseBatch::run(PoseBatchScratch& scratch) const {
  const std::size_t count = scratch.count, whole = (count + kLanes - 1) / kLanes * kLanes;
  for (const Coordinate& each : coordinates_)
    for (std::size_t k = count; k < whole; ++k)
      scratch.rows[each.slot * kRow + k] = scratch.rows[each.slot * kRow + count - 1];
  stage_->run(scratch.registers.data(), scratch.rows.data(), whole);
  return whole;
}

}  // namespace pkm::generic
