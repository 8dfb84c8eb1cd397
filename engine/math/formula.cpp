#include "engine/math/formula.hpp"

#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"

namespace pkm {

using formula::Step;

Formula::Formula(const std::string& text, const std::vector<std::string>& names)
    : program_(formula::read_program(text, names)) {}

template <class S>
S Formula::value(std::span<const S> values, std::vector<S>& stack) const {
  if (stack.size() < program_.depth) stack.resize(program_.depth);
  S* top = stack.data();  // behind the uppermost number
  for (std::size_t i = 0; i < program_.steps.size(); ++i) {
    const auto& [kind, count, number, operation] = program_.steps[i];
    switch (kind) {
      case Step::Kind::number:
        *top++ = S(number);
        break;
      case Step::Kind::name:
        *top++ = values[count];
        break;
      case Step::Kind::operation:
        top -= count;
        std::get<formula::Rule<S>>(operation->rules)(top, count);
        ++top;
        break;
      case Step::Kind::jump_if_zero: {
        const double condition = value_of(*--top);
        if (condition != condition) return *top;
        if (condition == 0) i = count - 1;
        break;
      }
      case Step::Kind::jump:
        i = count - 1;
        break;
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
