// Catalogue of the elementary operations of formulas: functions, operators, negation and the conditional operator.
//
// Each operation is implemented for four scalars: double, Dual4 (forward-mode automatic differentiation with respect to
// four variables), Taylor (first and second derivative with respect to one variable) and Interval (interval arithmetic
// with outward rounding). One generic implementation serves the first three, so that values have the same bits in all
// of them.
#pragma once

#include <cstddef>
#include <string>
#include <tuple>
#include <vector>

#include "engine/math/dual.hpp"
#include "engine/math/interval.hpp"
#include "engine/math/taylor.hpp"

namespace pkm::expression {

/// Selects a dedicated implementation: in Program::run and in the SIMD kernel (batch_kernel.cpp). `other`: there is
/// none, the operation is evaluated through Operation::rules. `solve`: a system of equations (implicit_system.hpp).
enum class Code : unsigned char { add, subtract, multiply, divide, negate, sqrt, abs, min, max, solve, other };

/// Evaluates an operation for the arguments x[0], ..., x[count - 1].
template <class S>
using Rule = S (*)(const S* x, std::size_t count);

inline constexpr std::size_t kMaxArguments = 3;  ///< maximum number of arguments of an operation in a graph

struct Operation {
  std::string name;           ///< name of the operation as written in formulas
  std::size_t arguments = 1;  ///< number of arguments; 0: two or more (min, max), which a graph nests from the left
  std::tuple<Rule<double>, Rule<Dual4>, Rule<Taylor>, Rule<Interval>> rules;
  int rank = 0;  ///< precedence of an operator, where a higher one binds more tightly; 0 for a function
  Code code = Code::other;

  bool operator==(const Operation& other) const { return this == &other; }
};

/// Every function that a formula may call.
const std::vector<Operation>& functions();
/// The binary operators. Operators of equal rank are left-associative, except ^, which is right-associative.
const std::vector<Operation>& operators();
/// The unary minus. (The unary plus is dropped by the parser.)
const Operation& negation();
/// The conditional operator c ? x : y.
const Operation& choice();
/// Wraps an angle [rad] to (-pi, pi] by subtracting full turns; for internal use, formulas cannot call it.
const Operation& angle_wrapping();
/// The operations of the nodes that Graph::solve() adds; for internal use, and without rules: solving a system of
/// equations, and the value of one of its unknowns.
const Operation& solving();
const Operation& unknown();

/// Finds a function or a binary operator by its name. Throws std::logic_error if there is none.
const Operation& operation(const std::string& name);

}  // namespace pkm::expression
