// A formula of named numbers, read from text once and computed often: "volume / (pi * b * (l_u + l_d))".
//
// The text becomes a program that never changes and that works for every scalar. So threads share it, derivatives
// are as exact as those of the inputs, and values have the same bits on every processor, those of the formula written
// in C++.
//
// What a formula may hold: numbers (1, .5, 1e-3), the given names, `pi`, + - * / and signs, ^ (to the right: 2^3^2 is
// 2^9, and -a^2 is -(a^2)), comparisons < <= > >= == != and && || (1 or 0), c ? x : y, parentheses, and the functions
// of formula_functions(). Angles are in radians. Blanks and line ends mean nothing.
//
// What is undefined (the root of a negative number, 0/0) is NaN, and so is every comparison, choice, least or greatest
// of something undefined. A negative number has whole powers up to 1024 only. min, max, abs, comparisons and c ? x : y
// have kinks and jumps: there the derivative is that of the branch that gives the value. Where a slope is infinite
// (sqrt at 0), the derivative is no finite number either.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/graph/program.hpp"

namespace pkm {

/// Immutable, shared by threads.
class Formula {
 public:
  /// @param names  the numbers that it may use: letters, digits and '_', each once, none that a formula knows anyway
  /// Throws std::invalid_argument with a sentence that names the place when the text is no formula of these names.
  Formula(const std::string& text, const std::vector<std::string>& names);

  const std::string& text() const { return text_; }
  /// Positions in `names` of those that the formula uses, ascending.
  const std::vector<std::size_t>& used() const { return used_; }

  /// The formula's value; S is double, Dual4 or Taylor. Allocates nothing once the registers have served a formula of
  /// this size.
  /// @param values     one number per name; those not used are not looked at
  /// @param registers  overwritten
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
  graph::Program program_;
};

/// What a formula may hold, in one line for help texts.
std::string formula_help();

}  // namespace pkm
