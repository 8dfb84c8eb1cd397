// Polynomial normal form of constraints: elimination of radicals, minima, maxima and absolute values.
//
// A constraint f >= 0 is rewritten along one coordinate z as a conjunction of clauses (conjunctive normal form), each
// of which requires that at least one of several polynomials in z is >= 0. The polynomials have degree at most two, or
// at most four, and their coefficients are nodes of the same graph. The endpoints of the feasible intervals in z are
// then roots of quadratics, in closed form, or of quartics.
//
//   min(f, g) >= 0        f >= 0 and g >= 0
//   max(f, g) >= 0        f >= 0 or g >= 0
//   x - |u| >= 0          x - u >= 0 and x + u >= 0
//   c f >= 0              (f >= 0 or -c >= 0) and (-f >= 0 or c >= 0), where c does not depend on z
//   A + B sqrt(Q) >= 0    B < 0: A >= 0 and A^2 - B^2 Q >= 0;   B > 0: A >= 0 or B^2 Q - A^2 >= 0
//
// Sums, differences, products, quotients and roots are first reduced to the radical form A + B sqrt(Q), where A, B and
// Q are polynomials in z. Q >= 0 is not included: the caller requires it as a constraint of its own.
#pragma once

#include <compare>
#include <optional>
#include <vector>

#include "engine/expression/graph.hpp"

namespace pkm::expression {

/// c[0] + c[1] z + c[2] z^2 + c[3] z^3 + c[4] z^4
struct Polynomial {
  std::array<Node, 5> c;

  auto operator<=>(const Polynomial&) const = default;
};

/// A disjunction: at least one of the polynomials is >= 0.
using Clause = std::vector<Polynomial>;

/// Converts f >= 0 to conjunctive normal form.
/// @param z        group of the coordinate
/// @param degree   maximum degree of the polynomials, 2 or 4
/// @param squares  also factor Y - u^2 = (sqrt(Y) - u) (sqrt(Y) + u), where u may contain a root, and constraints that
///                 contain the root of such a difference, and move constants into minima and maxima; this converts
///                 more constraints, to more clauses
/// @param nonnegative  by input of the graph, true: the input is >= 0; inputs that are missing may have any sign
/// @return clauses, all of which hold if and only if f >= 0, wherever f is defined; std::nullopt if f has no such form
std::optional<std::vector<Clause>> polynomial_clauses(Graph& graph, Node f, Groups z, std::size_t degree = 2,
                                                      bool squares = false, const std::vector<bool>& nonnegative = {});

/// The coefficients of f as a polynomial in z of degree at most four, constant term first; std::nullopt if f has no
/// such form.
std::optional<std::vector<Node>> polynomial(Graph& graph, Node f, Groups z);

}  // namespace pkm::expression
