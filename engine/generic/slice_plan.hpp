// Constraints of a workspace in slices: in planes (v, z) at given outer coordinates as conics whose coefficients a
// program computes, or in lines along z as polynomials of degree at most four or as transcendental functions.
#pragma once

#include <string>

#include "engine/expression/program.hpp"
#include "engine/generic/evaluation.hpp"
#include "engine/generic/surface_signs.hpp"

namespace pkm::generic {

/// A constraint surface in a slice: a conic, a polynomial or a transcendental function, given by registers of the
/// program.
struct Surface {
  /// Registers. Conic: coefficients of 1, v, z, v^2, v z, z^2. Polynomial, without v: those of 1, z, z^2, z^3, z^4.
  /// Transcendental: f(z) and its derivative, which the last stage of the program computes.
  std::array<std::uint32_t, 6> coefficients;
  bool has_z;              ///< of a conic: true if it depends on z
  bool is_high_degree;     ///< of a polynomial: true if its degree is three or four
  bool is_transcendental;  ///< true: slices are lines, and the constraint is no polynomial in z
};

/// Roles of the coordinates: outer coordinates, and the coordinates v and z of a slice.
struct CoordinateOrder {
  std::vector<std::size_t> outer;  ///< indices of the outer coordinates, the outermost first
  std::optional<std::size_t> v;    ///< index of the coordinate v; std::nullopt: slices are lines along z
  std::size_t z = 0;
};

using CoordinateRanges = std::vector<std::optional<std::array<double, 2>>>;

struct SlicePlan {
  CoordinateOrder order;
  expression::Program program;  ///< stages: the design, each outer coordinate, v; and z if a surface is transcendental
  std::vector<Surface> surfaces;
  Formula formula;
  /// Registers of the constraints that do not depend on z, by the stage that computes them; satisfied if >= 0.
  std::vector<std::vector<std::uint32_t>> independent;
  /// Constraints that depend on v but not on z. The outputs are, for each constraint, its value and its first and
  /// second derivative with respect to v; the stages are the design, each outer coordinate, v.
  expression::Program limits;
  /// The constraints in independent[1], which depend on the first coordinate only. The outputs are, for each
  /// constraint, its value and its derivative with respect to this coordinate; the stages are those of `program`.
  expression::Program univariate;
  /// Registers of the lower and upper bound of each outer coordinate, of v and of z, in this order.
  std::vector<std::array<std::uint32_t, 2>> range;
  std::string why_not;  ///< reason why the slices have no closed form; "" if they have one
};

/// Plans the slices of a workspace for one order of the coordinates. If they have no closed form, SlicePlan::why_not is
/// not empty.
/// @param curves  true: transcendental constraints are allowed if slices are lines
/// @param box     range of each coordinate that is searched; std::nullopt: the range of the model
SlicePlan plan_slices(const Evaluation& evaluation, std::size_t mode, const CoordinateOrder& order, bool curves,
                      const CoordinateRanges& box);

}  // namespace pkm::generic
