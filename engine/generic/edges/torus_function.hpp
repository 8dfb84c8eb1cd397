// The implicit function of a second surface on a torus, and the boxes in which its zero set is a smooth curve.
//
// On the torus p(q, b) = c + (crank + rod cos b) e_r(q) + rod sin b axis, the function of a torus or of a cylinder is a
// trigonometric polynomial f(q, b) of degree (2, 2). Bounds of its second derivatives follow from the coefficients, so
// that in a box of half widths h_q, h_b
//
//   |f - f(m)|  <= |f_q(m)| h_q + |f_b(m)| h_b + (M_qq h_q^2 + 2 M_qb h_q h_b + M_bb h_b^2) / 2
//   |f_q - f_q(m)| <= M_qq h_q + M_qb h_b,  likewise f_b.
//
// Where f_b has no zero in a box, f = 0 is at most one curve b(q) there, and the other way round.
#pragma once

#include <optional>

#include "engine/generic/edges/faces.hpp"

namespace pkm::generic::edges {

/// Trigonometric polynomial a[0] + a[1] cos t + a[2] sin t + a[3] cos 2t + a[4] sin 2t, by its coefficients.
using Trigonometric = std::array<double, 5>;

class TorusFunction {
 public:
  struct Value {
    double f = 0;
    std::array<double, 2> by{};  ///< derivatives of f with respect to q and b
  };
  /// @param torus  a face that is the fold of a crank
  /// @param other  a face that is the fold of another crank, or a cylinder
  TorusFunction(const Face& torus, const Face& other);
  TorusFunction() = default;

  /// @param q_b  angle q of the crank and angle b around its fold [rad]
  Value at(const std::array<double, 2>& q_b) const;
  /// Upper bound of the magnitude of the second derivative of f with respect to the coordinates i and j (0: q, 1: b).
  double bend(std::size_t i, std::size_t j) const { return bend_[i + j]; }
  /// Sum of the magnitudes of the coefficients, an upper bound of |f|.
  double size() const { return size_; }

 private:
  /// c_[m][n]: coefficient of the product of function m of q and function n of b, of 1, cos t, sin t, cos 2t, sin 2t.
  std::array<Trigonometric, 5> c_{};
  std::array<double, 3> bend_{};  ///< bounds of the second derivatives qq, qb and bb
  double size_ = 0;
};

/// A box of the angles q and b, by its middle and half widths [rad].
struct TorusBox {
  std::array<double, 2> middle{}, half{};
};

/// A curve along which f = 0, with one of q and b as its parameter, and bounds that hold in its box.
struct TorusArc {
  std::size_t along = 0;           ///< the angle that is the parameter; 0: q, 1: b
  double from = 0, to = 0;         ///< range of the parameter [rad]
  std::array<double, 2> across{};  ///< range of the other angle [rad]
  double max_slope = 0;  ///< maximum magnitude of the derivative of the other angle with respect to the parameter
  double least = 0;      ///< minimum magnitude of the derivative of f with respect to the other angle
};

struct CurveInBox {
  enum class State : std::uint8_t { absent, unresolved, found };
  State state;
  std::size_t longer = 0;         ///< if unresolved: the coordinate along which the box has to be bisected
  std::optional<TorusArc> arc{};  ///< if found: the curve, restricted to the box
};
/// Decides whether f has a zero in a box, and finds the curve f = 0 if it is a function of one angle there.
/// @param rounding_error  bound of the rounding error of f
CurveInBox find_curve_in(const TorusFunction& function, const TorusBox& box, double rounding_error);

/// The angle of a point of an arc that is not the parameter, with its derivative with respect to the parameter and a
/// bound of the second derivative.
Enclosure other_coordinate(const TorusFunction& function, const TorusArc& arc, const Enclosure& parameter);

}  // namespace pkm::generic::edges
