#include "engine/expression/batch_stage.hpp"
#include "engine/math/lanes.hpp"

namespace pkm::expression {
namespace {

/// Calls visit(x) with a function x that loads the values of an operand: x(k) is the SIMD vector of elements k, k + 1,
/// ... of the operand's row or, if the operand is a single number, this number in all lanes. The function is thus
/// selected once per step, not once per value.
template <class L, class Visit>
[[gnu::always_inline]] inline void with_operand(const Operand& operand, const double* registers, const double* rows,
                                                const Visit& visit) {
  if (operand.row) {
    const double* const row = rows + operand.index * kRow;
    visit([row](std::size_t k) __attribute__((always_inline)) { return L::load(row + k); });
  } else {
    const L number(registers[operand.index]);
    visit([number](std::size_t) __attribute__((always_inline)) { return number; });
  }
}

}  // namespace

template <InstructionSet set>
void run_batch(std::span<const BatchStep> steps, const double* registers, double* rows, std::size_t count) {
  using L = LanesOf<set>;
  for (const BatchStep& step : steps) {
    double* const to = rows + step.to * kRow;
    const auto unary = [&](const auto& f) __attribute__((always_inline)) {
      with_operand<L>(
          step.from[0], registers, rows, [&](const auto& x) __attribute__((always_inline)) {
            for (std::size_t k = 0; k < count; k += kLanes) f(x(k)).store(to + k);
          });
    };
    const auto binary = [&](const auto& f) __attribute__((always_inline)) {
      with_operand<L>(
          step.from[0], registers, rows, [&](const auto& x) __attribute__((always_inline)) {
            with_operand<L>(
                step.from[1], registers, rows, [&](const auto& y) __attribute__((always_inline)) {
                  for (std::size_t k = 0; k < count; k += kLanes) f(x(k), y(k)).store(to + k);
                });
          });
    };
    switch (step.code) {
      case Code::add:
        binary([](const L& x, const L& y) __attribute__((always_inline)) { return x + y; });
        break;
      case Code::subtract:
        binary([](const L& x, const L& y) __attribute__((always_inline)) { return x - y; });
        break;
      case Code::multiply:
        binary([](const L& x, const L& y) __attribute__((always_inline)) { return x * y; });
        break;
      case Code::divide:
        binary([](const L& x, const L& y) __attribute__((always_inline)) { return x / y; });
        break;
      case Code::negate:
        unary([](const L& x) __attribute__((always_inline)) { return -x; });
        break;
      case Code::sqrt:
        unary([](const L& x) __attribute__((always_inline)) { return sqrt(x); });
        break;
      case Code::abs:
        unary([](const L& x) __attribute__((always_inline)) { return select(x < 0.0, -x, x); });
        break;
      case Code::min:  // as in scalar evaluation, the result is NaN if an argument is NaN
        binary([](const L& x, const L& y)
                   __attribute__((always_inline)) { return select(y >= y, select(y < x, y, x), y); });
        break;
      case Code::max:
        binary([](const L& x, const L& y)
                   __attribute__((always_inline)) { return select(y >= y, select(y > x, y, x), y); });
        break;
      case Code::solve:
        solve_batch(*step.solve, registers, rows, count);
        break;
      case Code::other:
        for (std::size_t k = 0; k < count; ++k) {
          double arguments[kMaxArguments];
          for (std::size_t i = 0; i < step.count; ++i)
            arguments[i] = step.from[i].row ? rows[step.from[i].index * kRow + k] : registers[step.from[i].index];
          to[k] = step.rule(arguments, step.count);
        }
        break;
    }
  }
}

template void run_batch<PKM_INSTRUCTION_SET>(std::span<const BatchStep>, const double*, double*, std::size_t);

}  // namespace pkm::expression
