#include "engine/problem/diagnosis.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <set>

#include "engine/core/printable.hpp"
#include "engine/problem/margin_tally.hpp"
#include "engine/problem/ranking.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "engine/workspace/visualisation_plan.hpp"

namespace pkm {
namespace {

// Number of poses along each swept coordinate; it is odd, so that the midpoint is included.
constexpr std::int64_t kPosesPerAxis = 9;
constexpr std::size_t kMaxLineLength = 1000;
constexpr std::size_t kMaxAnalyses =
    16;  // maximum number of repeated analyses of designs that seem to have an empty workspace

struct TableRow {
  const EvaluationTable* table = nullptr;
  std::size_t row = 0;
};

/// The designs to diagnose, with the data of their problem.
struct Designs {
  const std::vector<const EvaluationTable*>& tables;
  const std::vector<ObjectiveInfo>& objectives;
  const std::vector<MarginInfo>& margins;
  const DesignProblem* problem;

  template <class Do>
  void for_each(const Do& action) const {
    for (const EvaluationTable* table : tables)
      for (std::size_t row = 0; row < table->size(); ++row) action(TableRow{table, row});
  }
  std::vector<double> parameters(const TableRow& at) const { return problem->parameters(at.table->design(at.row)); }
};

Status status_of(const TableRow& at) { return at.table->status[at.row]; }

/// Number of designs of each status.
std::array<std::size_t, 4> count_by_status(const Designs& designs) {
  std::array<std::size_t, 4> count{};
  designs.for_each([&](const TableRow& at) { ++count[static_cast<std::size_t>(status_of(at))]; });
  return count;
}

/// Whether an objective of a feasible design equals its value for an empty workspace. False for objectives that do not
/// use the workspace.
bool has_empty_value(const Designs& designs, const TableRow& at, std::size_t objective) {
  const double value = at.table->objective_row(at.row)[objective];
  if (!designs.problem) return value == 0;
  const ProblemParts& parts = designs.problem->parts();
  const NamedQuantity& q = parts.objectives[objective];
  if (!q.uses_analysis_of_design()) return false;
  const WorkspaceResult<double> empty;
  Scratch scratch;
  const std::vector<double> parameters = designs.parameters(at);
  return value == q.quantity->value({*parts.mechanism, parameters, &empty, scratch});
}

/// Whether all workspaces that the objectives of a design use are empty.
bool has_empty_workspace(const Designs& designs, const TableRow& at) {
  const std::vector<double> parameters = designs.parameters(at);
  std::set<std::size_t> analyses;
  for (const NamedQuantity& q : designs.problem->parts().objectives) analyses.insert(q.analysis);
  return std::ranges::all_of(
      analyses, [&](std::size_t analysis) { return designs.problem->workspace(parameters, analysis).volume == 0; });
}

/// True if at least one feasible design is useful. A design is useless if its workspace is empty and all objectives
/// have the values of an empty workspace. The workspace analysis is repeated for at most kMaxAnalyses designs with such
/// objective values: a design with a non-empty workspace has such values only with special formulas, such as max(0,
/// volume - 1) or a constant.
bool has_useful_design(const Designs& designs) {
  std::size_t analyses_left = kMaxAnalyses;
  for (const EvaluationTable* table : designs.tables)
    for (std::size_t row = 0; row < table->size(); ++row) {
      if (table->status[row] != Status::feasible) continue;
      if (designs.objectives.empty()) return true;
      for (std::size_t i = 0; i < designs.objectives.size(); ++i)
        if (!has_empty_value(designs, {table, row}, i)) return true;
      if (!designs.problem || analyses_left == 0) continue;
      --analyses_left;
      if (!has_empty_workspace(designs, {table, row})) return true;
    }
  return false;
}

/// The best design according to better(); its `table` is null if there are no designs.
TableRow best_ranked(const Designs& designs) {
  TableRow best;
  RankKey rank;
  designs.for_each([&](const TableRow& at) {
    const RankKey here = ranked(designs.objectives, *at.table, at.row);
    if (best.table && !better(here, rank)) return;
    best = at;
    rank = here;
  });
  return best;
}

/// Regular grid of poses over the box of the study, or over the box that bounds the workspace of a design without
/// limits.
std::vector<Pose<double>> poses_of(const DesignProblem& problem, const std::vector<double>& parameters) {
  const ProblemParts& parts = problem.of(parameters).parts();
  const MechanismInfo& info = parts.mechanism->info();
  WorkspacePlan plan = visualisation_plan(info, parts.plan, {1, 1, 1});
  const Sweep& sweep = sweep_of(info, plan);
  auto& cells = std::get<VoxelOptions>(plan.method).cells;
  cells = {1, 1, 1};
  plan.limits = no_limits(info);
  plan.home.reset();
  const VoxelMap map = voxel_map(*parts.mechanism, parameters, plan);
  std::vector<Pose<double>> poses = {Pose<double>(info.coordinates.size())};
  for (const int fixed : sweep.fixed)
    poses[0][static_cast<std::size_t>(fixed)] = fixed_value(*parts.mechanism, parameters, plan, fixed);
  for (std::size_t axis = 0; axis < sweep.swept.size(); ++axis) {
    std::vector<Pose<double>> more;
    for (const Pose<double>& pose : poses)
      for (std::int64_t k = 0; k < kPosesPerAxis; ++k) {
        const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(kPosesPerAxis);
        more.push_back(pose);
        more.back()[static_cast<std::size_t>(sweep.swept[axis])] =
            map.lower[axis] + share * (map.upper[axis] - map.lower[axis]);
      }
    poses = std::move(more);
  }
  return poses;
}

/// The limits that make the workspace of a design empty, found on a grid of poses. There are no reasons if the
/// mechanism defines no box of poses.
std::vector<Reason> limits_of_empty_workspace(const DesignProblem& problem, const std::vector<double>& parameters) {
  const ProblemParts& parts = problem.of(parameters).parts();
  const std::string& requested = parts.request.mode;
  const std::string& mode = requested.empty() ? parts.mechanism->info().modes.front() : requested;
  MarginTally tally;
  try {
    for (const Pose<double>& pose : poses_of(problem, parameters))
      tally.add(parts.mechanism->inspect(parameters, pose, mode, parts.plan.limits).margins);
  } catch (const std::invalid_argument&) {
    return {};
  }
  return tally.reasons("limit", "pose sampled for the best-ranked design");
}

std::vector<Reason> violated_constraints(const Designs& designs) {
  MarginTally tally;
  std::vector<std::pair<std::string, double>> margins;
  designs.for_each([&](const TableRow& at) {
    margins.clear();
    for (std::size_t i = 0; i < designs.margins.size(); ++i)
      margins.emplace_back(designs.margins[i].name, at.table->margin_row(at.row)[i]);
    tally.add(margins);
  });
  return tally.reasons("constraint", "design");
}

Reason reason_of_failures(const Designs& designs, std::size_t failed, std::size_t all) {
  Reason reason{
      "failure", {}, std::to_string(failed) + " of " + std::to_string(all) + " designs could not be evaluated"};
  TableRow first;
  designs.for_each([&](const TableRow& at) {
    if (!first.table && status_of(at) == Status::failed) first = at;
  });
  if (!designs.problem) return reason;
  const std::string why = designs.problem->report(designs.parameters(first)).reason;
  if (!why.empty()) reason.sentence += "; the first: " + why;
  return reason;
}

/// Text with the number of designs of each status: "30 infeasible, 10 rejected".
std::string counts_text(const std::array<std::size_t, 4>& count) {
  constexpr std::array<const char*, 4> kWords = {"feasible", "infeasible", "rejected", "failed"};
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < count.size(); ++k)
    if (count[k] > 0) parts.push_back(std::to_string(count[k]) + " " + kWords[k]);
  return join(parts);
}

/// Sentence such as "volume is 0 for each of the 40 feasible designs".
std::string empty_objectives_text(const Designs& designs, std::size_t feasible) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < designs.objectives.size(); ++i) {
    bool zero = true;
    designs.for_each([&](const TableRow& at) {
      zero = zero && (status_of(at) != Status::feasible || at.table->objective_row(at.row)[i] == 0);
    });
    parts.push_back(designs.objectives[i].name + (zero ? " is 0" : " has the value of an empty workspace"));
  }
  return join(parts, " and ") + " for each of the " + std::to_string(feasible) + " feasible designs";
}

}  // namespace

std::optional<Diagnosis> diagnose(const std::vector<const EvaluationTable*>& tables,
                                  const std::vector<ObjectiveInfo>& objectives, const std::vector<MarginInfo>& margins,
                                  const DesignProblem* problem) {
  const Designs designs{tables, objectives, margins, problem};
  const TableRow best = best_ranked(designs);
  if (!best.table || has_useful_design(designs)) return {};
  const auto count = count_by_status(designs);
  const std::size_t feasible = count[0], failed = count[3], all = count[0] + count[1] + count[2] + count[3];
  Diagnosis diagnosis;
  diagnosis.finding = feasible > 0 ? "nothing found" : "nothing feasible";
  diagnosis.sentence = feasible > 0 ? empty_objectives_text(designs, feasible)
                                    : "none of " + std::to_string(all) + " designs is feasible: " + counts_text(count);
  const auto add = [&](std::vector<Reason> reasons) {
    std::ranges::move(reasons, std::back_inserter(diagnosis.reasons));
  };
  if (problem) add(contradictions(problem->parts()));
  if (feasible == 0) add(violated_constraints(designs));
  if (failed > 0) add({reason_of_failures(designs, failed, all)});
  if (problem && status_of(best) != Status::failed && problem->report(designs.parameters(best)).workspace.volume == 0)
    add(limits_of_empty_workspace(*problem, designs.parameters(best)));
  return diagnosis;
}

std::string one_line_summary(const Diagnosis& diagnosis) {
  std::string line = diagnosis.finding + ": " + diagnosis.sentence;
  for (const Reason& reason : diagnosis.reasons) line += "; " + reason.sentence;
  return excerpt(line, kMaxLineLength);
}

}  // namespace pkm
