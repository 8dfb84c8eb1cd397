// What holds in sections of a described workspace: planes (v, z) at fixed outer coordinates, as conics in v and z whose
// coefficients a program computes; or in lines along z, as polynomials of degree four or less, or as whatever formulas
// say.
#pragma once

#include <string>

#include "engine/expression/program.hpp"
#include "engine/generic/columns/formula.hpp"
#include "engine/generic/evaluation.hpp"

namespace pkm::generic {

/// A conic of the section, or a polynomial, by its registers; what is the same in every section and place is a number.
struct Surface {
  /// Of 1, v, z, v^2, v z, z^2; without v of 1, z, z^2, z^3, z^4. Of a curve: f(z) and its derivative, which the
  /// program's last stage computes.
  std::array<std::uint32_t, 6> coefficients;
  bool has_z;     ///< of a conic
  bool is_steep;  ///< of a polynomial: of degree three or four
  bool is_curve;  ///< no polynomial
};

/// Which coordinates are what.
struct SectionOrder {
  std::vector<std::size_t> outer;  ///< coordinates, the outermost first
  std::optional<std::size_t> v;    ///< none: sections are lines
  std::size_t z = 0;
};

using Ranges = std::vector<std::optional<std::array<double, 2>>>;

struct SectionPlan {
  SectionOrder order;
  expression::Program program;  ///< stages: the design, each outer coordinate, v; where there are curves z
  std::vector<Surface> surfaces;
  Formula formula;
  std::vector<std::vector<std::uint32_t>> plain;    ///< by stage: registers, >= 0 where it holds
  std::vector<std::array<std::uint32_t, 2>> range;  ///< registers: of each outer coordinate, of v and z
  std::string why_not;                              ///< not "": these sections have no closed form
};

/// @param curves  whether lines may be bounded by what is no polynomial
/// @param box     by coordinate; where it says nothing, the model's own is taken
SectionPlan plan_sections(const Evaluation& evaluation, std::size_t mode, const SectionOrder& order, bool curves,
                          const Ranges& box);

}  // namespace pkm::generic
