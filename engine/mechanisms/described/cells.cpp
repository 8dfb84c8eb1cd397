#include "engine/mechanisms/described/cells.hpp"

#include <algorithm>

#include "engine/math/lanes.hpp"

namespace pkm::described {
namespace {

using graph::kRow, graph::RowStage;

constexpr std::size_t kOuter = 1, kMiddle = 2, kInner = 3;  // stages; 0: the design and what is held

std::vector<Node> conditions_of(const Model& model) {
  std::vector<Node> nodes;
  for (const auto* const list : {&model.domains, &model.margins})
    for (const Result& result : *list) nodes.push_back(result.node);
  nodes.insert(nodes.end(), model.defined.begin(), model.defined.end());
  return nodes;
}

/// Centres of cells [first, first + count), and of some beyond, up to whole lanes.
std::size_t fill_centres(const VoxelGrid& grid, std::size_t axis, std::size_t first, std::size_t count, double* to) {
  const std::size_t whole = (count + kLanes - 1) / kLanes * kLanes;
  for (std::size_t k = 0; k < whole; ++k) to[k] = grid.centre(axis, static_cast<std::int64_t>(first + k));
  return whole;
}

}  // namespace

CellTest::CellTest(const Evaluation& evaluation, const std::vector<int>& swept) : swept_(swept.size()) {
  const Model& model = evaluation.model;
  std::array<Groups, 4> groups{~Groups{0}, 0, 0, 0};
  for (std::size_t i = 0; i < swept_; ++i) {
    const auto coordinate = static_cast<std::size_t>(swept[i]);
    const std::size_t stage = kInner + 1 + i - swept_;
    groups[stage] = Inputs::coordinate_group(coordinate);
    groups[0] &= ~groups[stage];
    inputs_[stage - 1] = model.inputs.coordinate(coordinate);
  }
  program_ = graph::Program(model.graph, conditions_of(model), groups);
  for (const std::uint32_t condition : program_.outputs()) {
    const int stage = program_.stage_of()[condition];
    (stage == kInner ? inner_conditions_ : stage == kMiddle ? middle_conditions_ : early_).push_back(condition);
  }
  for (const auto& step : program_.stages()[kInner].steps)
    for (std::size_t i = 0; i < step.count; ++i)
      if (program_.stage_of()[step.from[i]] == kMiddle) handed_down_.push_back(step.from[i]);
  std::ranges::sort(handed_down_);
  handed_down_.erase(std::unique(handed_down_.begin(), handed_down_.end()), handed_down_.end());
  std::vector<std::uint32_t> kept = middle_conditions_;
  kept.insert(kept.end(), handed_down_.begin(), handed_down_.end());
  middle_.emplace(program_, kMiddle, kept);
  inner_.emplace(program_, kInner, inner_conditions_);
}

void CellTest::start(const std::vector<double>& inputs, CellRoom& room) const {
  room.registers.resize(program_.registers());
  room.middle_rows.resize(middle_->slots() * kRow);
  room.rows.resize(inner_->slots() * kRow);
  program_.start<double>(room.registers);
  program_.run<double>(0, inputs, room.registers);
}

void CellTest::test(const VoxelGrid& grid, std::size_t slice, CellRoom& room) const {
  const auto [middle, inner] = shape(grid);
  room.feasible.assign(middle * inner, 0);
  if (swept_ == 3)
    for (const auto& input : program_.stages()[kOuter].inputs)
      room.registers[input.to] = grid.centre(0, static_cast<std::int64_t>(slice));
  program_.run<double>(kOuter, room.registers);
  if (!std::ranges::all_of(early_, [&](std::uint32_t at) { return room.registers[at] >= 0; })) return;
  for (std::size_t first = 0; first < middle; first += kRow)
    test_columns(grid, first, std::min(kRow, middle - first), room);
}

void CellTest::test_columns(const VoxelGrid& grid, std::size_t first, std::size_t count, CellRoom& room) const {
  std::size_t whole = kLanes;
  for (const std::uint32_t slot : middle_->inputs())
    whole = fill_centres(grid, swept_ - 2, first, count, &room.middle_rows[slot * kRow]);
  middle_->run(room.registers.data(), room.middle_rows.data(), whole);
  const auto row_of = [&](std::uint32_t program_register) {
    return &room.middle_rows[middle_->operand(program_register).index * kRow];
  };
  for (std::size_t j = 0; j < count; ++j) {
    if (!std::ranges::all_of(middle_conditions_, [&](std::uint32_t at) { return row_of(at)[j] >= 0; })) continue;
    for (const std::uint32_t at : handed_down_) room.registers[at] = row_of(at)[j];
    test_column(grid, first + j, room);
  }
}

void CellTest::test_column(const VoxelGrid& grid, std::size_t column, CellRoom& room) const {
  const std::size_t cells = shape(grid)[1];
  for (std::size_t first = 0; first < cells; first += kRow) {
    const std::size_t count = std::min(kRow, cells - first);
    std::uint8_t* const feasible = &room.feasible[column * cells + first];
    std::size_t whole = kLanes;
    for (const std::uint32_t slot : inner_->inputs())
      whole = fill_centres(grid, swept_ - 1, first, count, &room.rows[slot * kRow]);
    inner_->run(room.registers.data(), room.rows.data(), whole);
    std::fill_n(feasible, count, std::uint8_t{1});
    for (const std::uint32_t condition : inner_conditions_) {
      const double* const row = &room.rows[inner_->operand(condition).index * kRow];
      for (std::size_t k = 0; k < count; ++k) feasible[k] &= static_cast<std::uint8_t>(row[k] >= 0);
    }
  }
}

}  // namespace pkm::described
