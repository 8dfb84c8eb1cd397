// What formulas are made of: functions, operators, signs and choices, each stated once for every scalar.
#pragma once

#include <cstddef>
#include <string>
#include <tuple>
#include <vector>

#include "engine/math/dual.hpp"
#include "engine/math/interval.hpp"
#include "engine/math/taylor.hpp"

namespace pkm::graph {

/// For those who compute many values side by side (rows_kernel.cpp); `other`: by its rule alone.
enum class Code : unsigned char { add, subtract, multiply, divide, negate, sqrt, abs, min, max, other };

/// What an operation makes of x[0], ..., x[count - 1].
template <class S>
using Rule = S (*)(const S* x, std::size_t count);

inline constexpr std::size_t kMostArguments = 3;  ///< of an operation in a graph

struct Operation {
  std::string name;           ///< as it is written
  std::size_t arguments = 1;  ///< 0: two or more, of which a graph takes the first two, the result and the next, ...
  std::tuple<Rule<double>, Rule<Dual4>, Rule<Taylor>, Rule<Interval>> rules;
  int rank = 0;  ///< of operators and signs: the greater binds first
  Code code = Code::other;

  bool operator==(const Operation& other) const { return this == &other; }
};

/// Every function that a formula may call.
const std::vector<Operation>& functions();
/// The operators between two numbers. Those of equal rank go from the left, but for ^.
const std::vector<Operation>& operators();
/// The sign -; the sign + does nothing.
const Operation& negation();
/// c ? x : y.
const Operation& choice();
/// An angle less whole turns, in (-pi, pi]; no text calls it.
const Operation& turn();

/// A function or an operator by its name. Throws std::logic_error where there is none.
const Operation& operation(const std::string& name);

}  // namespace pkm::graph
