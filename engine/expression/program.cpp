#include "engine/expression/program.hpp"

#include <algorithm>
#include <cmath>

#include "engine/expression/changed_steps.hpp"
#include "engine/expression/implicit_system.hpp"
#include "engine/expression/interval_steps.hpp"

namespace pkm::expression {

Program::Program(const Graph& graph, std::span<const Node> outputs, std::span<const Groups> stages)
    : stages_(std::max<std::size_t>(stages.size(), 1)) {
  std::vector<std::uint32_t> registers(graph.size());  // of every node that has one
  const auto register_of = [&registers](Node node) -> std::uint32_t& {
    return registers[static_cast<std::size_t>(node)];
  };
  std::uint32_t next = 0;
  const auto stage_for = [&](Groups groups) {
    std::size_t stage = 0;
    for (Groups known = stages.empty() ? groups : stages[0]; stage + 1 < stages_.size() && (groups & ~known) != 0;)
      known |= stages[++stage];
    return stage;
  };
  for (const Node node : graph.reachable(outputs)) {
    const Entry& entry = graph[node];
    if (entry.operation == &unknown()) {  // the step that solves the system writes its register
      register_of(node) = register_of(entry.arguments[0]) + 1 + static_cast<std::uint32_t>(entry.number);
      continue;
    }
    const std::uint32_t to = next++;
    register_of(node) = to;
    const std::size_t stage = stage_for(entry.groups);
    stage_of_.push_back(entry.is_number() ? -1 : static_cast<int>(stage));
    if (entry.operation) {
      Step step{
          .operation = entry.operation, .to = to, .from = {}, .count = entry.count, .code = entry.operation->code};
      for (std::size_t i = 0; i < entry.count; ++i) step.from[i] = register_of(entry.arguments[i]);
      if (entry.solution) {
        SolveStep solve{.system = entry.solution->system, .from = {}};
        for (const Node operand : entry.operands()) solve.from.push_back(register_of(operand));
        step.solve = systems_.emplace_back(std::make_shared<const SolveStep>(std::move(solve))).get();
        next += static_cast<std::uint32_t>(step.results() - 1);
        stage_of_.resize(next, static_cast<int>(stage));
      }
      stages_[stage].steps.push_back(step);
    } else if (entry.is_number()) {
      numbers_.emplace_back(to, entry.number);
    } else {
      stages_[stage].inputs.push_back({static_cast<std::uint32_t>(entry.input), to});
    }
  }
  for (const Node node : outputs) outputs_.push_back(register_of(node));
  // The registers after those of the nodes are the scratch memory of the systems.
  std::size_t scratch = 0;
  for (const auto& solve : systems_) scratch = std::max(scratch, solve->from.size() + solve->system->scratch_size());
  registers_ = next + scratch;
}

std::span<const std::uint32_t> Program::Step::operands() const {
  return solve ? std::span<const std::uint32_t>(solve->from) : std::span<const std::uint32_t>(from.data(), count);
}
std::vector<Program::Step> Program::Stage::steps_for(std::vector<bool>& needed) const {
  std::vector<Step> found;
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
    const auto first = needed.begin() + step->to;
    const auto end = first + static_cast<std::ptrdiff_t>(step->results());
    if (std::find(first, end, true) == end) continue;
    for (const std::uint32_t operand : step->operands()) needed[operand] = true;
    found.push_back(*step);
  }
  std::ranges::reverse(found);
  return found;
}
std::size_t Program::Step::results() const { return solve ? 1 + solve->system->unknowns() : 1; }

namespace {

template <class S>
void run_solve(const Program::Step& step, std::span<S> registers) {
  std::vector<S> operands;
  for (const std::uint32_t operand : step.operands()) operands.push_back(registers[operand]);
  step.solve->system->solve(operands, registers.subspan(step.to, step.results()));
}
/// The same in double precision, without allocations, because systems are solved in the innermost loops of workspace
/// analyses. @param scratch  memory for the operands and for the system
void run_solve(const Program::Step& step, std::span<double> registers, std::span<double> scratch) {
  const std::span<double> operands = scratch.first(step.operands().size());
  for (std::size_t i = 0; i < operands.size(); ++i) operands[i] = registers[step.operands()[i]];
  step.solve->system->solve(operands, registers.subspan(step.to, step.results()), scratch.subspan(operands.size()));
}

/// Evaluates one of the four basic operations or a negation without an indirect call, which is faster.
/// @return false if the operation is another one, or if the value is not finite: then Operation::rules must be used,
///         which also set the derivatives of such a value
template <class S>
bool run_inline(const Program::Step& step, std::span<S> registers) {
  const S& x = registers[step.from[0]];
  const auto keep = [&](const S& result) {
    if (!std::isfinite(value_of(result))) return false;
    registers[step.to] = result;
    return true;
  };
  switch (step.code) {
    case Code::add:
      return keep(x + registers[step.from[1]]);
    case Code::subtract:
      return keep(x - registers[step.from[1]]);
    case Code::multiply:
      return keep(x * registers[step.from[1]]);
    case Code::divide:
      return keep(x / registers[step.from[1]]);
    case Code::negate:
      return keep(-x);
    default:
      return false;
  }
}

}  // namespace

template <class S>
void Program::run(std::size_t stage, std::span<S> registers) const {
  for (const Step& step : stages_[stage].steps) {
    if (run_inline(step, registers)) continue;
    if (step.code == Code::solve) {
      if constexpr (std::is_same_v<S, double>)
        run_solve(step, registers, registers.subspan(stage_of_.size()));
      else
        run_solve(step, registers);
      continue;
    }
    S arguments[kMaxArguments];
    for (std::size_t i = 0; i < step.count; ++i) arguments[i] = registers[step.from[i]];
    registers[step.to] = std::get<Rule<S>>(step.operation->rules)(arguments, step.count);
  }
}

namespace {

/// Evaluates a step with intervals. A product of a register with itself is computed as a square, whose enclosure is
/// tighter: for x in [-1, 2] it is [0, 4] instead of [-2, 4].
[[gnu::always_inline]] inline void run_step(const Program::Step& step, std::span<Interval> registers) {
  const Interval& x = registers[step.from[0]];
  const Interval& y = registers[step.from[1]];
  Interval& to = registers[step.to];
  switch (step.code) {
    case Code::add:
      to = x + y;
      break;
    case Code::subtract:
      to = x - y;
      break;
    case Code::multiply:
      to = step.from[0] == step.from[1] ? square(x) : x * y;
      break;
    case Code::divide:
      to = x / y;
      break;
    case Code::negate:
      to = -x;
      break;
    case Code::sqrt:
      to = sqrt(x);
      break;
    case Code::solve:
      run_solve(step, registers);
      break;
    default: {
      Interval arguments[kMaxArguments];
      for (std::size_t i = 0; i < kMaxArguments; ++i)
        if (i < step.count) arguments[i] = registers[step.from[i]];
      to = std::get<Rule<Interval>>(step.operation->rules)(arguments, step.count);
    }
  }
}

}  // namespace

[[gnu::flatten]] void run_steps(std::span<const Program::Step> steps, std::uint64_t version,
                                std::span<std::uint64_t> computed, std::span<Interval> registers) {
  for (const Program::Step& step : steps) {
    if (computed[step.to] == version) continue;
    run_step(step, registers);
    computed[step.to] = version;
  }
}

[[gnu::flatten]] void run_changed_steps(std::span<const Program::Step> steps, std::uint64_t version,
                                        const Dependence& dependence, std::span<std::uint64_t> computed,
                                        std::span<Interval> registers) {
  for (const Program::Step& step : steps) {
    if (computed[step.to] >= dependence.changed[dependence.sets[step.to]]) continue;
    run_step(step, registers);
    computed[step.to] = version;
  }
}

template <>
[[gnu::flatten]] void Program::run(std::size_t stage, std::span<Interval> registers) const {
  for (const Step& step : stages_[stage].steps) run_step(step, registers);
}

template void Program::run(std::size_t, std::span<double>) const;
template void Program::run(std::size_t, std::span<Dual4>) const;
template void Program::run(std::size_t, std::span<Taylor>) const;

}  // namespace pkm::expression
