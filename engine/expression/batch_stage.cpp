#include "engine/expression/batch_stage.hpp"

#include <algorithm>
#include <cmath>

#include "engine/expression/implicit_system.hpp"
#include "engine/expression/reverse_mode.hpp"

namespace pkm::expression {

BatchStage::BatchStage(const Program& program, std::size_t stage, std::span<const std::uint32_t> retained)
    : operands_(program.registers()) {
  for (std::uint32_t i = 0; i < operands_.size(); ++i) operands_[i] = {.index = i};
  const Program::Stage& of = program.stages()[stage];
  // last[r]: index of the last step that reads register r; never_freed if the row of r must not be reused
  const std::size_t never_freed = of.steps.size();
  std::vector<std::size_t> last(program.registers());
  for (std::size_t k = 0; k < of.steps.size(); ++k)
    for (const std::uint32_t operand : of.steps[k].operands()) last[operand] = k;
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
                   .derivatives = std::get<Rule<Dual4>>(step.operation->rules),
                   .count = step.count,
                   .to = 0,
                   .from = {}};
    for (std::size_t i = 0; i < kMaxArguments; ++i)
      if (i < step.count) made.from[i] = operands_[step.from[i]];
    const auto from = step.operands();
    BatchSolve solve;
    for (const std::uint32_t operand : from) solve.from.push_back(operands_[operand]);
    for (auto operand = from.begin(); operand != from.end(); ++operand) {
      const bool repeated = std::find(from.begin(), operand, *operand) != operand;
      if (operands_[*operand].row && !repeated && last[*operand] == k) free.push_back(operands_[*operand].index);
    }
    made.to = allocate(step.to);
    if (step.solve) {
      solve.system = step.solve->system;
      for (std::uint32_t i = 0; i < step.results(); ++i) solve.to.push_back(i == 0 ? made.to : allocate(step.to + i));
      made.solve = systems_.emplace_back(std::make_shared<const BatchSolve>(std::move(solve))).get();
    }
    steps_.push_back(made);
  }
}

void solve_batch(const BatchSolve& step, const double* registers, double* rows, std::size_t count) {
  std::vector<double> operands(step.from.size()), results(step.to.size()), scratch(step.system->scratch_size());
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t i = 0; i < operands.size(); ++i)
      operands[i] = step.from[i].row ? rows[step.from[i].index * kRow + k] : registers[step.from[i].index];
    step.system->solve(operands, results, scratch);
    for (std::size_t i = 0; i < results.size(); ++i) rows[step.to[i] * kRow + k] = results[i];
  }
}

void sweep_other(const BatchStep& step, const double* registers, const double* rows, std::size_t count,
                 const BatchAdjoints& adjoints) {
  for (std::size_t k = 0; k < count; ++k) {
    const double adjoint = adjoints.rows[step.to * kRow + k];
    if (adjoint == 0) continue;
    double arguments[kMaxArguments];
    for (std::size_t i = 0; i < step.count; ++i) {
      const Operand& from = step.from[i];
      arguments[i] = from.row ? rows[from.index * kRow + k] : registers[from.index];
    }
    const auto partial = partial_derivatives(step.derivatives, arguments, step.count);
    for (std::size_t i = 0; i < step.count; ++i) {
      const Operand& from = step.from[i];
      if (const double contribution = adjoint * partial[i]; std::isfinite(contribution))
        (from.row ? adjoints.rows[from.index * kRow + k] : adjoints.registers[from.index]) += contribution;
    }
  }
}

void BatchStage::run(const double* registers, double* rows, std::size_t count) const {
  with_instruction_set([&]<InstructionSet set> { run_batch<set>(steps_, registers, rows, count); });
}

void BatchStage::backward_sweep(const double* registers, const double* rows, std::size_t count,
                                const BatchAdjoints& adjoints) const {
  with_instruction_set([&]<InstructionSet set> { sweep_batch<set>(steps_, registers, rows, count, adjoints); });
}

}  // namespace pkm::expression
