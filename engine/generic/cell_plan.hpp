// Plan for testing the cells of a voxel grid in one working mode: loop-invariant code motion of the constraints into
// three nested loops, and constraints that are quadratic along the innermost loop, whose roots are the ends of columns.
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

/// Stages of CellPlan::program, one for each loop. Stage 0 does not depend on the swept coordinates.
inline constexpr std::size_t kOuter = 1, kMiddle = 2, kInner = 3;

/// Plan of the test of voxels. The object is immutable, so that threads can share it. All operands and registers are
/// those of `program`.
struct CellPlan {
  using Registers = std::vector<std::uint32_t>;
  using Disjunction = std::vector<ColumnConstraint>;  ///< at least one of these constraints has to be satisfied

  /// The range of a crank (limbs::CrankRange), as constraints that are quadratic along the innermost loop.
  struct Crank {
    ColumnConstraint at_min, at_max, after_min, before_max;
    /// Registers of CrankRange::half_turn (>= 0 if the range is at most half a revolution) and CrankRange::reach (>= 0
    /// if the limb reaches the pose).
    std::uint32_t half_turn, reach;
    /// true: of the two crank angles at which the limb assembles, the smaller one is the joint coordinate; false: the
    /// greater one.
    bool is_first;
  };

  /// @param swept  index of the swept coordinate of each axis of the grid
  /// @param order  indices of the axes, from the outermost loop to the innermost one
  CellPlan(const Evaluation& evaluation, const std::vector<int>& swept, std::vector<std::size_t> order,
           std::size_t mode);
  /// The plan with the order of loops that has the shortest estimated time for a grid with the given numbers of cells.
  static CellPlan fastest(const Evaluation& evaluation, const std::vector<int>& swept,
                          const std::array<std::int64_t, 3>& cells, std::size_t mode);

  std::vector<std::size_t> order;
  expression::Program program;
  /// Registers of the constraints that are tested once per iteration of the outer, middle and inner loop. Constraints
  /// that depend on no swept coordinate are in `outer_constraints`.
  Registers outer_constraints, middle_constraints, inner_constraints;
  Registers passed_to_inner;  ///< registers that the inner loop reads and the middle loop computes
  /// Constraints that bound the columns; linear ones, which are the cheapest, come first.
  std::vector<ColumnConstraint> columns;
  std::vector<Disjunction> disjunctions;
  std::vector<Crank> cranks;
  std::optional<expression::BatchStage> middle, inner;

 private:
  /// Assigns each constraint to the loop that tests it, and prepares the SIMD batches of the middle and inner loop.
  /// @param count  number of constraints; they are the first outputs of the program
  void set_loops(std::size_t count);
  double cost(const std::array<std::int64_t, 3>& cells) const;
};

}  // namespace pkm::generic
