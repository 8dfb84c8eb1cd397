#include "engine/expression/batch_stage.hpp"

#include <algorithm>

namespace pkm::expression {

BatchStage::BatchStage(const Program& program, std::size_t stage, std::span<const std::uint32_t> retained)
    : operands_(program.registers()) {
  for (std::uint32_t i = 0; i < operands_.size(); ++i) operands_[i] = {.index = i};
  const Program::Stage& of = program.stages()[stage];
  // last[r]: index of the last step that reads register r; never_freed if the row of r must not be reused
  const std::size_t never_freed = of.steps.size();
  std::vector<std::size_t> last(program.registers());
  for (std::size_t k = 0; k < of.steps.size(); ++k)
    for (std::size_t i = 0; i < of.steps[k].count; ++i) last[of.steps[k].from[i]] = k;
  for (const std::uint32_t keep : retained) last[keep] = never_freed;

  std::vector<std::uint32_t> free;
  const auto allocate = [&](std::uint32_t program_register) {
    if (free.empty()) free.push_back(static_cast<std::uint32_t>(slots_++));
    operands_[program_register] = {.index = free.back(), .row = true};
    free.pop_back();
    return operands_[program_register].index;
  };
  for (const Program::Input& input : of.inputs) {
    inputs_.push_back(allocate(input.to));
    last[input.to] = never_freed;
  }
  for (std::size_t k = 0; k < of.steps.size(); ++k) {
    const Program::Step& step = of.steps[k];
    BatchStep made{.code = step.code,
                   .rule = std::get<Rule<double>>(step.operation->rules),
                   .count = step.count,
                   .to = 0,
                   .from = {}};
    for (std::size_t i = 0; i < kMaxArguments; ++i)
      if (i < step.count) made.from[i] = operands_[step.from[i]];
    for (std::size_t i = 0; i < step.count; ++i) {
      const bool repeated = std::find(step.from.begin(), step.from.begin() + i, step.from[i]) != step.from.begin() + i;
      if (made.from[i].row && !repeated && last[step.from[i]] == k) free.push_back(made.from[i].index);
    }
    made.to = allocate(step.to);
    steps_.push_back(made);
  }
}

void BatchStage::run(const double* registers, double* rows, std::size_t count) const {
  with_instruction_set([&]<InstructionSet set> { run_batch<set>(steps_, registers, rows, count); });
}

}  // namespace pkm::expression
