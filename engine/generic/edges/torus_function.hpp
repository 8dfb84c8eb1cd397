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
    std::array<double, 2> by{};  ///< derivatives of the function f with respect to the angles q and b
  };
  /// @param torus  a face that is the fold of a crank
  /// @param other  a face that is the fold of another crank, or a cylinder
  TorusFunction(const Face& torus, const Face& other);
  TorusFunction() = default;

  /// The function of one angle if the other one is fixed. It computes once what depends on the fixed angle only.
  class OfOneAngle {
   public:
    /// @param fixed  which angle is fixed; 0: q, 1: b
    /// @param angle  its value [rad]
    OfOneAngle(const TorusFunction& function, std::size_t fixed, double angle);
    /// Value of f and its derivatives at a value of the other angle [rad].
    Value at(double other) const;

   private:
    /// Coefficients of f as a polynomial of q, and their derivatives by b.
    /// @param b, db  functions of b and their derivatives
    void set_b(const Trigonometric& b, const Trigonometric& db, Trigonometric& at_b, Trigonometric& at_db) const;

    const std::array<Trigonometric, 5>& c_;
    std::size_t fixed_;
    std::array<Trigonometric, 2> own_;  ///< functions of the fixed angle [0], and their derivatives [1]
    Trigonometric at_b_{}, at_db_{};    ///< if b is fixed: results of set_b()
  };

  /// Value of f and its derivatives at a point of the torus.
  /// @param q_b  angle q of the crank and angle b around its fold [rad]
  Value at(const std::array<double, 2>& q_b) const { return OfOneAngle(*this, 1, q_b[1]).at(q_b[0]); }
  /// Upper bound of the magnitude of the second derivative of f with respect to the coordinates i and j (0: q, 1: b).
  double bend(std::size_t i, std::size_t j) const { return bend_[i + j]; }
  /// Sum of the magnitudes of the coefficients, an upper bound of |f|.
  double size() const { return size_; }

 private:
  /// c_[m][n]: coefficient of the product of function m of q and function n of b; the functions are 1, cos, sin, and
  /// cos and sin of the double angle.
  std::array<Trigonometric, 5> c_{};
  /// Bounds of the magnitudes of the second derivatives of f: twice by q, by q and b, twice by b.
  std::array<double, 3> bend_{};
  double size_ = 0;
};

/// A box of the angles q and b, given by its centre and half its widths [rad].
struct TorusBox {
  std::array<double, 2> middle{}, half{};
};

/// A curve f = 0 with one of the angles q and b as its parameter, and bounds that hold in the box in which it was
/// found.
struct TorusArc {
  std::size_t along = 0;           ///< which angle is the parameter; 0: q, 1: b
  double from = 0, to = 0;         ///< range of the parameter [rad]
  std::array<double, 2> across{};  ///< range of the angle that is not the parameter [rad]
  double max_slope = 0;  ///< upper bound of the magnitude of the other angle's derivative with respect to the parameter
  double least = 0;      ///< lower bound of the magnitude of the derivative of f with respect to the other angle
};

struct CurveInBox {
  enum class State : std::uint8_t { absent, unresolved, found };
  State state;
  std::size_t longer = 0;         ///< if unresolved: which angle to bisect next; 0: q, 1: b
  std::optional<TorusArc> arc{};  ///< if found: the curve inside the box
};
/// Decides whether f has a zero in a box, and finds the curve f = 0 if it is a function of one angle there.
/// @param rounding_error  bound of the rounding error of f
CurveInBox find_curve_in(const TorusFunction& function, const TorusBox& box, double rounding_error);

/// On an arc, the angle that is not the parameter: its value, its derivative with respect to the parameter, and a bound
/// of its second derivative.
Enclosure other_coordinate(const TorusFunction& function, const TorusArc& arc, const Enclosure& parameter);

}  // namespace pkm::generic::edges
