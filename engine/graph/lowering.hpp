// Conditions f >= 0 along one coordinate z as conditions of polynomials of degree two or less, or four, in z, whose
// coefficients are nodes of the same graph: where a column ends then is a closed form, or a root among four at most.
//
// A form A + B sqrt(Q), with polynomials A, B and Q, goes through + - * / and sqrt. Where the sign of B is known, f >=
// 0 is B < 0: A >= 0 and A^2 - B^2 Q >= 0; B > 0: A >= 0 or B^2 Q - A^2 >= 0. That Q >= 0 is a condition of its own.
#pragma once

#include <compare>
#include <optional>
#include <vector>

#include "engine/graph/graph.hpp"

namespace pkm::graph {

/// c[0] + c[1] z + c[2] z^2 + c[3] z^3 + c[4] z^4
struct Polynomial {
  std::array<Node, 5> c;

  auto operator<=>(const Polynomial&) const = default;
};

/// At least one of them is >= 0.
using Clause = std::vector<Polynomial>;

/// Clauses that hold together where f >= 0; none: f is not of this kind.
/// @param z        the group of the coordinate
/// @param degree   the greatest, 2 or 4
/// @param squares  whether Y - u^2 and what holds its root are taken apart, too, where u is a form with a root: that
///                 takes more clauses
std::optional<std::vector<Clause>> lowered(Graph& graph, Node f, Groups z, std::size_t degree = 2,
                                           bool squares = false);

/// The coefficients of f as a polynomial in z, the lowest first, at most five; none: it is no such polynomial.
std::optional<std::vector<Node>> polynomial(Graph& graph, Node f, Groups z);

}  // namespace pkm::graph
