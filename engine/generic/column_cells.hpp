// Feasible cells of columns under a quadratic constraint, in closed form: the constraint's roots bound a range of
// cells, or a hole in it. Columns are processed in SIMD batches; no cell is tested.
#pragma once

#include <array>
#include <cstddef>

#include "engine/core/instruction_set.hpp"
#include "engine/expression/batch_stage.hpp"

namespace pkm::generic {

/// Cells of a column: cell t = 0, ..., cells - 1 has its centre at the coordinate first + t step.
struct ColumnGrid {
  double first, step, cells;
};

/// Sign of the leading coefficient c[2] of a quadratic: linear if it is always 0, concave if it is a negative constant,
/// convex if it is a positive constant, any if it varies.
enum class Shape { linear, concave, convex, any };

/// The constraint c[0] + c[1] z + c[2] z^2 >= 0 along the innermost coordinate z. If has_alternative, a point is also
/// feasible where `alternative`, which does not depend on z, is >= 0.
struct ColumnConstraint {
  Shape shape = Shape::any;
  std::array<expression::Operand, 3> c{};
  bool has_alternative = false;
  expression::Operand alternative{};
};

/// Feasible cells of each column: cells from, ..., to - 1 except hole_from, ..., hole_to - 1. All values are whole
/// numbers.
struct CellRanges {
  alignas(64) std::array<double, expression::kRow> from, to, hole_from, hole_to;
};

/// Contracts the ranges of `count` columns to the cells in which the constraint is satisfied; a constraint that is
/// undefined counts as violated. If the constraint can have holes (convex, any), the holes of all columns are
/// overwritten; otherwise they are left unchanged.
/// @param count            a multiple of kLanes
/// @param registers, rows  values of operands: one number for all columns, or a row with one number per column
/// @return true if a column has a hole inside its range
template <InstructionSet set>
bool contract(const ColumnConstraint& constraint, const double* registers, const double* rows, const ColumnGrid& grid,
              std::size_t count, CellRanges& ranges);

}  // namespace pkm::generic
