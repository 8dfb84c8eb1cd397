// A formula that has been read: steps for a stack of numbers, as data; and the operations that it is made of.
#pragma once

#include <cstddef>
#include <string>
#include <tuple>
#include <vector>

#include "engine/math/dual.hpp"
#include "engine/math/taylor.hpp"

namespace pkm::formula {

/// What an operation makes of x[0], ..., x[count - 1], left in x[0].
template <class S>
using Rule = void (*)(S* x, std::size_t count);

/// A function, an operator or a sign.
struct Operation {
  std::string name;           ///< as it is written
  std::size_t arguments = 1;  ///< 0: two or more
  std::tuple<Rule<double>, Rule<Dual4>, Rule<Taylor>> rules;
  int rank = 0;  ///< of operators and signs: the greater binds first
};

/// Every function that a formula may call.
const std::vector<Operation>& functions();
/// The operators between two numbers. Those of equal rank go from the left, but for ^.
const std::vector<Operation>& operators();
/// The sign -; the sign + does nothing.
const Operation& negation();

struct Step {
  enum class Kind { number, name, operation, jump, jump_if_zero };
  Kind kind = Kind::number;
  std::size_t count = 0;  ///< numbers it takes off the stack; of a name its position, of a jump the step to go on with
  double number = 0;
  const Operation* operation = nullptr;
};

struct Program {
  std::vector<Step> steps;
  std::vector<std::size_t> used;  ///< positions of the names in use, ascending
  std::size_t depth = 0;          ///< of the stack
};

/// Throws as Formula's constructor does.
Program read_program(const std::string& text, const std::vector<std::string>& names);

}  // namespace pkm::formula
