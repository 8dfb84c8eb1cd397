// How the cells of a grid are tested for one working mode: which conditions in which of three nested loops, and which
// of them end the columns of the innermost loop in closed form.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/expression/batch_stage.hpp"
#include "engine/expression/program.hpp"
#include "engine/generic/column_cells.hpp"
#include "engine/generic/evaluation.hpp"

namespace pkm::generic {

/// Stages of the program: its loops. Stage 0 is what no swept coordinate changes.
inline constexpr std::size_t kOuter = 1, kMiddle = 2, kInner = 3;

struct CellPlan {
  using Registers = std::vector<std::uint32_t>;
  using Alternatives = std::vector<ColumnCondition>;  ///< one of them has to hold

  /// limbs::CrankRange
  struct Crank {
    ColumnCondition at_min, at_max, after_min, before_max;
    std::uint32_t half_turn, reach;  ///< registers
    bool is_first;                   ///< the joint is the first of the two angles that assemble
  };

  /// @param swept  axes of the grid: their coordinates
  /// @param order  axes from the outermost loop to the innermost
  CellPlan(const Evaluation& evaluation, const std::vector<int>& swept, std::vector<std::size_t> order,
           std::size_t mode);
  /// In the order in which a grid of these cells is estimated to take the least time.
  static CellPlan fastest(const Evaluation& evaluation, const std::vector<int>& swept,
                          const std::array<std::int64_t, 3>& cells, std::size_t mode);

  std::vector<std::size_t> order;  ///< axes
  expression::Program program;
  Registers early, of_middle, of_inner;  ///< conditions: of the outer loop and before it, of the other two
  Registers handed_down;                 ///< what the inner loop reads of the middle one
  std::vector<ColumnCondition> columns;  ///< lines first, which cost least
  std::vector<Alternatives> alternatives;
  std::vector<Crank> cranks;
  std::optional<expression::BatchStage> middle, inner;

 private:
  /// Shares the conditions out among the loops.
  /// @param count  of the program's first outputs, which they are
  void set_loops(std::size_t count);
  double cost(const std::array<std::int64_t, 3>& cells) const;
};

}  // namespace pkm::generic
