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
  /// Registers of its terms. Conic: coefficients of 1, v, z, v^2, v z, z^2. Polynomial (slices are lines): coefficients
  /// of 1, z, z^2, z^3, z^4. Transcendental function: value f(z) and derivative f'(z), computed by the last stage of
  /// the program.
  std::array<std::uint32_t, 6> coefficients;
  bool has_z;              ///< for a conic: true if it depends on z
  bool is_high_degree;     ///< for a polynomial: true if its degree is three or four
  bool is_transcendental;  ///< true: slices are lines, and the constraint is no polynomial in z
};

/// Roles of the coordinates: outer coordinates, and the coordinates v and z of a slice.
struct CoordinateOrder {
  std::vector<std::size_t> outer;  ///< indices of the outer coordinates, the outermost first
  std::optional<std::size_t> v;    ///< index of the coordinate v; std::nullopt: slices are lines along z
  std::size_t z = 0;
  bool operator==(const CoordinateOrder&) const = default;
};

using CoordinateRanges = std::vector<std::optional<std::array<double, 2>>>;

struct SlicePlan {
  CoordinateOrder order;
  expression::Program program;  ///< stages: the design, each outer coordinate, v; and z if a surface is transcendental
  std::vector<Surface> surfaces;
  Formula formula;
  /// Registers of the constraints that do not depend on z, by the stage of the program that computes them. A constraint
  /// is satisfied if its value is >= 0.
  std::vector<std::vector<std::uint32_t>> independent;
  /// Program of the constraints that depend on v but not on z. Its outputs are, for each constraint, its value and its
  /// first and second derivative with respect to v; its stages are the design, each outer coordinate, and v.
  expression::Program limits;
  /// Program of the constraints in independent[1], which depend on no coordinate but the first. Its outputs are, for
  /// each constraint, its value and its derivative with respect to this coordinate; it has the same stages as
  /// `program`.
  expression::Program univariate;
  /// Registers of the lower and upper bound of each outer coordinate, of v and of z, in this order.
  std::vector<std::array<std::uint32_t, 2>> range;
  std::string why_not;  ///< reason why the slices have no closed form; "" if they have one
};

/// Plans the slices of a workspace for one order of the coordinates. If they have no closed form, SlicePlan::why_not is
/// not empty.
/// @param curves  true: if slices are lines, constraints may be transcendental functions of z
/// @param box     range of each coordinate that is searched; std::nullopt: the range of the model
SlicePlan plan_slices(const Evaluation& evaluation, std::size_t mode, const CoordinateOrder& order, bool curves,
                      const CoordinateRanges& box);

}  // namespace pkm::generic
