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

/// x in the lanes where it is finite, 0 in the others.
template <class L>
[[gnu::always_inline]] inline L finite_or_zero(const L& x) {
  return select(x - x >= 0.0, x, L(0.0));
}

template <class L>
[[gnu::always_inline]] inline double sum_of_lanes(const L& x) {
  double lane[kLanes], total = 0;
  x.store(lane);
  for (const double each : lane) total += each;
  return total;
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

template <InstructionSet set>
void sweep_batch(std::span<const BatchStep> steps, const double* registers, const double* rows, std::size_t count,
                 const BatchAdjoints& adjoints) {
  using L = LanesOf<set>;
  for (std::size_t s = steps.size(); s-- > 0;) {
    const BatchStep& step = steps[s];
    double* const of_result = adjoints.rows + step.to * kRow;
    const double* const result = rows + step.to * kRow;
    L largest(0.0);
    for (std::size_t k = 0; k < count; k += kLanes) {
      const L adjoint = L::load(of_result + k);
      largest = greater(largest, greater(adjoint, -adjoint));
    }
    if (!any(largest > 0.0)) continue;
    // Adds contribution(k, adjoint of the result) to the adjoint of an operand.
    const auto add = [&](const Operand& to, const auto& contribution) __attribute__((always_inline)) {
      const auto at = [&](std::size_t k) __attribute__((always_inline)) {
        return finite_or_zero(contribution(k, L::load(of_result + k)));
      };
      if (to.row) {
        double* const row = adjoints.rows + to.index * kRow;
        for (std::size_t k = 0; k < count; k += kLanes) (L::load(row + k) + at(k)).store(row + k);
      } else {
        L total(0.0);
        for (std::size_t k = 0; k < count; k += kLanes) total = total + at(k);
        adjoints.registers[to.index] += sum_of_lanes(total);
      }
    };
    const auto with_operands = [&](const auto& visit) __attribute__((always_inline)) {
      with_operand<L>(
          step.from[0], registers, rows, [&](const auto& x) __attribute__((always_inline)) {
            with_operand<L>(
                step.from[1], registers, rows, [&](const auto& y) __attribute__((always_inline)) { visit(x, y); });
          });
    };
    switch (step.code) {
      case Code::add:
      case Code::subtract: {
        const bool is_sum = step.code == Code::add;
        add(
            step.from[0], [](std::size_t, const L& adjoint) __attribute__((always_inline)) { return adjoint; });
        add(
            step.from[1], [is_sum](std::size_t, const L& adjoint)
                              __attribute__((always_inline)) { return is_sum ? adjoint : -adjoint; });
        break;
      }
      case Code::multiply:
        with_operands([&](const auto& x, const auto& y) __attribute__((always_inline)) {
          add(
              step.from[0], [&y](std::size_t k, const L& adjoint)
                                __attribute__((always_inline)) { return adjoint * y(k); });
          add(
              step.from[1], [&x](std::size_t k, const L& adjoint)
                                __attribute__((always_inline)) { return adjoint * x(k); });
        });
        break;
      case Code::divide:
        with_operands([&](const auto&, const auto& y) __attribute__((always_inline)) {
          add(
              step.from[0], [&y](std::size_t k, const L& adjoint)
                                __attribute__((always_inline)) { return adjoint / y(k); });
          add(
              step.from[1], [&y, result ](std::size_t k, const L& adjoint)
                                __attribute__((always_inline)) { return -adjoint * L::load(result + k) / y(k); });
        });
        break;
      case Code::negate:
        add(
            step.from[0], [](std::size_t, const L& adjoint) __attribute__((always_inline)) { return -adjoint; });
        break;
      case Code::sqrt:
        add(
            step.from[0], [result](std::size_t k, const L& adjoint)
                              __attribute__((always_inline)) { return adjoint * 0.5 / L::load(result + k); });
        break;
      default:
        sweep_other(step, registers, rows, count, adjoints);
    }
    for (std::size_t k = 0; k < count; k += kLanes) L(0.0).store(of_result + k);
  }
}

template void run_batch<PKM_INSTRUCTION_SET>(std::span<const BatchStep>, const double*, double*, std::size_t);
template void sweep_batch<PKM_INSTRUCTION_SET>(std::span<const BatchStep>, const double*, const double*, std::size_t,
                                               const BatchAdjoints&);

}  // namespace pkm::expression
