#include "engine/expression/reverse_mode.hpp"

#include <algorithm>
#include <cmath>

#include "engine/expression/implicit_system.hpp"

namespace pkm::expression {
namespace {

void sweep_system(const Program::Step& step, std::span<const double> registers, std::span<double> adjoints) {
  const std::span<double> of_results = adjoints.subspan(step.to, step.results());
  const std::vector<double> of_unknowns(of_results.begin() + 1, of_results.end());
  std::ranges::fill(of_results, 0.0);
  if (std::ranges::count(of_unknowns, 0.0) == static_cast<std::ptrdiff_t>(of_unknowns.size())) return;
  std::vector<double> operands;
  for (const std::uint32_t operand : step.operands()) operands.push_back(registers[operand]);
  const std::vector<double> found =
      step.solve->system->adjoints(operands, registers.subspan(step.to + 1, of_unknowns.size()), of_unknowns);
  for (std::size_t i = 0; i < operands.size(); ++i)
    if (std::isfinite(found[i])) adjoints[step.operands()[i]] += found[i];
}

}  // namespace

void backward_sweep(const Program& program, std::size_t stage, std::span<const double> registers,
                    std::span<double> adjoints) {
  const auto& steps = program.stages()[stage].steps;
  const auto add = [&](std::uint32_t to, double adjoint) {
    if (std::isfinite(adjoint)) adjoints[to] += adjoint;
  };
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
    if (step->solve) {
      sweep_system(*step, registers, adjoints);
      continue;
    }
    const double adjoint = adjoints[step->to];
    adjoints[step->to] = 0;
    if (adjoint == 0) continue;
    const double x = registers[step->from[0]], y = step->count > 1 ? registers[step->from[1]] : 0;
    switch (step->operation->code) {
      case Code::add:
      case Code::subtract:
        add(step->from[0], adjoint);
        add(step->from[1], step->operation->code == Code::add ? adjoint : -adjoint);
        break;
      case Code::multiply:
        add(step->from[0], adjoint * y);
        add(step->from[1], adjoint * x);
        break;
      case Code::divide:
        add(step->from[0], adjoint / y);
        add(step->from[1], -adjoint * (x / y) / y);
        break;
      case Code::negate:
        add(step->from[0], -adjoint);
        break;
      case Code::sqrt:
        add(step->from[0], adjoint * 0.5 / registers[step->to]);
        break;
      default: {
        double arguments[kMaxArguments];
        for (std::size_t i = 0; i < step->count; ++i) arguments[i] = registers[step->from[i]];
        const auto partial = partial_derivatives(std::get<Rule<Dual4>>(step->operation->rules), arguments, step->count);
        for (std::size_t i = 0; i < step->count; ++i) add(step->from[i], adjoint * partial[i]);
      }
    }
  }
}

std::array<double, kMaxArguments> partial_derivatives(Rule<Dual4> rule, const double* x, std::size_t count) {
  Dual4 arguments[kMaxArguments];
  for (std::size_t i = 0; i < count; ++i) arguments[i] = Dual4::variable(x[i], static_cast<int>(i));
  const Dual4 result = rule(arguments, count);
  std::array<double, kMaxArguments> partial{};
  for (std::size_t i = 0; i < count; ++i) partial[i] = result.v[static_cast<int>(i)];
  return partial;
}

double stage_derivative(const Program& program, std::size_t stage, std::uint32_t of, std::span<const double> registers,
                        std::vector<double>& by) {
  by.assign(program.registers(), 0);
  by[of] = 1;
  backward_sweep(program, stage, registers, by);
  double derivative = 0;
  for (const auto& input : program.stages()[stage].inputs) {
    derivative += by[input.to];
    by[input.to] = 0;
  }
  return derivative;
}

}  // namespace pkm::expression
