#include <algorithm>
#include <numeric>

#include "engine/report/packed.hpp"
#include "engine/report/sections.hpp"
#include "engine/report/thinning.hpp"

namespace pkm {
namespace {

constexpr std::size_t kMostSteps = 101;    // of a stage
constexpr std::size_t kMostMembers = 200;  // of a step

/// What the page gets of one stage: some of its steps, some members of each, and the rows that these are.
struct Shown {
  std::vector<std::int64_t> rows;  ///< of the stage's table, rising
  Json steps = Json::array();
  std::size_t every = 1;
  bool members_thinned = false;
};

/// Which rows the k-th step has: a generation's population, or all that a solver saw from its k-th start.
std::vector<std::int64_t> rows_of_step(const StageRecord& stage, std::size_t k) {
  if (stage.starts.empty()) {
    const auto population = stage.generations.population_of(k);
    return {population.begin(), population.end()};
  }
  std::vector<std::int64_t> rows(static_cast<std::size_t>(stage.starts[k].rows));
  std::iota(rows.begin(), rows.end(), stage.starts[k].first_row);
  return rows;
}

std::size_t steps_of(const StageRecord& stage) {
  return stage.starts.empty() ? stage.generations.size() : stage.starts.size();
}

Shown choose(const StageRecord& stage, std::int64_t first_kept) {
  Shown shown;
  const Thinning steps(steps_of(stage), kMostSteps);
  shown.every = steps.every;
  std::vector<std::vector<std::int64_t>> members;
  for (const std::size_t k : steps.indices) {
    const std::vector<std::int64_t> all = rows_of_step(stage, k);
    const Thinning chosen(all.size(), kMostMembers);
    shown.members_thinned = shown.members_thinned || chosen.every > 1;
    auto& rows = members.emplace_back();
    for (const std::size_t i : chosen.indices) rows.push_back(all[i]);
    shown.rows.insert(shown.rows.end(), rows.begin(), rows.end());
  }
  std::sort(shown.rows.begin(), shown.rows.end());
  shown.rows.erase(std::unique(shown.rows.begin(), shown.rows.end()), shown.rows.end());
  for (std::size_t k = 0; k < members.size(); ++k) {
    for (std::int64_t& row : members[k])
      row = first_kept + (std::lower_bound(shown.rows.begin(), shown.rows.end(), row) - shown.rows.begin());
    shown.steps.push_back({{"number", steps.indices[k]},
                           {"size", rows_of_step(stage, steps.indices[k]).size()},
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
    if (steps_of(stage) == 0) continue;
    const Shown shown = choose(stage, static_cast<std::int64_t>(evaluation.size()));
    for (const std::int64_t row : shown.rows) {
      const auto r = static_cast<std::size_t>(row);
      std::size_t column = 0;
      for (const auto& values : {std::span<const double>(stage.table.design(r)), stage.table.objective_row(r),
                                 stage.table.margin_row(r), stage.table.report_row(r)})
        for (const double value : values) columns[column++].push_back(value);
      evaluation.push_back(row + 1);
      status.push_back(static_cast<std::uint8_t>(stage.table.status[r]));
    }
    stages.push_back({{"stage", &stage - contents.stages.data() + 1},
                      {"optimiser", stage.optimiser},
                      {"starts", !stage.starts.empty()},
                      {"all", steps_of(stage)},
                      {"every", shown.every},
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
