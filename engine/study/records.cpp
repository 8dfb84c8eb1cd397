#include "engine/study/records.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/core/unit.hpp"
#include "engine/math/rounding.hpp"
#include "engine/optimisers/solvers/optimality.hpp"
#include "engine/problem/certain_volume.hpp"
#include "engine/study/machine.hpp"
#include "engine/study/stop_request.hpp"
#include "engine/survey/picture_plan.hpp"
#include "engine/survey/survey_set.hpp"

namespace pkm {
namespace {

/// @param certain  gap of bounds that its exact volume has to be within; none: nobody asks
DesignRecord evaluated(const DesignProblem& problem, std::span<const double> parameters,
                       std::optional<double> certain = {}) {
  DesignReport r = problem.report(parameters);
  std::optional<VolumeBounds> bounds;
  if (certain && r.status != Status::failed) try {
      bounds = check_volume(problem, r, *certain, [] { return StopRequest::signal() != 0; });
    } catch (const std::invalid_argument& reason) {
      r.status = Status::failed;
      r.reason = reason.what();
    }
  const bool box_matters = problem.parts().plan.box().has_value();  // the default box ends where the mechanism does
  return {.parameters = r.parameters,
          .objectives = r.objectives,
          .margins = r.margins,
          .reports = r.reports,
          .status = r.status,
          .reason = r.reason,
          .volume = r.survey.volume,
          .cells = r.survey.cells,
          .feasible_cells = r.survey.feasible_cells,
          .cell_volume = r.survey.cell_volume,
          .touches_box = box_matters && r.survey.touches_box,
          .certain = bounds};
}

/// Rounding may leave the bounds, or what the mechanism is defined for: said in `reason`, and in the latter case
/// nothing is evaluated.
DesignRecord evaluated_rounded(const DesignProblem& problem, const std::vector<double>& parameters,
                               std::optional<double> certain) {
  const ProblemParts& parts = problem.parts();
  if (const Refusal refusal = parts.mechanism->refuse(parameters)) {
    const auto nothing = [](std::size_t size) {
      return std::vector<double>(size, std::numeric_limits<double>::quiet_NaN());
    };
    return {.parameters = parameters,
            .objectives = nothing(problem.objectives().size()),
            .margins = nothing(problem.margins().size()),
            .reports = nothing(problem.reports().size()),
            .status = Status::failed,
            .reason = *refusal};
  }
  DesignRecord record = evaluated(problem, parameters, certain);
  for (std::size_t i = 0; i < parts.varies.size(); ++i) {
    const Variable& v = parts.space[i];
    const double value = parameters[parts.varies[i]], roundoff = 1e-12 * std::fabs(value);
    if (value >= v.lower - roundoff && value <= v.upper + roundoff) continue;
    record.reason +=
        (record.reason.empty() ? "" : "; ") + v.name + " = " + with_unit(value, v.unit) + " lies outside its bounds";
  }
  return record;
}

constexpr const char* kNoExactValues = "no exact values of the ";
constexpr const char* kWideBounds = "certain bounds of the ";

/// What a voxel study says of its designs on exact columns, where the mechanism has them and they know it.
class ExactValues {
 public:
  explicit ExactValues(const ProblemParts& parts) : parts_(parts) {
    if (!parts.plan.voxels() || !parts.mechanism->columns()) return;
    ColumnOptions columns;
    columns.tolerance = 1e-10;
    if (parts.mechanism->columns()->take_box()) columns.box = parts.plan.box();
    ProblemParts exact = parts;
    exact.plan.method = columns;
    try {
      problem_ = std::make_unique<const DesignProblem>(std::move(exact));
    } catch (const std::invalid_argument&) {
    }
  }

  /// @param name  of the design in the note that says why there are none
  std::optional<DesignRecord> of(const char* name, std::span<const double> parameters,
                                 std::vector<std::string>& notes) const {
    if (!problem_) return {};
    if (const Refusal poses = poses_beyond_box(parameters)) {
      notes.push_back(std::string(kNoExactValues) + name + ": columns of mechanism " + parts_.mechanism->info().name +
                      " cannot be cut by workspace.box, which has to hold all poses that the design may reach (" +
                      *poses + ")");
      return {};
    }
    DesignRecord record = evaluated(*problem_, parameters);
    forget_voxels(parts_.objectives, record.objectives);
    forget_voxels(parts_.reports, record.reports);
    return record;
  }

 private:
  /// Which poses a design may reach, where the box may leave some of them out that columns count.
  Refusal poses_beyond_box(std::span<const double> parameters) const {
    const std::optional<Box>& box = parts_.plan.box();
    if (!box || problem_->parts().plan.box()) return {};
    SurveyPlan plan = parts_.plan;
    plan.method = VoxelOptions{};  // a single cell, of a box that holds all
    VoxelMap all;
    try {
      all = voxel_map(*parts_.mechanism, parameters, plan);
    } catch (const std::exception& reason) {
      return reason.what();
    }
    const MechanismInfo& info = parts_.mechanism->info();
    const std::vector<int>& swept = sweep_of(info, parts_.plan).swept;
    std::vector<std::string> ranges;
    bool holds = true;
    for (std::size_t k = 0; k < swept.size(); ++k) {
      const double lower = all.lower[k], upper = all.upper[k];
      const double roundoff = 1e-12 * std::fmax(std::fabs(lower), std::fabs(upper));
      holds = holds && (*box)[k][0] <= lower + roundoff && (*box)[k][1] >= upper - roundoff;
      const AxisInfo& axis = info.coordinates[static_cast<std::size_t>(swept[k])];
      ranges.push_back(axis.name + " = " + shortest(lower) + " .. " + with_unit(upper, axis.unit));
    }
    return holds ? Refusal() : join(ranges);
  }

  /// Regions keep their own surveys: what is read from one on voxels is not exact.
  void forget_voxels(const std::vector<NamedQuantity>& quantities, std::vector<double>& values) const {
    for (std::size_t i = 0; i < quantities.size(); ++i)
      if (const NamedQuantity& q = quantities[i];
          q.reads_survey && q.survey > 0 && parts_.regions[q.survey - 1].plan.voxels())
        values[i] = std::numeric_limits<double>::quiet_NaN();
  }

  const ProblemParts& parts_;
  std::unique_ptr<const DesignProblem> problem_;
};

/// Cells of the map that a study by columns stores.
constexpr std::array<std::int64_t, 3> kMapCells = {32, 34, 60};

/// Sentences on bounds and constraints that hold the best design back.
std::vector<std::string> active_sentences(const DesignProblem& problem, const DesignRecord& best) {
  std::vector<std::string> sentences;
  const ProblemParts& parts = problem.parts();
  for (std::size_t i = 0; i < parts.varies.size(); ++i) {
    const Variable& v = parts.space[i];
    const double value = best.parameters[parts.varies[i]], near = 1e-6 * (v.upper - v.lower);
    if (value - v.lower <= near) sentences.push_back(v.name + " at its lower bound " + with_unit(v.lower, v.unit));
    if (v.upper - value <= near) sentences.push_back(v.name + " at its upper bound " + with_unit(v.upper, v.unit));
  }
  for (std::size_t i = 0; i < best.margins.size(); ++i) {
    const MarginInfo& m = problem.margins()[i];
    if (!(best.margins[i] <= 1e-4)) continue;
    char margin[32];
    std::snprintf(margin, sizeof margin, "%.3g", best.margins[i]);
    sentences.push_back(m.name + (best.margins[i] < 0 ? " is violated" : " is active") + ", margin " + margin +
                        (m.unit == "1" ? "" : " " + m.unit));
  }
  return sentences;
}

ProblemRecord problem_record(const Study& study) {
  const ProblemParts& parts = study.problem->parts();
  const MechanismInfo& info = parts.mechanism->info();
  ProblemRecord p;
  p.mechanism = info.name;
  for (std::size_t i = 0; i < info.parameters.size(); ++i)
    p.parameters.push_back({info.parameters[i].name, info.parameters[i].unit, parts.parameters[i], -1});
  for (std::size_t v = 0; v < parts.varies.size(); ++v)
    p.parameters[parts.varies[v]].variable = static_cast<std::int64_t>(v);
  p.variables = parts.space.variables();
  p.objectives = study.problem->objectives();
  p.margins = study.problem->margins();
  p.reports = study.problem->reports();
  return p;
}

}  // namespace

StudyContents new_contents(const Study& study) {
  StudyContents c;
  c.name = study.name;
  c.toml = study.text;
  c.toml_file = study.file_name;
  c.description = study.description;
  c.seed = study.seed;
  c.machine = describe_machine();
  c.created = c.updated = utc_now();
  c.problem = problem_record(study);
  return c;
}

Refusal text_against_record(const Study& study, const StudyContents& contents) {
  const ProblemRecord told = problem_record(study);
  const ProblemRecord& recorded = contents.problem;
  if (study.description.has_value() != contents.description.has_value())
    return std::string(study.description ? "a mechanism's file, and none" : "no file of a mechanism, and one");
  if (told.mechanism != recorded.mechanism) return told.mechanism + " as mechanism, and " + recorded.mechanism;
  const std::string variables = join(names_of(told.variables));
  if (const std::string other = join(names_of(recorded.variables)); variables != other)
    return "the variables " + variables + ", and " + other;
  if (contents.stages.size() > study.stages.size())
    return std::to_string(study.stages.size()) + " stages, and " + std::to_string(contents.stages.size());
  for (std::size_t s = 0; s < contents.stages.size(); ++s)
    if (study.stages[s].entry->name != contents.stages[s].optimiser)
      return "stage " + std::to_string(s + 1) + " by " + study.stages[s].entry->name + ", and by " +
             contents.stages[s].optimiser;
  for (const Extension& extension : contents.extensions)
    if (extension.stage < 0 || extension.stage >= static_cast<std::int64_t>(study.stages.size()))
      return std::to_string(study.stages.size()) + " stages, and a new limit of stage " +
             std::to_string(extension.stage + 1);
  return {};
}

ProblemRecord continued_problem(const Study& study, const ProblemRecord& begun) {
  ProblemRecord now = problem_record(study);
  for (const ParameterRecord& before : begun.parameters) {
    const ParameterRecord* const after = find_named(now.parameters, before.name);
    if (!after)
      throw std::invalid_argument("it has the parameter " + before.name + ", which this program's mechanism " +
                                  now.mechanism + " has not");
    if (after->value != before.value || after->unit != before.unit || after->variable != before.variable)
      throw std::invalid_argument("it was begun with " + before.name + " = " + with_unit(before.value, before.unit) +
                                  ", where this program takes " + with_unit(after->value, after->unit));
  }
  if (now.shape() != begun.shape())
    throw std::invalid_argument("this program gives other numbers of objectives, constraints or reports");
  return now;
}

std::vector<std::string> option_lines(const Options& options) {
  std::vector<std::string> lines;
  for (const auto& [name, value] : options.values()) lines.push_back(name + " = " + to_text(value));
  return lines;
}

double rounded_to(double value, double step) {
  // Dividing by a whole number rounds once; multiplying by a step such as 0.1, itself rounded, would round twice.
  const double per_unit = std::nearbyint(1 / step);
  if (per_unit >= 1 && std::fabs(1 / step - per_unit) <= 1e-9 * per_unit)
    return std::nearbyint(value * per_unit) / per_unit;
  return std::nearbyint(value / step) * step;
}

std::optional<OptimalityRecord> optimality_record(const Study& study, const StageRecord& stage) {
  const DesignProblem& problem = *study.problem;
  const auto row = static_cast<std::size_t>(stage.best_row);
  if (problem.objectives().size() != 1 || stage.best_row < 0 || stage.table.status[row] == Status::failed)
    return std::nullopt;
  const ProblemParts& parts = problem.parts();
  const auto design = stage.table.design(row);
  double at_start = 0;
  for (const StartOutcome& start : stage.starts)
    if (stage.best_row >= start.first_row && stage.best_row < start.first_row + start.rows)
      at_start = std::fabs(stage.table.objective_row(static_cast<std::size_t>(start.first_row))[0]);
  const Optimality found = optimality(problem, design, stage.table.slope_row(row), at_start);
  const bool maximise = problem.objectives()[0].direction == Direction::maximise;
  OptimalityRecord record;
  record.optimality = found.optimality;
  for (const ActiveMargin& m : found.margins) {
    const MarginInfo& info = problem.margins()[m.margin];
    record.active.push_back({info.name, "constraint", m.multiplier, info.unit});
  }
  for (const ActiveBound& b : found.bounds) {
    const Variable& v = parts.space[b.variable];
    record.active.push_back({v.name, b.upper ? "upper bound" : "lower bound", b.multiplier, v.unit});
  }

  // By every parameter: how the objective changes, and how the active margins do, which the variables then make up for.
  const std::size_t count = parts.parameters.size(), width = 1 + count;
  std::vector<std::size_t> all(count);
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::vector<double> slopes = problem.slopes(problem.parameters(design), all);
  const auto& parameters = parts.mechanism->info().parameters;
  for (std::size_t p = 0; p < count; ++p) {
    double follow = slopes[1 + p], steepest = 0;  // of the objective, by any parameter of this unit
    for (std::size_t other = 0; other < count; ++other)
      if (parameters[other].unit == parameters[p].unit) steepest = std::fmax(steepest, std::fabs(slopes[1 + other]));
    double greatest_term = steepest;
    for (const ActiveMargin& m : found.margins) {
      const double term =
          (maximise ? 1 : -1) * m.multiplier * slopes[(problem.objectives().size() + m.margin) * width + 1 + p];
      follow += term;
      greatest_term = std::fmax(greatest_term, std::fabs(term));
    }
    const bool varies = std::ranges::find(parts.varies, p) != parts.varies.end();
    record.sensitivities.push_back(
        {parameters[p].name, parameters[p].unit, beyond_rounding(slopes[1 + p], steepest),
         varies ? std::numeric_limits<double>::quiet_NaN() : beyond_rounding(follow, greatest_term)});
  }
  return record;
}

FinalRecord final_record(const Study& study, StudyContents& contents) {
  const DesignProblem& problem = *study.problem;
  const ProblemParts& parts = problem.parts();
  const MechanismInfo& info = parts.mechanism->info();
  std::erase_if(contents.notes, [](const std::string& note) {
    return note.starts_with(kNoExactValues) || note.starts_with(kWideBounds);
  });
  const ExactValues exact(parts);
  const std::optional<double> certain = parts.plan.columns() ? parts.plan.columns()->certain : std::nullopt;
  const auto note_gap = [&](const char* name, const std::optional<VolumeBounds>& bounds) {
    if (bounds && !bounds->stopped && bounds->gap() > *certain)
      contents.notes.push_back(kWideBounds + std::string(name) + " have the gap " + shortest(bounds->gap()) +
                               ", asked for " + shortest(*certain) + ": " + std::to_string(bounds->boxes) + " boxes");
  };
  FinalRecord f;
  f.volume_unit = volume_unit(info, parts.plan);
  if (study.baseline) {
    f.baseline = evaluated(problem, *study.baseline, certain);
    note_gap("baseline", f.baseline->certain);
    f.baseline_exact = exact.of("baseline", *study.baseline, contents.notes);
  }
  if (contents.best.row < 0) return f;
  const auto best = problem.parameters(contents.best_design());
  f.best = evaluated(problem, best, certain);
  note_gap("best design", f.best->certain);
  f.best_exact = exact.of("best design", best, contents.notes);
  f.active = active_sentences(problem, *f.best);
  if (study.round) {
    auto rounded = best;
    for (const std::size_t i : parts.varies) rounded[i] = rounded_to(best[i], *study.round);
    f.rounded = evaluated_rounded(problem, rounded, certain);
    note_gap("rounded design", f.rounded->certain);
  }
  MapRecord map;
  map.voxels = voxel_map(*parts.mechanism, best, picture_plan(info, parts.plan, kMapCells));
  for (const int swept : sweep_of(info, parts.plan).swept) {
    const AxisInfo& axis = info.coordinates[static_cast<std::size_t>(swept)];
    map.axes.push_back(axis.name);
    map.units.push_back(axis.unit);
  }
  map.axes.resize(3);  // an axis along which nothing is swept has no name
  map.units.resize(3, "1");
  f.map = std::move(map);
  return f;
}

}  // namespace pkm
