#include "engine/problem/verdict.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <set>

#include "engine/core/printable.hpp"
#include "engine/problem/margin_tally.hpp"
#include "engine/problem/order.hpp"
#include "engine/survey/picture_plan.hpp"
#include "engine/survey/survey_set.hpp"

namespace pkm {
namespace {

constexpr std::int64_t kPoses = 9;  // along each swept coordinate; odd, so that the middle is among them
constexpr std::size_t kLongestLine = 1000;
constexpr std::size_t kMostSurveys = 16;  // of designs that seem to have an empty workspace

struct Row {
  const EvaluationTable* table = nullptr;
  std::size_t row = 0;
};

/// What is looked at.
struct Designs {
  const std::vector<const EvaluationTable*>& tables;
  const std::vector<ObjectiveInfo>& objectives;
  const std::vector<MarginInfo>& margins;
  const DesignProblem* problem;

  template <class Do>
  void for_each(const Do& action) const {
    for (const EvaluationTable* table : tables)
      for (std::size_t row = 0; row < table->size(); ++row) action(Row{table, row});
  }
  std::vector<double> parameters(const Row& at) const { return problem->parameters(at.table->design(at.row)); }
};

Status status_of(const Row& at) { return at.table->status[at.row]; }

/// How many designs ended in each way.
std::array<std::size_t, 4> counts(const Designs& designs) {
  std::array<std::size_t, 4> count{};
  designs.for_each([&](const Row& at) { ++count[static_cast<std::size_t>(status_of(at))]; });
  return count;
}

/// Whether an objective of a feasible design has the value that it has for an empty workspace. Objectives that do not
/// depend on the workspace never do.
bool has_empty_value(const Designs& designs, const Row& at, std::size_t objective) {
  const double value = at.table->objective_row(at.row)[objective];
  if (!designs.problem) return value == 0;
  const ProblemParts& parts = designs.problem->parts();
  const NamedQuantity& q = parts.objectives[objective];
  if (!q.reads_survey) return false;
  const Survey<double> empty;
  Scratch scratch;
  const std::vector<double> parameters = designs.parameters(at);
  return value == q.quantity->value({*parts.mechanism, parameters, &empty, scratch});
}

/// Whether every workspace that the objectives of a design read is empty.
bool has_empty_workspace(const Designs& designs, const Row& at) {
  const std::vector<double> parameters = designs.parameters(at);
  std::set<std::size_t> surveys;
  for (const NamedQuantity& q : designs.problem->parts().objectives) surveys.insert(q.survey);
  return std::ranges::all_of(
      surveys, [&](std::size_t survey) { return designs.problem->workspace(parameters, survey).volume == 0; });
}

/// A feasible design counts unless every objective has the value of an empty workspace and the workspace is empty. Only
/// kMostSurveys of the designs with such values are surveyed again: a value like that of a workspace that is not empty
/// takes a formula that hides it, such as max(0, volume - 1), or a constant.
bool something_found(const Designs& designs) {
  std::size_t surveys_left = kMostSurveys;
  for (const EvaluationTable* table : designs.tables)
    for (std::size_t row = 0; row < table->size(); ++row) {
      if (table->status[row] != Status::feasible) continue;
      if (designs.objectives.empty()) return true;
      for (std::size_t i = 0; i < designs.objectives.size(); ++i)
        if (!has_empty_value(designs, {table, row}, i)) return true;
      if (!designs.problem || surveys_left == 0) continue;
      --surveys_left;
      if (!has_empty_workspace(designs, {table, row})) return true;
    }
  return false;
}

Row least_bad(const Designs& designs) {
  Row best;
  Ranked rank;
  designs.for_each([&](const Row& at) {
    const Ranked here = ranked(designs.objectives, *at.table, at.row);
    if (best.table && !better(here, rank)) return;
    best = at;
    rank = here;
  });
  return best;
}

/// Poses over what the workspace of a design could fill if there were no limits, or over the study's box.
std::vector<Pose<double>> poses_of(const DesignProblem& problem, const std::vector<double>& parameters) {
  const ProblemParts& parts = problem.parts();
  const MechanismInfo& info = parts.mechanism->info();
  SurveyPlan plan = picture_plan(info, parts.plan, {1, 1, 1});
  const Sweep& sweep = sweep_of(info, plan);
  auto& cells = std::get<VoxelOptions>(plan.method).cells;
  cells = {1, 1, 1};
  plan.limits = no_limits(info);
  const VoxelMap map = voxel_map(*parts.mechanism, parameters, plan);
  std::vector<Pose<double>> poses = {Pose<double>(info.coordinates.size())};
  for (const int held : sweep.held)
    poses[0][static_cast<std::size_t>(held)] = held_value(*parts.mechanism, parameters, plan, held);
  for (std::size_t axis = 0; axis < sweep.swept.size(); ++axis) {
    std::vector<Pose<double>> more;
    for (const Pose<double>& pose : poses)
      for (std::int64_t k = 0; k < kPoses; ++k) {
        const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(kPoses);
        more.push_back(pose);
        more.back()[static_cast<std::size_t>(sweep.swept[axis])] =
            map.lower[axis] + share * (map.upper[axis] - map.lower[axis]);
      }
    poses = std::move(more);
  }
  return poses;
}

/// What empties the workspace of a design; nothing where the mechanism does not say where poses could be.
std::vector<Reason> limits_that_empty(const DesignProblem& problem, const std::vector<double>& parameters) {
  const ProblemParts& parts = problem.parts();
  const std::string& asked = parts.demand.mode;
  const std::string& mode = asked.empty() ? parts.mechanism->info().modes.front() : asked;
  MarginTally tally;
  try {
    for (const Pose<double>& pose : poses_of(problem, parameters))
      tally.add(parts.mechanism->inspect(parameters, pose, mode, parts.plan.limits).margins);
  } catch (const std::invalid_argument&) {
    return {};
  }
  return tally.reasons("limit", "pose of the least bad design");
}

std::vector<Reason> broken_constraints(const Designs& designs) {
  MarginTally tally;
  std::vector<std::pair<std::string, double>> margins;
  designs.for_each([&](const Row& at) {
    margins.clear();
    for (std::size_t i = 0; i < designs.margins.size(); ++i)
      margins.emplace_back(designs.margins[i].name, at.table->margin_row(at.row)[i]);
    tally.add(margins);
  });
  return tally.reasons("constraint", "design");
}

Reason failure(const Designs& designs, std::size_t failed, std::size_t all) {
  Reason reason{"failure", {}, std::to_string(failed) + " of " + std::to_string(all) + " could not be evaluated"};
  Row first;
  designs.for_each([&](const Row& at) {
    if (!first.table && status_of(at) == Status::failed) first = at;
  });
  if (!designs.problem) return reason;
  const std::string why = designs.problem->report(designs.parameters(first)).reason;
  if (!why.empty()) reason.sentence += "; the first: " + why;
  return reason;
}

/// Of the designs, by how they ended: "30 infeasible, 10 rejected".
std::string counted(const std::array<std::size_t, 4>& count) {
  constexpr std::array<const char*, 4> kWords = {"feasible", "infeasible", "rejected", "failed"};
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < count.size(); ++k)
    if (count[k] > 0) parts.push_back(std::to_string(count[k]) + " " + kWords[k]);
  return join(parts);
}

/// "volume is 0 for each of the 40 feasible designs".
std::string empty_objectives(const Designs& designs, std::size_t feasible) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < designs.objectives.size(); ++i) {
    bool zero = true;
    designs.for_each([&](const Row& at) {
      zero = zero && (status_of(at) != Status::feasible || at.table->objective_row(at.row)[i] == 0);
    });
    parts.push_back(designs.objectives[i].name + (zero ? " is 0" : " is what an empty workspace gives"));
  }
  return join(parts, " and ") + " for each of the " + std::to_string(feasible) + " feasible designs";
}

}  // namespace

std::optional<Verdict> verdict_on(const std::vector<const EvaluationTable*>& tables,
                                  const std::vector<ObjectiveInfo>& objectives, const std::vector<MarginInfo>& margins,
                                  const DesignProblem* problem) {
  const Designs designs{tables, objectives, margins, problem};
  const Row least = least_bad(designs);
  if (!least.table || something_found(designs)) return {};
  const auto count = counts(designs);
  const std::size_t feasible = count[0], failed = count[3], all = count[0] + count[1] + count[2] + count[3];
  Verdict verdict;
  verdict.finding = feasible > 0 ? "nothing found" : "nothing feasible";
  verdict.sentence = feasible > 0 ? empty_objectives(designs, feasible)
                                  : "none of " + std::to_string(all) + " designs is feasible: " + counted(count);
  const auto add = [&](std::vector<Reason> reasons) {
    std::ranges::move(reasons, std::back_inserter(verdict.reasons));
  };
  if (problem) add(contradictions(problem->parts()));
  if (feasible == 0) add(broken_constraints(designs));
  if (failed > 0) add({failure(designs, failed, all)});
  if (problem && status_of(least) != Status::failed && problem->report(designs.parameters(least)).survey.volume == 0)
    add(limits_that_empty(*problem, designs.parameters(least)));
  return verdict;
}

std::string one_line(const Verdict& verdict) {
  std::string line = verdict.finding + ": " + verdict.sentence;
  for (const Reason& reason : verdict.reasons) line += "; " + reason.sentence;
  return excerpt(line, kLongestLine);
}

}  // namespace pkm
