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

/// The CSV file that a command reads, and the file that it writes.
struct TableJob : TableOutput {
  std::string input;
};

/// Throws ConfigError if a file for the results is given without an input table.
/// @param option  name of the option that gives the input table: "--designs" or "--poses"
void expect_table(const TableJob& job, const std::string& option);

/// Reads the table, and prints a note with the names of columns that are not used. Throws ConfigError if it has no rows
/// or none of the known columns.
/// @param needs_all  true: every known column must be present
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

/// Outputs the results: with --json as one object per line, otherwise as CSV; with -o into a file.
/// @param summary  text that is printed if the results are written to a file: "2 of 3 designs are feasible"
void report_table(const TableJob& job, const CsvTable& table, std::vector<Json> objects, const std::string& summary,
                  Printout& out);

}  // namespace pkm
