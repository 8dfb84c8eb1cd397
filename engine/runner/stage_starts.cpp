#include "engine/runner/stage_starts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "engine/problem/front.hpp"
#include "engine/problem/ranking.hpp"

namespace pkm {
namespace {

/// basins() estimates the basins of attraction from at most this number of best evaluations.
constexpr std::size_t kMaxCandidates = 4000;

StartDesign best_so_far(const Study& study, const StudyContents& contents) {
  if (contents.best.row < 0)
    return {baseline_or_centre(study), study.baseline ? "the baseline" : "the middle of the ranges"};
  const auto design = contents.best_design();
  return {{design.begin(), design.end()}, "best of stage " + std::to_string(contents.best.stage + 1)};
}

/// Estimates basins of attraction: the evaluations that have no better evaluation in their neighbourhood, from best to
/// worst. The neighbourhood is a box that extends by `radius` in each variable, relative to the variable's range.
/// @param limit  maximum number of returned designs
std::vector<StartDesign> basins(const StudyContents& contents, std::size_t limit, double radius) {
  struct Candidate {
    RankKey rank;
    std::size_t stage;
    std::vector<double> unit;
  };
  const DesignSpace space(contents.problem.variables);
  std::vector<Candidate> candidates;
  for (std::size_t s = 0; s < contents.stages.size(); ++s) {
    const EvaluationTable& table = contents.stages[s].table;
    for (std::size_t row = 0; row < table.size(); ++row)
      if (table.status[row] != Status::failed)
        candidates.push_back({ranked(contents.problem.objectives, table, row), s, {}});
  }
  const auto by_rank = [](const Candidate& a, const Candidate& b) {
    if (better(a.rank, b.rank) || better(b.rank, a.rank)) return better(a.rank, b.rank);
    return std::pair(a.stage, a.rank.row) < std::pair(b.stage, b.rank.row);
  };
  std::sort(candidates.begin(), candidates.end(), by_rank);
  candidates.resize(std::min(candidates.size(), kMaxCandidates));
  std::vector<StartDesign> found;
  for (std::size_t i = 0; i < candidates.size() && found.size() < limit; ++i) {
    const auto design =
        contents.stages[candidates[i].stage].table.design(static_cast<std::size_t>(candidates[i].rank.row));
    for (std::size_t v = 0; v < design.size(); ++v) candidates[i].unit.push_back(space.to_unit(v, design[v]));
    const auto is_near = [&](const Candidate& other) {
      for (std::size_t v = 0; v < design.size(); ++v)
        if (std::fabs(other.unit[v] - candidates[i].unit[v]) > radius) return false;
      return true;
    };
    if (std::any_of(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(i), is_near)) continue;
    found.push_back(
        {{design.begin(), design.end()},
         "basin " + std::to_string(found.size() + 1) + ", from stage " + std::to_string(candidates[i].stage + 1)});
  }
  return found;
}

/// The last stage that has found a Pareto front; null if there is none.
const StageRecord* stage_with_front(const StudyContents& contents) {
  const auto found =
      std::find_if(contents.stages.rbegin(), contents.stages.rend(), std::mem_fn(&StageRecord::has_front));
  return found == contents.stages.rend() ? nullptr : &*found;
}

/// At most `limit` points spread over the last Pareto front; none if there is no front.
std::vector<StartDesign> front_points(const StudyContents& contents, std::size_t limit) {
  const StageRecord* const stage = stage_with_front(contents);
  if (!stage) return {};
  const std::string number = std::to_string(stage - contents.stages.data() + 1);
  std::vector<StartDesign> starts;
  for (const std::size_t point :
       select_representatives(scores_of(contents.problem.objectives, stage->table, stage->front->rows), limit)) {
    const auto design = stage->table.design(static_cast<std::size_t>(stage->front->rows[point]));
    starts.push_back(
        {{design.begin(), design.end()}, "point " + std::to_string(point + 1) + " of the front of stage " + number});
  }
  return starts;
}

/// Adds the designs that the option `designs` gives. Variables that a design does not name have their values in `base`.
void add_given_designs(const DesignSpace& space, const Options& options, const std::vector<double>& base,
                       std::vector<StartDesign>& starts) {
  if (!options.has("designs")) return;
  int number = 0;
  for (const NamedNumbers& given : options.list("designs")) {
    StartDesign design{base, "given design " + std::to_string(++number)};
    for (std::size_t v = 0; v < space.dimension(); ++v)
      if (const auto value = given.find(space[v].name); value != given.end()) design.design[v] = value->second;
    starts.push_back(std::move(design));
  }
}

}  // namespace

PreviousFront previous_front(const Study& study, const StudyContents& contents) {
  const auto& objectives = study.problem->objectives();
  if (objectives.size() < 2) return {};
  PreviousFront known{std::vector<double>(objectives.size(), 1.0), {}};
  Scores scores{objectives.size()};
  if (const StageRecord* const stage = stage_with_front(contents)) {
    scores = scores_of(objectives, stage->table, stage->front->rows);
    known.reference = stage->front->reference;
  } else if (contents.best.row >= 0) {
    scores = scores_of(objectives, contents.best_stage().table, std::array{contents.best.row});
  }
  const Ranges extent = ranges_of(scores);
  for (std::size_t k = 0; k < extent.minimum.size(); ++k) {
    // An objective that is constant over the front is scaled by its magnitude.
    const double size = extent.range(k) > 0 ? extent.range(k) : std::fabs(extent.minimum[k]);
    if (std::isfinite(size) && size > 0) known.extents[k] = size;
  }
  return known;
}

std::vector<StartDesign> start_designs(const Study& study, const Stage& stage, const StudyContents& contents) {
  const StartDesign first = best_so_far(study, contents);
  if (contents.best.row < 0) return first_start_designs(study.problem->space(), stage, first, study.starts);
  if (!stage.entry->capabilities(stage.options).starts) return {first};
  const Options& options = stage.options;
  std::vector<StartDesign> starts;
  const std::string& start = options.word("start");
  if (start == "best-of-basins")
    starts = basins(contents, static_cast<std::size_t>(options.integer("starts")), options.number("basin_radius"));
  else if (start == "pareto")
    starts = front_points(contents, static_cast<std::size_t>(options.integer("starts")));
  if (starts.empty() && (start == "best" || start == "pareto")) starts = {first};
  add_given_designs(study.problem->space(), options, baseline_or_centre(study), starts);
  return starts;
}

std::vector<StartDesign> first_start_designs(const DesignSpace& space, const Stage& stage, const StartDesign& base,
                                             const std::vector<StartDesign>& given) {
  const Capabilities can = stage.entry->capabilities(stage.options);
  const Options& options = stage.options;
  std::vector<StartDesign> starts = given;
  if (can.starts && options.word("start") == "none")
    starts.clear();
  else if (starts.empty() && (can.starts || can.min_objectives == 0))
    starts = {base};
  if (can.starts) {
    const bool several = options.word("start") == "best-of-basins";
    starts.resize(std::min(starts.size(), several ? static_cast<std::size_t>(options.integer("starts")) : 1));
    add_given_designs(space, options, base.design, starts);
  }
  return starts;
}

std::vector<double> baseline_or_centre(const Study& study) {
  const ProblemParts& parts = study.problem->parts();
  std::vector<double> design;
  for (std::size_t v = 0; v < parts.space.dimension(); ++v)
    design.push_back(study.baseline ? parts.space.nearest(v, (*study.baseline)[parts.varies[v]])
                                    : parts.space.from_unit(v, 0.5));
  return design;
}

std::vector<StartDesign> distinct_best_designs(const StudyContents& contents, std::size_t limit) {
  constexpr double kRadius = 0.02;
  std::vector<StartDesign> designs = front_points(contents, limit);
  return designs.empty() ? basins(contents, limit, kRadius) : designs;
}

}  // namespace pkm
