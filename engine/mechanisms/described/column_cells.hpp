// Which cells of columns a quadratic condition holds in: columns side by side, cells counted, not tested.
#pragma once

#include <array>
#include <cstddef>

#include "engine/core/instruction_set.hpp"
#include "engine/graph/rows.hpp"

namespace pkm::described {

/// Cells of a column: cell t has its centre at first + t step.
struct ColumnGrid {
  double first, step, cells;
};

/// What is known of a condition's leading coefficient.
enum class Shape { line, concave, any };

/// By column: cells [from, to) without [drop_from, drop_to), whole numbers. Lines and concave conditions drop none.
struct CellRanges {
  std::array<double, graph::kRow> from, to, drop_from, drop_to;
};

/// Narrows `from` and `to` to where c[0] + c[1] z + c[2] z^2 >= 0 and, of Shape::any, sets what is to be dropped, for
/// `count` columns, whole lanes. A condition that is undefined holds nowhere.
/// @param registers, rows  as graph::RowStage has them
template <InstructionSet set>
void narrow(Shape shape, const std::array<graph::Operand, 3>& c, const double* registers, const double* rows,
            const ColumnGrid& grid, std::size_t count, CellRanges& ranges);

}  // namespace pkm::described
