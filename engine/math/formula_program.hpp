// A formula that has been read: steps for a stack of numbers, as data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pkm::formula {

enum class Operation : std::uint8_t {
  // of the stack
  number,
  name,
  jump,
  jump_if_zero,
  nothing,  // where two branches meet; the sign +
  // of the uppermost numbers: formula_operations.hpp
  negate,
  add,
  subtract,
  multiply,
  divide,
  power,
  less,
  less_or_equal,
  greater,
  greater_or_equal,
  equal,
  unequal,
  both,
  either,
  sine,
  cosine,
  tangent,
  arcsine,
  arccosine,
  arctangent,
  arctangent_2,
  hyperbolic_sine,
  hyperbolic_cosine,
  hyperbolic_tangent,
  exponential,
  logarithm,
  logarithm_10,
  root,
  magnitude,
  sign,
  least,
  greatest,
};

struct Step {
  Operation operation = Operation::nothing;
  std::size_t count = 0;  ///< numbers it takes off the stack; of a name its position, of a jump the step to go on with
  double number = 0;
};

struct Program {
  std::vector<Step> steps;
  std::vector<std::size_t> used;  ///< positions of the names in use, ascending
  std::size_t depth = 0;          ///< of the stack
};

}  // namespace pkm::formula
