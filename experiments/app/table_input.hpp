// Tables of designs or poses whose rows a command computes: `evaluate --designs`, `pose --poses`.
#pragma once

#include <string>
#include <vector>

#include "engine/config/csv_columns.hpp"
#include "engine/core/stop.hpp"
#include "engine/core/team.hpp"
#include "engine/runner/stop_request.hpp"
#include "experiments/app/target.hpp"

namespace pkm {

/// A CSV file to read, and the file for the results.
struct TableJob : TableOutput {
  std::string input;
};

/// Throws ConfigError if an output file is given without an input table. @param option  option of the input:
/// "--designs"
void expect_table(const TableJob& job, const std::string& option);

/// Reads the table. Prints a note that names columns which are not read. Throws ConfigError if it has no rows or none
/// of the known columns.
/// @param needs_all  every known column is required
CsvColumns read_table(const TableJob& job, const std::vector<Assignable>& known, bool needs_all,
                      const std::string& program);

/// Calls compute(row) for all rows on `threads` threads, and returns the results. Ctrl-C stops the computation.
template <class Result, class Compute>
std::vector<Result> computed_rows(std::size_t rows, int threads, const Compute& compute) {
  const StopRequest request;
  const StopScope stop([] { return StopRequest::signal() != 0; });
  std::vector<Result> results(rows);
  with_team(threads, [&] {
    parallel_for(rows, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row) {
        check_stop();
        results[row] = compute(row);
      }
    });
  });
  return results;
}

/// Outputs the results: with --json one object per line, otherwise as CSV, and with -o into a file.
/// @param summary  printed if the table is written to a file: "2 of 3 designs are feasible"
void report_table(const TableJob& job, const CsvTable& table, std::vector<Json> objects, const std::string& summary,
                  Printout& out);

}  // namespace pkm
