// Table of evaluated designs, stored by columns (structure of arrays). Optimisers append rows, the study file stores
// them, and a resumed run reads them back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pkm {

/// Outcome of one evaluation, from best to worst: designs are ranked by it first (see `better`).
enum class Status : std::uint8_t {
  feasible = 0,    ///< every margin >= 0
  infeasible = 1,  ///< evaluated, at least one margin < 0
  rejected = 2,    ///< a design-level margin < 0; with Detail::enough all later values are NaN (not computed)
  failed = 3,      ///< the evaluation threw, or a value is not finite
};

/// How much of a design is evaluated.
enum class Detail : std::uint8_t {
  enough,       ///< the evaluation may end at a violated constraint that depends on the design alone
  complete,     ///< all objectives and margins, whether or not constraints are violated
  derivatives,  ///< all objectives and margins with their derivatives
};

/// Number of values of one evaluation, by kind.
struct EvaluationShape {
  std::size_t variables = 0;
  std::size_t objectives = 0;
  std::size_t margins = 0;
  std::size_t reports = 0;
  Detail detail = Detail::enough;
  bool operator==(const EvaluationShape&) const = default;

  /// Number of derivative values. For each objective, then for each margin, there are 1 + variables numbers: the value
  /// of the smooth approximation and its derivative with respect to each variable.
  std::size_t derivatives() const {
    return detail == Detail::derivatives ? (objectives + margins) * (1 + variables) : 0;
  }
};

/// Destination of the results of one evaluation. Objectives keep their unit and direction (no sign change).
struct EvaluationSlot {
  std::span<double> objectives;
  std::span<double> margins;  ///< values of the constraints; a constraint is satisfied if its value is >= 0
  std::span<double> reports;
  Status& status;
  Detail detail = Detail::enough;
  std::span<double> derivatives = {};  ///< with Detail::derivatives only: layout of EvaluationShape::derivatives
};

/// Evaluations in the order of their requests. Row r of each array belongs to evaluation r.
class EvaluationTable {
  template <class Vector>
  static auto row_of(Vector& v, std::size_t row, std::size_t width) {
    return std::span{v.data() + row * width, width};
  }

 public:
  EvaluationTable() = default;
  explicit EvaluationTable(EvaluationShape shape) : shape_(shape) {}

  const EvaluationShape& shape() const { return shape_; }
  std::size_t size() const { return status.size(); }

  /// Adds `count` rows (designs zero, results NaN, status failed) and returns the first one's index.
  std::size_t extend(std::size_t count);
  /// Removes all but the first `rows` rows.
  void truncate(std::size_t rows) { resize(rows); }
  /// Appends a copy of one row of a table of the same shape and returns its index.
  std::size_t append(const EvaluationTable& from, std::size_t row);
  /// Copies of rows [first, end).
  EvaluationTable slice(std::size_t first, std::size_t end) const;
  /// Copies the results and the time of row `source` of a table of the same shape into row `row`.
  void copy_results(std::size_t row, const EvaluationTable& from, std::size_t source);

  std::span<double> design(std::size_t row) { return {&designs[row * shape_.variables], shape_.variables}; }
  std::span<const double> design(std::size_t row) const { return {&designs[row * shape_.variables], shape_.variables}; }
  std::span<const double> objective_row(std::size_t row) const { return row_of(objectives, row, shape_.objectives); }
  std::span<const double> margin_row(std::size_t row) const { return row_of(margins, row, shape_.margins); }
  std::span<const double> output_row(std::size_t row) const { return row_of(reports, row, shape_.reports); }
  std::span<const double> derivative_row(std::size_t row) const {
    return row_of(derivatives, row, shape_.derivatives());
  }
  EvaluationSlot slot(std::size_t row) {
    return {row_of(objectives, row, shape_.objectives),
            row_of(margins, row, shape_.margins),
            row_of(reports, row, shape_.reports),
            status[row],
            shape_.detail,
            row_of(derivatives, row, shape_.derivatives())};
  }

  std::vector<double> designs;      ///< rows x variables
  std::vector<double> objectives;   ///< rows x objectives
  std::vector<double> margins;      ///< rows x margins
  std::vector<double> reports;      ///< rows x reports
  std::vector<double> derivatives;  ///< rows x shape().derivatives()
  std::vector<Status> status;       ///< status of each row
  std::vector<float> seconds;       ///< evaluation time of each row [s]; excluded from reproducibility checks

 private:
  void resize(std::size_t rows);

  EvaluationShape shape_;
};

}  // namespace pkm
