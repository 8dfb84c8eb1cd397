#include "engine/graph/rows.hpp"

#include <algorithm>

namespace pkm::graph {

RowStage::RowStage(const Program& program, std::size_t stage, std::span<const std::uint32_t> kept)
    : operands_(program.registers()) {
  for (std::uint32_t i = 0; i < operands_.size(); ++i) operands_[i] = {.index = i};
  const Program::Stage& of = program.stages()[stage];
  // after which step a row is read for the last time
  const std::size_t never = of.steps.size();
  std::vector<std::size_t> last(program.registers());
  for (std::size_t k = 0; k < of.steps.size(); ++k)
    for (std::size_t i = 0; i < of.steps[k].count; ++i) last[of.steps[k].from[i]] = k;
  for (const std::uint32_t keep : kept) last[keep] = never;

  std::vector<std::uint32_t> free;
  const auto take = [&](std::uint32_t program_register) {
    if (free.empty()) free.push_back(static_cast<std::uint32_t>(slots_++));
    operands_[program_register] = {.index = free.back(), .row = true};
    free.pop_back();
    return operands_[program_register].index;
  };
  for (const Program::Input& input : of.inputs) {
    inputs_.push_back(take(input.to));
    last[input.to] = never;
  }
  for (std::size_t k = 0; k < of.steps.size(); ++k) {
    const Program::Step& step = of.steps[k];
    RowStep made{.code = step.code,
                 .rule = std::get<Rule<double>>(step.operation->rules),
                 .count = step.count,
                 .to = 0,
                 .from = {}};
    for (std::size_t i = 0; i < kMostArguments; ++i)
      if (i < step.count) made.from[i] = operands_[step.from[i]];
    for (std::size_t i = 0; i < step.count; ++i) {
      const bool again = std::find(step.from.begin(), step.from.begin() + i, step.from[i]) != step.from.begin() + i;
      if (made.from[i].row && !again && last[step.from[i]] == k) free.push_back(made.from[i].index);
    }
    made.to = take(step.to);
    steps_.push_back(made);
  }
}

void RowStage::run(const double* registers, double* rows, std::size_t count) const {
  with_instruction_set([&]<InstructionSet set> { run_rows<set>(steps_, registers, rows, count); });
}

}  // namespace pkm::graph
