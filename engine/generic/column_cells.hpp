// Which cells of columns a quadratic condition holds in: columns side by side, cells counted, not tested.
#pragma once

#include <array>
#include <cstddef>

#include "engine/core/instruction_set.hpp"
#include "engine/expression/batch_stage.hpp"

namespace pkm::generic {

/// Cells of a column: cell t has its centre at first + t step.
struct ColumnGrid {
  double first, step, cells;
};

/// What is known of a condition's leading coefficient: it is 0, a number < 0, a number > 0, or anything.
enum class Shape { line, concave, convex, any };

/// c[0] + c[1] z + c[2] z^2 >= 0, or `unless` >= 0, which is the same all along a column.
struct ColumnCondition {
  Shape shape = Shape::any;
  std::array<expression::Operand, 3> c{};
  bool has_unless = false;
  expression::Operand unless{};
};

/// By column, whole numbers: cells [from, to) without those of the hole, [hole_from, hole_to).
struct CellRanges {
  alignas(64) std::array<double, expression::kRow> from, to, hole_from, hole_to;
};

/// Narrows `from` and `to` to where a condition holds, for `count` columns, whole lanes; a condition that is undefined
/// holds nowhere. True where a hole is left inside of some column's range: then holes are set, in all columns; holes of
/// conditions that cannot have any stay as they are.
/// @param registers, rows  as expression::BatchStage has them
template <InstructionSet set>
bool narrow(const ColumnCondition& condition, const double* registers, const double* rows, const ColumnGrid& grid,
            std::size_t count, CellRanges& ranges);

}  // namespace pkm::generic
