// Computes the data of the panel "Convergence": objectives of each stage over generations or solver evaluations,
// subsampled.
#include <cmath>
#include <limits>

#include "engine/math/statistics.hpp"
#include "engine/report/panels.hpp"
#include "engine/report/thinning.hpp"

namespace pkm {
namespace {

constexpr std::size_t kMaxGenerations = 1000;  // maximum number of generations shown of each stage
constexpr std::size_t kMaxEvaluations = 2000;  // maximum number of evaluations shown of each solver stage
constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

/// Best value of an objective so far: element i is the best feasible value among the first i rows; NaN if none of these
/// is feasible.
std::vector<double> running_best(const EvaluationTable& table, std::size_t objective, Direction direction) {
  std::vector<double> best(table.size() + 1, kUndefined);
  for (std::size_t row = 0; row < table.size(); ++row) {
    best[row + 1] = best[row];
    if (table.status[row] != Status::feasible) continue;
    const double value = table.objective_row(row)[objective];
    const bool improves = direction == Direction::maximise ? value > best[row] : value < best[row];
    if (improves || std::isnan(best[row])) best[row + 1] = value;
  }
  return best;
}

/// Values of one objective for each shown generation: the best so far, and median and quartiles over the feasible
/// designs of the population.
Json objective_curves(const StageRecord& stage, std::size_t objective, Direction direction, const Thinning& shown) {
  const std::vector<double> best = running_best(stage.table, objective, direction);
  std::vector<double> so_far, median, lower, upper;
  for (const std::size_t g : shown.indices) {
    std::vector<double> values;
    for (const std::int64_t row : stage.generations.population_of(g))
      if (const auto r = static_cast<std::size_t>(row); stage.table.status[r] == Status::feasible)
        values.push_back(stage.table.objective_row(r)[objective]);
    const std::vector<double> weights(values.size(), 1.0);
    const auto quantile = [&](double p) { return values.empty() ? kUndefined : weighted_quantile(weights, values, p); };
    so_far.push_back(best[stage.generations.end_of(g, stage.table.size())]);
    median.push_back(quantile(0.5));
    lower.push_back(quantile(0.25));
    upper.push_back(quantile(0.75));
  }
  return {{"best", so_far}, {"median", median}, {"lower", lower}, {"upper", upper}};
}

Json generations(const ProblemRecord& problem, const StageRecord& stage) {
  const Thinning shown(stage.generations.size(), kMaxGenerations);
  const auto at_shown = [&](const std::vector<double>& values) {
    Json list = Json::array();
    for (const std::size_t g : shown.indices) list.push_back(values[g]);
    return list;
  };
  std::vector<std::size_t> evaluations;
  for (const std::size_t g : shown.indices) evaluations.push_back(stage.generations.end_of(g, stage.table.size()));
  Json json = {{"total", stage.generations.size()},
               {"stride", shown.stride},
               {"numbers", shown.indices},
               {"evaluations", evaluations},
               {"objectives", Json::array()},
               {"feasible_share", at_shown(stage.generations.feasible_share)},
               {"diversity", at_shown(stage.generations.diversity)},
               {"seconds", at_shown(stage.generations.seconds)}};
  for (std::size_t k = 0; k < problem.objectives.size(); ++k)
    json["objectives"].push_back(objective_curves(stage, k, problem.objectives[k].direction, shown));
  if (stage.front && stage.front->hypervolume.size() == stage.generations.size()) {
    json["hypervolume"] = at_shown(stage.front->hypervolume);
    json["spread"] = at_shown(stage.front->spread);
    if (!stage.front->igd_plus.empty() && std::isfinite(stage.front->igd_plus.back()))
      json["igd_plus"] = at_shown(stage.front->igd_plus);
  }
  return json;
}

/// One evaluation: its number within the stage (from 1), its objectives, and whether it is feasible.
Json point_of(const StageRecord& stage, std::int64_t row) {
  const auto r = static_cast<std::size_t>(row);
  const auto values = stage.table.objective_row(r);
  return {{"evaluation", r + 1},
          {"objectives", std::vector<double>(values.begin(), values.end())},
          {"feasible", stage.table.status[r] == Status::feasible}};
}

/// The multistart runs of a solver stage: origin, first and final evaluation, stopping reason, KKT residual.
Json starts(const StageRecord& stage) {
  Json list = Json::array();
  for (const StartOutcome& start : stage.starts)
    list.push_back({{"origin", start.origin},
                    {"evaluations", start.rows},
                    {"begin", point_of(stage, start.first_row)},
                    {"end", point_of(stage, start.end_row)},
                    {"last_evaluation", start.first_row + start.rows},
                    {"stop", start.stop},
                    {"message", start.message},
                    {"optimality", start.optimality}});
  return list;
}

/// The evaluations of a solver stage, subsampled.
Json trace(const StageRecord& stage) {
  const Thinning shown(stage.table.size(), kMaxEvaluations);
  Json json = {{"total", stage.table.size()}, {"stride", shown.stride}, {"points", Json::array()}};
  for (const std::size_t row : shown.indices) json["points"].push_back(point_of(stage, static_cast<std::int64_t>(row)));
  return json;
}

}  // namespace

Json convergence_data(const StudyContents& contents) {
  if (contents.evaluations() == 0 || contents.problem.objectives.empty()) return {};
  Json list = Json::array();
  for (const StageRecord& stage : contents.stages) {
    if (stage.table.size() == 0) continue;
    Json json = {{"stage", &stage - contents.stages.data() + 1},
                 {"optimiser", stage.optimiser},
                 {"evaluations", stage.table.size()},
                 {"generations", generations(contents.problem, stage)}};
    if (!stage.starts.empty()) {
      json["starts"] = starts(stage);
      json["trace"] = trace(stage);
    }
    list.push_back(json);
  }
  return list;
}

}  // namespace pkm
