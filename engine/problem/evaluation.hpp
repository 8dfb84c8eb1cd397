// What is known of evaluated designs: one table, column by column, that optimisers fill, that the study file stores and
// that a resumed run reads back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pkm {

/// Outcome of one evaluation. The order is the order of preference between designs (see `better`).
enum class Status : std::uint8_t {
  feasible = 0,    ///< every margin >= 0
  infeasible = 1,  ///< evaluated, at least one margin < 0
  rejected = 2,    ///< a design-level margin < 0: objectives and survey margins were not computed (NaN)
  failed = 3,      ///< no usable number came out (NaN or an exception)
};

/// How much an optimiser needs to know of a design.
enum class Detail : std::uint8_t {
  enough,       ///< a design that breaks a design-level margin needs no more
  complete,     ///< objectives and all margins, whatever holds
  derivatives,  ///< and the slopes of all of them
};

/// How many numbers belong to one evaluation.
struct EvaluationShape {
  std::size_t variables = 0;
  std::size_t objectives = 0;
  std::size_t margins = 0;
  std::size_t reports = 0;
  Detail detail = Detail::enough;
  bool operator==(const EvaluationShape&) const = default;

  /// Slopes of one evaluation: per objective, then per margin, a smooth value and its derivatives by each variable.
  std::size_t slopes() const { return detail == Detail::derivatives ? (objectives + margins) * (1 + variables) : 0; }
};

/// Where one evaluation's results go. Objectives in their own unit and direction (nothing is negated here).
struct EvaluationSlot {
  std::span<double> objectives;
  std::span<double> margins;  ///< >= 0 holds
  std::span<double> reports;
  Status& status;
  Detail detail = Detail::enough;
  std::span<double> slopes = {};  ///< Detail::derivatives only, see EvaluationShape::slopes
};

/// Evaluations in the order in which they were asked for. Row r of each array belongs to evaluation r.
class EvaluationTable {
  template <class Vector>
  static auto part(Vector& v, std::size_t row, std::size_t width) {
    return std::span{v.data() + row * width, width};
  }

 public:
  EvaluationTable() = default;
  explicit EvaluationTable(EvaluationShape shape) : shape_(shape) {}

  const EvaluationShape& shape() const { return shape_; }
  std::size_t size() const { return status.size(); }

  /// Adds `count` rows (designs zero, results NaN, status failed) and returns the first one's index.
  std::size_t extend(std::size_t count);
  /// Forgets all rows but the first `rows`.
  void truncate(std::size_t rows) { resize(rows); }
  /// Adds a copy of a row of a table of the same shape, and returns its index.
  std::size_t append(const EvaluationTable& from, std::size_t row);
  /// Copies of rows [first, end).
  EvaluationTable slice(std::size_t first, std::size_t end) const;
  /// Makes the results of a row, and its time, those of a row of a table of the same shape.
  void copy_results(std::size_t row, const EvaluationTable& from, std::size_t source);

  std::span<double> design(std::size_t row) { return {&designs[row * shape_.variables], shape_.variables}; }
  std::span<const double> design(std::size_t row) const { return {&designs[row * shape_.variables], shape_.variables}; }
  std::span<const double> objective_row(std::size_t row) const { return part(objectives, row, shape_.objectives); }
  std::span<const double> margin_row(std::size_t row) const { return part(margins, row, shape_.margins); }
  std::span<const double> report_row(std::size_t row) const { return part(reports, row, shape_.reports); }
  std::span<const double> slope_row(std::size_t row) const { return part(slopes, row, shape_.slopes()); }
  EvaluationSlot slot(std::size_t row) {
    return {part(objectives, row, shape_.objectives),
            part(margins, row, shape_.margins),
            part(reports, row, shape_.reports),
            status[row],
            shape_.detail,
            part(slopes, row, shape_.slopes())};
  }

  std::vector<double> designs;     ///< rows x variables
  std::vector<double> objectives;  ///< rows x objectives
  std::vector<double> margins;     ///< rows x margins
  std::vector<double> reports;     ///< rows x reports
  std::vector<double> slopes;      ///< rows x shape().slopes()
  std::vector<Status> status;      ///< rows
  std::vector<float> seconds;      ///< rows; evaluation time, not part of what must repeat

 private:
  void resize(std::size_t rows);

  EvaluationShape shape_;
};

}  // namespace pkm
