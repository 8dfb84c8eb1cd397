#include <cmath>
#include <limits>

#include "engine/math/statistics.hpp"
#include "engine/report/sections.hpp"
#include "engine/report/thinning.hpp"

namespace pkm {
namespace {

constexpr std::size_t kMostGenerations = 1000;
constexpr std::size_t kMostEvaluations = 2000;  // of a solver stage
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The best feasible value of an objective among the rows before each row; NaN while there is none.
std::vector<double> best_before(const EvaluationTable& table, std::size_t objective, Direction direction) {
  std::vector<double> best(table.size() + 1, kNone);
  for (std::size_t row = 0; row < table.size(); ++row) {
    best[row + 1] = best[row];
    if (table.status[row] != Status::feasible) continue;
    const double value = table.objective_row(row)[objective];
    const bool gains = direction == Direction::maximise ? value > best[row] : value < best[row];
    if (gains || std::isnan(best[row])) best[row + 1] = value;
  }
  return best;
}

/// One objective over the generations: the best so far, median and quartiles of the population's feasible designs.
Json objective_curves(const StageRecord& stage, std::size_t objective, Direction direction, const Thinning& shown) {
  const std::vector<double> best = best_before(stage.table, objective, direction);
  std::vector<double> so_far, median, lower, upper;
  for (const std::size_t g : shown.indices) {
    std::vector<double> values;
    for (const std::int64_t row : stage.generations.population_of(g))
      if (const auto r = static_cast<std::size_t>(row); stage.table.status[r] == Status::feasible)
        values.push_back(stage.table.objective_row(r)[objective]);
    const std::vector<double> equal(values.size(), 1.0);
    const auto quantile = [&](double p) { return values.empty() ? kNone : weighted_quantile(equal, values, p); };
    so_far.push_back(best[stage.generations.end_of(g, stage.table.size())]);
    median.push_back(quantile(0.5));
    lower.push_back(quantile(0.25));
    upper.push_back(quantile(0.75));
  }
  return {{"best", so_far}, {"median", median}, {"lower", lower}, {"upper", upper}};
}

Json generations(const ProblemRecord& problem, const StageRecord& stage) {
  const Thinning shown(stage.generations.size(), kMostGenerations);
  const auto pick = [&](const std::vector<double>& all) {
    Json list = Json::array();
    for (const std::size_t g : shown.indices) list.push_back(all[g]);
    return list;
  };
  std::vector<std::size_t> evaluations;
  for (const std::size_t g : shown.indices) evaluations.push_back(stage.generations.end_of(g, stage.table.size()));
  Json json = {{"all", stage.generations.size()},
               {"every", shown.every},
               {"number", shown.indices},
               {"evaluations", evaluations},
               {"objectives", Json::array()},
               {"feasible_share", pick(stage.generations.feasible_share)},
               {"diversity", pick(stage.generations.diversity)},
               {"seconds", pick(stage.generations.seconds)}};
  for (std::size_t k = 0; k < problem.objectives.size(); ++k)
    json["objectives"].push_back(objective_curves(stage, k, problem.objectives[k].direction, shown));
  if (stage.front && stage.front->hypervolume.size() == stage.generations.size()) {
    json["hypervolume"] = pick(stage.front->hypervolume);
    json["spread"] = pick(stage.front->spread);
    if (!stage.front->igd_plus.empty() && std::isfinite(stage.front->igd_plus.back()))
      json["igd_plus"] = pick(stage.front->igd_plus);
  }
  return json;
}

/// A row of the table as a point of the convergence: its place and its objectives.
Json point(const StageRecord& stage, std::int64_t row) {
  const auto r = static_cast<std::size_t>(row);
  const auto values = stage.table.objective_row(r);
  return {{"evaluation", r + 1},
          {"objectives", std::vector<double>(values.begin(), values.end())},
          {"feasible", stage.table.status[r] == Status::feasible}};
}

/// What a solver saw, evaluation by evaluation, and where its starts begin and end.
Json starts(const StageRecord& stage) {
  Json list = Json::array();
  for (const StartOutcome& start : stage.starts)
    list.push_back({{"origin", start.origin},
                    {"evaluations", start.rows},
                    {"begin", point(stage, start.first_row)},
                    {"end", point(stage, start.end_row)},
                    {"last", start.first_row + start.rows},
                    {"stop", start.stop},
                    {"message", start.message},
                    {"optimality", start.optimality}});
  return list;
}

Json evaluations(const StageRecord& stage) {
  const Thinning shown(stage.table.size(), kMostEvaluations);
  Json json = {{"all", stage.table.size()}, {"every", shown.every}, {"points", Json::array()}};
  for (const std::size_t row : shown.indices) json["points"].push_back(point(stage, static_cast<std::int64_t>(row)));
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
      json["trace"] = evaluations(stage);
    }
    list.push_back(json);
  }
  return list;
}

}  // namespace pkm
