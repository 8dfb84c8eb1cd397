#include "engine/expression/reverse_mode.hpp"

#include <cmath>

namespace pkm::expression {

void backward_sweep(const Program& program, std::size_t stage, std::span<const double> registers,
                    std::span<double> adjoints) {
  const auto& steps = program.stages()[stage].steps;
  const auto add = [&](std::uint32_t to, double adjoint) {
    if (std::isfinite(adjoint)) adjoints[to] += adjoint;
  };
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
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
        Dual4 arguments[kMaxArguments];
        for (int i = 0; i < step->count; ++i)
          arguments[i] = Dual4::variable(registers[step->from[static_cast<std::size_t>(i)]], i);
        const Dual4 result = std::get<Rule<Dual4>>(step->operation->rules)(arguments, step->count);
        for (int i = 0; i < step->count; ++i) add(step->from[static_cast<std::size_t>(i)], adjoint * result.v[i]);
      }
    }
  }
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
