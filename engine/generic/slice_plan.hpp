// Constraints of a workspace in slices: in planes (v, z) at given outer coordinates as conics whose coefficients a
// program computes, or in lines along z as polynomials of degree at most four or as transcendental functions.
#pragma once

#include <string>

#include "engine/expression/program.hpp"
#include "engine/generic/evaluation.hpp"
#include "engine/generic/surface_signs.hpp"

namespace pkm::generic {

/// A constraint surface in a slice: a conic or a polynomial, given by the registers of its coefficients.
struct Surface {
  /// Coefficients of 1, v, z, v^2, v z, z^2; without v of 1, z, z^2, z^3, z^4. Transcendental: f(z) and its derivative,
  /// which the last stage of the program computes.
  std::array<std::uint32_t, 6> coefficients;
  bool has_z;              ///< for a conic: it depends on z
  bool is_high_degree;     ///< for a polynomial: its degree is three or four
  bool is_transcendental;  ///< for a line: the constraint is no polynomial in z
};

/// Roles of the coordinates.
struct CoordinateOrder {
  std::vector<std::size_t> outer;  ///< outer coordinates, the outermost first
  std::optional<std::size_t> v;    ///< std::nullopt: slices are lines
  std::size_t z = 0;
};

using CoordinateRanges = std::vector<std::optional<std::array<double, 2>>>;

struct SlicePlan {
  CoordinateOrder order;
  expression::Program program;  ///< stages: the design, each outer coordinate, v; z if a surface is transcendental
  std::vector<Surface> surfaces;
  Formula formula;
  std::vector<std::vector<std::uint32_t>>
      independent;  ///< constraints independent of the inner coordinates, by stage: registers, >= 0 if satisfied
  /// Constraints independent of z alone: outputs are the value, its derivative and its second derivative with respect
  /// to v, of each; stages are the design, each outer coordinate, v.
  expression::Program limits;
  /// The constraints independent[1], which depend on a single coordinate: outputs are the value and its derivative with
  /// respect to it, of each; stages are those of `program`.
  expression::Program univariate;
  std::vector<std::array<std::uint32_t, 2>> range;  ///< registers of the bounds of each outer coordinate, v and z
  std::string why_not;                              ///< why the slices have no closed form; "" if they have
};

/// Plans the slices of a workspace for one order of the coordinates. If they have no closed form, SlicePlan::why_not is
/// not empty.
/// @param curves  whether transcendental constraints are allowed in lines
/// @param box     range of each coordinate; std::nullopt: the range of the model
SlicePlan plan_slices(const Evaluation& evaluation, std::size_t mode, const CoordinateOrder& order, bool curves,
                      const CoordinateRanges& box);

}  // namespace pkm::generic
