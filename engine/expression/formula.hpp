// A formula in named variables, such as "volume / (pi * b * (l_u + l_d))": parsed once, evaluated often.
//
// The text is compiled into an immutable Program, which threads can share. It is evaluated with double or with a scalar
// for automatic differentiation; its values have the same bits on every processor, and the bits of the same formula
// written in C++.
//
// Syntax: numbers (1, .5, 1e-3), the given names, `pi`, + - * / and signs, ^ (right-associative: 2^3^2 is 2^9, and -a^2
// is -(a^2)), comparisons < <= > >= == != and the logical operators && || (result 1 or 0), c ? x : y, parentheses, and
// the functions listed by formula_help(). Angles are in radians. Blanks and line ends are ignored.
//
// An undefined value (the root of a negative number, 0/0) is NaN, and so is a comparison, choice, minimum or maximum of
// NaN. A negative number can be raised to integer powers up to 1024 only. min, max, abs, comparisons and c ? x : y are
// not differentiable everywhere: there, the derivative is that of the branch that gives the value. Where the derivative
// is infinite (sqrt at 0), the computed derivative is not finite either.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/expression/program.hpp"

namespace pkm {

/// A parsed formula of named variables. Immutable and thread-safe.
class Formula {
 public:
  /// Throws std::invalid_argument with a message that gives the position of the error if `text` is not a valid formula,
  /// and std::logic_error if a name is invalid or given twice.
  /// @param names  variables that the formula may use; a name is valid if expression::may_be_name() is true
  Formula(const std::string& text, const std::vector<std::string>& names);

  const std::string& text() const { return text_; }
  /// Indices in `names` of the variables that the formula uses, ascending.
  const std::vector<std::size_t>& used() const { return used_; }

  /// The formula's value; S is double, Dual4 or Taylor. Does not allocate if `registers` has enough capacity, as after
  /// an earlier call.
  /// @param values     one value per name; those of unused names are ignored
  /// @param registers  scratch memory
  template <class S>
  S value(std::span<const S> values, std::vector<S>& registers) const {
    program_.run_all(values, registers);
    return registers[program_.outputs().front()];
  }
  template <class S>
  S value(std::span<const S> values) const {
    std::vector<S> registers;
    return value(values, registers);
  }

 private:
  std::string text_;
  std::vector<std::size_t> used_;
  expression::Program program_;
};

/// The syntax of formulas in one line, for help texts.
std::string formula_help();

}  // namespace pkm
