// Decides whether the slices of a plan can be integrated by corner curves, and finds the functions of the outer
// coordinate whose roots divide its range.
//
// The coefficients of all boundary curves must be analytic functions of the outer coordinate t between the roots of
// known functions: arguments of square roots, absolute values, inverse sines and cosines, differences of the arguments
// of minima and maxima, divisors, constraints independent of the inner coordinates, and discriminants of pairs of
// parallel lines.
#pragma once

#include <optional>

#include "engine/expression/batch_stage.hpp"
#include "engine/generic/slice_plan.hpp"

namespace pkm::generic::corner_curves {

/// A function of the outer coordinate t whose roots divide the range of t. Its arguments are registers of the program.
struct OuterFunction {
  enum class Kind : std::uint8_t { value, difference, one_minus_square, discriminant };
  Kind kind = Kind::value;
  std::array<std::uint32_t, 3> registers{};
  /// true: boundary curves behave like square roots of the distance from a root of this function.
  bool has_root = false;
  /// true: the function is a constraint, so that slices in which it is negative have no feasible point.
  bool is_required = false;

  /// Value of the function, and its derivatives with respect to its arguments.
  /// @param x  values of the arguments; those that the function does not have are not read
  double value(const std::array<double, 3>& x) const;
  std::array<double, 3> derivatives(const std::array<double, 3>& x) const;
  std::size_t arguments() const {
    return kind == Kind::value || kind == Kind::one_minus_square ? 1 : kind == Kind::difference ? 2 : 3;
  }
};

/// Shape of a constraint surface in a slice.
enum class Shape : std::uint8_t { constant, line, circle, strip_along_v, strip_along_z, conic };

/// The shapes of the surfaces of a plan, and the functions that divide the range of its outer coordinate.
struct OuterPlan {
  std::vector<Shape> shapes;  ///< shape of each surface in a slice, by surface
  std::vector<OuterFunction> functions;
  /// The program's stage of t, with rows of all registers; set if corner curves can integrate the slices.
  std::optional<expression::BatchStage> stage;
  std::string why_not;  ///< reason why corner curves cannot integrate the slices; "" if they can

  explicit OuterPlan(const SlicePlan& plan);
};

}  // namespace pkm::generic::corner_curves
