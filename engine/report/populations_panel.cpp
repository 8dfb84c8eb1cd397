// Computes the data of the panel "Populations": the designs of each generation or multistart run, subsampled.
#include <algorithm>
#include <numeric>

#include "engine/report/packed_array.hpp"
#include "engine/report/panels.hpp"
#include "engine/report/thinning.hpp"

namespace pkm {
namespace {

// In this file, a step is a generation, or a multistart run of a solver. Its members are the designs of the population,
// or those that the run evaluated.
constexpr std::size_t kMaxSteps = 101;    // maximum number of steps shown of each stage
constexpr std::size_t kMaxMembers = 200;  // maximum number of members shown of each step

/// The steps of one stage that are shown.
struct ShownSteps {
  std::vector<std::int64_t> rows;  ///< rows of the stage's table that are members of a shown step, ascending
  Json steps = Json::array();
  std::size_t stride = 1;  ///< every stride-th step is shown
  bool members_thinned = false;
};

/// Rows of the stage's table that are members of its k-th step.
std::vector<std::int64_t> step_rows(const StageRecord& stage, std::size_t k) {
  if (stage.starts.empty()) {
    const auto population = stage.generations.population_of(k);
    return {population.begin(), population.end()};
  }
  std::vector<std::int64_t> rows(static_cast<std::size_t>(stage.starts[k].rows));
  std::iota(rows.begin(), rows.end(), stage.starts[k].first_row);
  return rows;
}

std::size_t step_count(const StageRecord& stage) {
  return stage.starts.empty() ? stage.generations.size() : stage.starts.size();
}

/// Chooses the steps of a stage that are shown, and the shown members of each.
/// @param offset  number of shown designs of earlier stages, because members are numbered over all stages
ShownSteps subsample_steps(const StageRecord& stage, std::int64_t offset) {
  ShownSteps shown;
  const Thinning steps(step_count(stage), kMaxSteps);
  shown.stride = steps.stride;
  std::vector<std::vector<std::int64_t>> members;
  for (const std::size_t k : steps.indices) {
    const std::vector<std::int64_t> all = step_rows(stage, k);
    const Thinning chosen(all.size(), kMaxMembers);
    shown.members_thinned = shown.members_thinned || chosen.stride > 1;
    auto& rows = members.emplace_back();
    for (const std::size_t i : chosen.indices) rows.push_back(all[i]);
    shown.rows.insert(shown.rows.end(), rows.begin(), rows.end());
  }
  std::sort(shown.rows.begin(), shown.rows.end());
  shown.rows.erase(std::unique(shown.rows.begin(), shown.rows.end()), shown.rows.end());
  for (std::size_t k = 0; k < members.size(); ++k) {
    for (std::int64_t& row : members[k])
      row = offset + (std::lower_bound(shown.rows.begin(), shown.rows.end(), row) - shown.rows.begin());
    shown.steps.push_back({{"number", steps.indices[k]},
                           {"size", step_rows(stage, steps.indices[k]).size()},
                           {"members", packed_integers(members[k])}});
  }
  return shown;
}

}  // namespace

Json populations_data(const StudyContents& contents) {
  const ProblemRecord& problem = contents.problem;
  const std::size_t width =
      problem.variables.size() + problem.objectives.size() + problem.margins.size() + problem.reports.size();
  std::vector<std::vector<double>> columns(width);
  std::vector<std::int64_t> evaluation;
  std::vector<std::uint8_t> status;
  Json stages = Json::array();
  for (const StageRecord& stage : contents.stages) {
    if (step_count(stage) == 0) continue;
    const ShownSteps shown = subsample_steps(stage, static_cast<std::int64_t>(evaluation.size()));
    for (const std::int64_t row : shown.rows) {
      const auto r = static_cast<std::size_t>(row);
      std::size_t column = 0;
      for (const auto& values : {std::span<const double>(stage.table.design(r)), stage.table.objective_row(r),
                                 stage.table.margin_row(r), stage.table.output_row(r)})
        for (const double value : values) columns[column++].push_back(value);
      evaluation.push_back(row + 1);
      status.push_back(static_cast<std::uint8_t>(stage.table.status[r]));
    }
    stages.push_back({{"stage", &stage - contents.stages.data() + 1},
                      {"optimiser", stage.optimiser},
                      {"starts", !stage.starts.empty()},
                      {"total", step_count(stage)},
                      {"stride", shown.stride},
                      {"members_thinned", shown.members_thinned},
                      {"steps", shown.steps}});
  }
  if (evaluation.empty()) return {};
  Json packed = Json::array();
  for (const auto& column : columns) packed.push_back(packed_floats(column));
  return {{"stages", stages},
          {"columns", packed},
          {"evaluation", packed_integers(evaluation)},
          {"status", packed_bytes(status)}};
}

}  // namespace pkm
