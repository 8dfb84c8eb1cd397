// Computes the data of the panel "Sweeps": all designs of the stages that are parameter sweeps.
#include <algorithm>

#include "engine/report/packed_array.hpp"
#include "engine/report/panels.hpp"

namespace pkm {
namespace {

constexpr std::size_t kMaxDesigns = 100'000;  // maximum number of designs of a stage; more would make the page slow

/// The values of each variable in a sweep, ascending.
std::vector<std::vector<double>> levels_of(const EvaluationTable& table) {
  std::vector<std::vector<double>> levels(table.shape().variables);
  for (std::size_t row = 0; row < table.size(); ++row)
    for (std::size_t v = 0; v < levels.size(); ++v) levels[v].push_back(table.design(row)[v]);
  for (auto& values : levels) {
    std::ranges::sort(values);
    values.erase(std::unique(values.begin(), values.end()), values.end());
  }
  return levels;
}

/// Returns true if the rows of the table are the combinations of all levels, with the last variable varying fastest.
/// The sweep may have been stopped before the last combination.
bool is_full_factorial(const EvaluationTable& table, const std::vector<std::vector<double>>& levels) {
  for (std::size_t row = 0; row < table.size(); ++row) {
    std::size_t quotient = row;
    for (std::size_t v = levels.size(); v-- > 0; quotient /= levels[v].size())
      if (table.design(row)[v] != levels[v][quotient % levels[v].size()]) return false;
  }
  return true;
}

Json packed_columns(const EvaluationTable& table) {
  std::vector<std::vector<double>> columns;
  for (std::size_t row = 0; row < table.size(); ++row) {
    std::size_t column = 0;
    for (const auto& values :
         {table.design(row), table.objective_row(row), table.margin_row(row), table.output_row(row)})
      for (const double value : values) {
        if (row == 0) columns.emplace_back();
        columns[column++].push_back(value);
      }
  }
  Json packed = Json::array();
  for (const auto& column : columns) packed.push_back(packed_floats(column));
  return packed;
}

}  // namespace

Json sweeps_data(const StudyContents& contents) {
  Json sweeps = Json::array();
  for (const StageRecord& stage : contents.stages) {
    if (stage.optimiser != "sweep" || stage.table.size() == 0) continue;
    Json sweep = {{"stage", &stage - contents.stages.data() + 1}, {"designs", stage.table.size()}};
    if (stage.table.size() <= kMaxDesigns) {
      const auto levels = levels_of(stage.table);
      sweep["full_factorial"] = is_full_factorial(stage.table, levels);
      sweep["levels"] = Json::array();
      for (const auto& values : levels) sweep["levels"].push_back(packed_floats(values));
      sweep["columns"] = packed_columns(stage.table);
      std::vector<std::uint8_t> status;
      for (const Status each : stage.table.status) status.push_back(static_cast<std::uint8_t>(each));
      sweep["status"] = packed_bytes(status);
      sweep["first_rows"] = packed_integers(stage.generations.first_row);
    }
    sweeps.push_back(sweep);
  }
  return sweeps.empty() ? Json() : sweeps;
}

}  // namespace pkm
