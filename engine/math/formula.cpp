#include "engine/math/formula.hpp"

#include <type_traits>

#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/math/formula_operations.hpp"
#include "engine/math/formula_reader.hpp"
#include "engine/math/formula_words.hpp"

namespace pkm {
namespace {

using formula::Operation;

/// The operation's value, with the derivatives of its arguments. What depends on constants alone is constant, even
/// where the operation has no slope (sqrt at 0).
template <class S>
S compute(Operation operation, const S* x, std::size_t count) {
  if constexpr (!std::is_same_v<S, double>)
    if (count <= 2 && formula::is_constant(x[0]) && formula::is_constant(x[count - 1])) {
      const double values[2] = {value_of(x[0]), value_of(x[count - 1])};
      return S(formula::apply(operation, values, count));
    }
  return formula::apply(operation, x, count);
}

}  // namespace

Formula::Formula(const std::string& text, const std::vector<std::string>& names)
    : program_(formula::read_program(text, names)) {}

template <class S>
S Formula::value(std::span<const S> values, std::vector<S>& stack) const {
  if (stack.size() < program_.depth) stack.resize(program_.depth);
  S* top = stack.data();  // behind the uppermost number
  for (std::size_t i = 0; i < program_.steps.size(); ++i) {
    const auto& [operation, count, number] = program_.steps[i];
    switch (operation) {
      case Operation::number:
        *top++ = S(number);
        break;
      case Operation::name:
        *top++ = values[count];
        break;
      case Operation::nothing:
        break;
      case Operation::jump_if_zero: {
        const double condition = value_of(*--top);
        if (condition != condition) return *top;
        if (condition == 0) i = count - 1;
        break;
      }
      case Operation::jump:
        i = count - 1;
        break;
      default:
        top -= count;
        *top = compute(operation, top, count);
        ++top;
    }
  }
  return stack.front();
}

template double Formula::value(std::span<const double>, std::vector<double>&) const;
template Dual4 Formula::value(std::span<const Dual4>, std::vector<Dual4>&) const;
template Taylor Formula::value(std::span<const Taylor>, std::vector<Taylor>&) const;

std::string formula_help() {
  return "numbers, pi, + - * / ^, comparisons, && ||, c ? x : y, and the functions " +
         join(names_of(formula::functions()));
}

}  // namespace pkm
