// Schema of the study file: path, unit and description of every item. Private to engine/storage.
//
// One function, describe(), visits all members of StudyContents (visitor pattern). Its argument determines the
// direction: ImageWriter stores each item, ImageReader loads it, so that writer and reader cannot disagree. Items that
// are visited only if !Archive::kReads are redundant; they are written for other programs and never read back.
#pragma once

#include <string>
#include <vector>

#include "engine/problem/front.hpp"
#include "engine/storage/schema_fields.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm::schema {

template <class Archive, class Study>
void describe_problem(Archive& archive, Study& study) {
  auto& problem = study.problem;
  archive.group("/problem", "The optimisation problem");
  archive.attribute("/problem", "mechanism", problem.mechanism);
  visit_records(archive, "/problem/parameters", "All parameters of the mechanism, in its order", problem.parameters,
                Field{"name", &ParameterRecord::name, "1", "Name"},
                Field{"unit", &ParameterRecord::unit, "1", "SI unit"},
                Field{"value", &ParameterRecord::value, "see unit", "Fixed value; nominal value of a variable"},
                Field{"variable", &ParameterRecord::variable, "1", "Index into variables; -1: fixed"});
  visit_records(archive, "/problem/variables", "Design variables: the columns of every design", problem.variables,
                Field{"name", &Variable::name, "1", "Name of the parameter"},
                Field{"unit", &Variable::unit, "1", "SI unit"},
                Field{"lower", &Variable::lower, "see unit", "Lower bound"},
                Field{"upper", &Variable::upper, "see unit", "Upper bound"},
                Field{"step", &Variable::step, "see unit", "Increment between allowed values; 0: continuous"});
  if (visit_optional(archive, "/problem/choices", problem.choices))
    visit_records(archive, "/problem/choices",
                  "Names of the values 1, 2, .. of variables that are choices from catalogues", *problem.choices,
                  Field{"variable", &ChoiceName::variable, "1", "Index into variables"},
                  Field{"name", &ChoiceName::name, "1", "Name of the value"});
  visit_records(archive, "/problem/objectives", "Objectives: the columns of every objective", problem.objectives,
                Field{"name", &ObjectiveInfo::name, "1", "Name"}, Field{"unit", &ObjectiveInfo::unit, "1", "Unit"},
                Field{"meaning", &ObjectiveInfo::meaning, "1", "Meaning"},
                Field{"direction", &ObjectiveInfo::direction, "1", "minimise or maximise"});
  visit_records(archive, "/problem/margins", "Constraints: the columns of every margin; satisfied if margin >= 0",
                problem.margins, Field{"name", &MarginInfo::name, "1", "Name"},
                Field{"unit", &MarginInfo::unit, "1", "Unit"}, Field{"meaning", &MarginInfo::meaning, "1", "Meaning"});
  visit_records(archive, "/problem/reports", "Outputs, computed but not optimised: the columns of every report",
                problem.reports, Field{"name", &OutputInfo::name, "1", "Name"},
                Field{"unit", &OutputInfo::unit, "1", "Unit"}, Field{"meaning", &OutputInfo::meaning, "1", "Meaning"});
}

/// Names and units of the columns of the dataset `slope`: "workspace-ratio", "d workspace-ratio / d a", ...
template <class Problem>
std::vector<OutputInfo> slope_columns(const Problem& problem) {
  std::vector<OutputInfo> columns;
  const auto add = [&](const auto& quantity) {
    columns.push_back({quantity.name, quantity.unit, ""});
    for (const Variable& v : problem.variables)
      columns.push_back({"d " + quantity.name + " / d " + v.name, "(" + quantity.unit + ")/(" + v.unit + ")", ""});
  };
  std::ranges::for_each(problem.objectives, add);
  std::ranges::for_each(problem.margins, add);
  return columns;
}

template <class Archive, class Starts>
void describe_starts(Archive& archive, const std::string& group, Starts& starts) {
  visit_records(
      archive, group, "Finished multistart runs of the solver", starts,
      Field{"origin", &StartOutcome::origin, "1", "Origin of the starting point"},
      Field{"first_row", &StartOutcome::first_row, "1", "First row (0-based) in evaluations: the starting point"},
      Field{"rows", &StartOutcome::rows, "1", "Number of evaluations"},
      Field{"end_row", &StartOutcome::end_row, "1", "Row of the result: the best evaluation of the run"},
      Field{"stop", &StartOutcome::stop, "1", "converged, evaluation limit, time limit or failed"},
      Field{"message", &StartOutcome::message, "1", "Message of the solver"},
      Field{"optimality", &StartOutcome::optimality, "1",
            "KKT residual of the result, relative to the objective; NaN: no derivatives"});
}

template <class Archive, class Record>
void describe_optimality(Archive& archive, const std::string& group, Record& record) {
  archive.group(group, "First-order optimality (KKT conditions) of the stage's best design");
  archive.attribute(group, "optimality", record.optimality);
  visit_records(archive, group + "/active", "Active bounds and constraints", record.active,
                Field{"name", &ActiveRecord::name, "1", "Variable or constraint"},
                Field{"kind", &ActiveRecord::kind, "1", "lower bound, upper bound or constraint"},
                Field{"multiplier", &ActiveRecord::multiplier, "objective/unit",
                      "Improvement of the objective per unit by which the bound or constraint is relaxed"},
                Field{"unit", &ActiveRecord::unit, "1", "Unit of the bound or constraint"});
  visit_records(archive, group + "/sensitivity", "Derivatives of the objective by each parameter", record.sensitivities,
                Field{"parameter", &SensitivityRecord::parameter, "1", "Name"},
                Field{"unit", &SensitivityRecord::unit, "1", "Unit of the parameter"},
                Field{"as_built", &SensitivityRecord::as_built, "objective/unit", "All other parameters unchanged"},
                Field{"reoptimised", &SensitivityRecord::reoptimised, "objective/unit",
                      "Variables re-optimised; NaN for variables"});
}

template <class Archive, class Problem, class Table>
void describe_evaluations(Archive& archive, const std::string& group, const Problem& problem, Table& table) {
  archive.group(group, "Every evaluation of the stage, one row each, in the order of the optimiser's requests");
  Detail detail = table.shape().detail;  // in files of schema 1, it is always Detail::enough
  if (has_items_since(archive, 2)) visit_enum(archive, group, "detail", detail);
  if constexpr (Archive::kReads) table = EvaluationTable(problem.shape(detail));
  const Leaf status{group + "/status", "0 feasible, 1 infeasible, 2 rejected before the workspace analysis, 3 failed"};
  std::vector<std::uint8_t> codes;
  for (const Status s : table.status) codes.push_back(static_cast<std::uint8_t>(s));
  archive.array(status, codes, {kAnyRows});
  if constexpr (Archive::kReads) {
    for (const std::uint8_t code : codes) {
      if (code >= enum_names(Status{}).size())
        throw ImageError(status.path + ": unknown status code " + std::to_string(code));
      table.status.push_back(static_cast<Status>(code));
    }
  }
  const Extent rows = {codes.size()};
  visit_matrix(archive, group + "/design", "Values of the variables", problem.variables, table.designs, rows);
  visit_matrix(archive, group + "/objective", "Objectives, not negated; NaN: not computed", problem.objectives,
               table.objectives, rows);
  visit_matrix(archive, group + "/margin", "Margins, satisfied if >= 0; NaN: not computed", problem.margins,
               table.margins, rows);
  visit_matrix(archive, group + "/report", "Outputs; NaN: not computed", problem.reports, table.reports, rows);
  if (detail == Detail::derivatives)
    visit_matrix(archive, group + "/slope",
                 "Per objective, then per margin: smooth value, derivatives by the variables", slope_columns(problem),
                 table.derivatives, rows);
  archive.array(Leaf{group + "/seconds", "Evaluation time", {"s"}}, table.seconds, rows);
}

template <class Archive, class Generations>
void describe_generations(Archive& archive, const std::string& stage, Generations& generations, std::size_t rows) {
  const std::string group = stage + "/generations";
  archive.group(group, "One entry per complete generation");
  const auto array = [&](const char* name, const char* description, auto& values, std::size_t size,
                         const char* unit = "1") {
    archive.array(Leaf{group + "/" + name, description, {unit}}, values, {size});
  };
  array("first_row", "First row (0-based) in evaluations", generations.first_row, kAnyRows);
  const std::size_t count = generations.first_row.size();
  array("best_row", "Row (0-based) of the best evaluation so far; -1: none", generations.best_row, count);
  array("feasible_share", "Feasible share of the population", generations.feasible_share, count);
  array("diversity", "Diversity of the population", generations.diversity, count);
  array("seconds", "Wall time of the study at the end of the generation", generations.seconds, count, "s");
  array("population_first", "Index (0-based) in population of the first member", generations.population_first, count);
  array("population", "Rows of the members, one generation after the other", generations.population, kAnyRows);
  if constexpr (!Archive::kReads)
    archive.array(Leaf{stage + "/evaluations/generation", "Generation of the row; 0 is the initial population"},
                  generations.generation_of_rows(rows), {rows});
}

template <class Archive, class Problem, class Stage, class Record>
void describe_front(Archive& archive, const std::string& group, const Problem& problem, const Stage& stage,
                    Record& front) {
  archive.group(group, "Pareto front: non-dominated feasible designs; in solver stages the results of multistart runs");
  const auto series = [&](const char* name, const char* description, auto& values, const char* unit = "1") {
    archive.array(Leaf{group + "/" + name, description, {unit}}, values, {kAnyRows});
  };
  series("row", "Rows (0-based) in evaluations, from best to worst in the first objective", front.rows);
  series("reference", "Reference point of the hypervolume; empty: none", front.reference, "as objectives");
  series("hypervolume", "After each generation: hypervolume between front and reference", front.hypervolume,
         "product of the objectives' units");
  series("spread", "After each generation: unevenness of the population's front; 0 is even", front.spread);
  series("igd_plus", "After each generation: IGD+ distance to the reference front; NaN: none", front.igd_plus);
  if constexpr (!Archive::kReads) {
    std::vector<double> designs, objectives;
    for (const std::int64_t row : front.rows) {
      std::ranges::copy(stage.table.design(static_cast<std::size_t>(row)), std::back_inserter(designs));
      std::ranges::copy(stage.table.objective_row(static_cast<std::size_t>(row)), std::back_inserter(objectives));
    }
    const Extent rows = {front.rows.size()};
    visit_matrix(archive, group + "/design", "Values of the variables", problem.variables, designs, rows);
    visit_matrix(archive, group + "/objective", "Objectives, not negated", problem.objectives, objectives, rows);
    const Scores scores = scores_of(problem.objectives, stage.table, front.rows);
    std::vector<std::uint8_t> knee(front.rows.size(), 0);
    for (const std::size_t point : knees(scores)) knee[point] = 1;
    series("knee", "1 for knees of the front, see engine/problem/front.hpp", knee);
    archive.attribute(group, "compromise",
                      knee.empty() ? std::int64_t{-1} : static_cast<std::int64_t>(compromise(scores)));
  }
}

/// Multistart runs of an interrupted solver stage whose evaluations wait for an unfinished earlier run (see
/// UnmergedRun).
template <class Archive, class Problem, class Starts>
void describe_runs_ahead(Archive& archive, const std::string& group, const Problem& problem, Starts& ahead) {
  bool exists = !ahead.empty();
  if constexpr (Archive::kReads) exists = has_items_since(archive, 4) && archive.has(group);
  if (!exists) return;
  archive.group(group, "Concurrent multistart runs whose evaluations have to wait for those of earlier runs");
  if constexpr (Archive::kReads) ahead.resize(archive.members(group));
  for (std::size_t i = 0; i < ahead.size(); ++i) {
    const std::string start = group + "/" + std::to_string(i + 1);
    archive.group(start, "One multistart run");
    archive.attribute(start, "number", ahead[i].number);
    describe_evaluations(archive, start + "/evaluations", problem, ahead[i].table);
    std::vector<StartOutcome> ends;
    if (ahead[i].outcome) ends.push_back(*ahead[i].outcome);
    describe_starts(archive, start + "/end", ends);
    if constexpr (Archive::kReads) {
      if (ends.size() > 1) throw ImageError(start + "/end: one run has " + std::to_string(ends.size()) + " results");
      if (!ends.empty()) ahead[i].outcome = ends.front();
    }
  }
}

template <class Archive, class Study>
void describe_stages(Archive& archive, Study& study) {
  archive.group("/stages", "The stages: optimisers, run one after the other");
  auto count = static_cast<std::int64_t>(study.stages.size());
  archive.attribute("/stages", "count", count);
  if constexpr (Archive::kReads) {
    if (count < 0 || static_cast<std::size_t>(count) != archive.members("/stages"))
      throw ImageError("/stages@count: is " + std::to_string(count) + ", but the group has " +
                       std::to_string(archive.members("/stages")) + " stages");
    study.stages.resize(static_cast<std::size_t>(count));
  }
  for (std::size_t i = 0; i < study.stages.size(); ++i) {
    const std::string group = "/stages/" + std::to_string(i + 1);
    auto& stage = study.stages[i];
    archive.group(group, "One stage");
    archive.attribute(group, "optimiser", stage.optimiser);
    archive.attribute(group, "finished", stage.finished);
    archive.attribute(group, "stop", stage.stop);
    archive.attribute(group, "best_row", stage.best_row);
    archive.array(Leaf{group + "/options", "The optimiser's options, defaults included"}, stage.options, {kAnyRows});
    describe_evaluations(archive, group + "/evaluations", study.problem, stage.table);
    describe_generations(archive, group, stage.generations, stage.table.size());
    bool has_starts = !stage.starts.empty();
    if constexpr (Archive::kReads) has_starts = archive.has(group + "/starts");
    if (has_starts) describe_starts(archive, group + "/starts", stage.starts);
    describe_runs_ahead(archive, group + "/ahead", study.problem, stage.ahead);
    if (visit_optional(archive, group + "/optimality", stage.optimality))
      describe_optimality(archive, group + "/optimality", *stage.optimality);
    if (visit_optional(archive, group + "/front", stage.front))
      describe_front(archive, group + "/front", study.problem, stage, *stage.front);
  }
}

template <class Archive, class Study>
void describe_best(Archive& archive, Study& study) {
  archive.group("/best", "The best evaluation so far");
  archive.attribute("/best", "stage", study.best.stage);
  archive.attribute("/best", "row", study.best.row);
  if constexpr (!Archive::kReads) {
    if (study.best.row < 0) return;
    const auto& table = study.best_stage().table;
    const auto row = static_cast<std::size_t>(study.best.row);
    const auto copy = [&](const char* name, const char* description, const auto& items, std::span<const double> span) {
      visit_matrix(archive, "/best/" + std::string(name), description, items, std::vector(span.begin(), span.end()));
    };
    copy("design", "Values of the variables", study.problem.variables, table.design(row));
    copy("objective", "Objectives", study.problem.objectives, table.objective_row(row));
    copy("margin", "Margins, satisfied if >= 0", study.problem.margins, table.margin_row(row));
    copy("report", "Outputs", study.problem.reports, table.output_row(row));
  }
}

template <class Archive, class Problem, class Record>
void describe_design(Archive& archive, const std::string& group, const char* description, const Problem& problem,
                     Record& design) {
  archive.group(group, description);
  visit_enum(archive, group, "status", design.status);
  archive.attribute(group, "reason", design.reason);
  archive.attribute(group, "volume", design.volume);
  archive.attribute(group, "cells", design.cells);
  archive.attribute(group, "feasible_cells", design.feasible_cells);
  archive.attribute(group, "cell_volume", design.cell_volume);
  archive.attribute(group, "touches_box", design.touches_box);
  if (const std::string bounds = group + "/certain"; visit_optional(archive, bounds, design.certified)) {
    archive.group(bounds, "Certified bounds of the volume");
    archive.attribute(bounds, "lower", design.certified->lower);
    archive.attribute(bounds, "upper", design.certified->upper);
  }
  visit_matrix(archive, group + "/parameter", "All parameters of the mechanism", problem.parameters, design.parameters);
  visit_matrix(archive, group + "/objective", "Objectives; NaN: not computed", problem.objectives, design.objectives);
  visit_matrix(archive, group + "/margin", "Margins, satisfied if >= 0; NaN: not computed", problem.margins,
               design.margins);
  visit_matrix(archive, group + "/report", "Outputs; NaN: not computed", problem.reports, design.reports);
}

template <class Archive, class Map>
void describe_map(Archive& archive, Map& map) {
  const std::string group = "/final/map";
  archive.group(group, "Voxel map of the best design's workspace");
  archive.array(Leaf{group + "/axis", "Names of the axes, outermost first"}, map.axes, {3});
  archive.array(Leaf{group + "/unit", "Their units"}, map.units, {3});
  visit_array_of_three(archive, Leaf{group + "/lower", "Lower corner of the box", map.units, map.axes},
                       map.voxels.lower);
  visit_array_of_three(archive, Leaf{group + "/upper", "Upper corner of the box", map.units, map.axes},
                       map.voxels.upper);
  visit_array_of_three(archive, Leaf{group + "/cells", "Number of cells along each axis"}, map.voxels.cells);
  archive.array(Leaf{group + "/feasible", "1 if the centre of the cell is feasible; axes as in axis"},
                map.voxels.feasible, Extent(std::begin(map.voxels.cells), std::end(map.voxels.cells)));
}

template <class Archive, class Problem, class Final>
void describe_final(Archive& archive, const Problem& problem, Final& final) {
  archive.group("/final", "Results computed after the last stage");
  archive.attribute("/final", "volume_unit", final.volume_unit);
  archive.array(Leaf{"/final/active", "Active bounds and constraints of the best design"}, final.active, {kAnyRows});
  const auto design = [&](const std::string& name, const char* description, auto& record) {
    const std::string group = "/final/" + name;
    if (visit_optional(archive, group, record)) describe_design(archive, group, description, problem, *record);
  };
  design("best", "The best design", final.best);
  design("rounded", "The best design, rounded and re-evaluated", final.rounded);
  design("baseline", "The baseline design", final.baseline);
  design("best_exact", "The best design, evaluated by the exact method (columns)", final.best_exact);
  design("baseline_exact", "The baseline, evaluated by the exact method (columns)", final.baseline_exact);
  if (visit_optional(archive, "/final/map", final.map)) describe_map(archive, *final.map);
}

template <class Archive, class Text>
void describe_mechanism_file(Archive& archive, Text& description) {
  archive.group("/mechanism", "The mechanism file that the study names");
  archive.attribute("/mechanism", "file", description.file_name);
  std::vector<std::string> text = {description.text};
  archive.array(Leaf{"/mechanism/toml", "Text of the mechanism file"}, text, {});
  if constexpr (Archive::kReads) description.text = text[0];
}

template <class Archive, class Functions>
void describe_functions(Archive& archive, Functions& functions) {
  if (!visit_optional(archive, "/functions", functions)) return;
  visit_records(archive, "/functions", "Functions of other programs that the study calls; their code is not stored",
                *functions, Field{"call", &FunctionRecord::call, "1", "The function, as the study names it"},
                Field{"hash", &FunctionRecord::hash, "1", "XXH64 of the file that defines it"});
}

/// Visits all items of a study file.
/// @param archive  ImageWriter or ImageReader
/// @param study    const StudyContents or StudyContents, respectively
template <class Archive, class Study>
void describe(Archive& archive, Study& study) {
  archive.group("/", "pkmopt study; engine/storage/README.md documents its schema");
  if constexpr (!Archive::kReads) {  // written for other programs; pkmopt reads both values from the header
    archive.attribute("/", "format", std::string("pkmopt-study"));
    archive.attribute("/", "schema", std::int64_t{kStudySchema});
  }
  archive.attribute("/", "name", study.name);
  archive.attribute("/", "toml_file", study.toml_file);
  if (has_items_since(archive, 5)) archive.attribute("/", "text_digest", study.text_digest);
  archive.attribute("/", "seed", study.seed);
  archive.attribute("/", "program_version", study.program_version);
  archive.attribute("/", "program_revision", study.program_revision);
  archive.attribute("/", "algorithms", study.algorithms);
  archive.attribute("/", "machine", study.machine);
  archive.attribute("/", "created", study.created);
  archive.attribute("/", "updated", study.updated);
  visit_enum(archive, "/", "state", study.state);
  archive.attribute("/", "seconds", study.seconds);
  if constexpr (!Archive::kReads) archive.attribute("/", "reproducible", study.reproducible());

  std::vector<std::string> text = {study.toml};
  archive.array(Leaf{"/toml", "Text of the study"}, text, {});
  if constexpr (Archive::kReads) study.toml = text[0];
  if (visit_optional(archive, "/mechanism", study.description)) describe_mechanism_file(archive, *study.description);
  describe_functions(archive, study.functions);
  visit_records(archive, "/extensions", "Limits changed by `pkmopt resume`, in chronological order", study.extensions,
                Field{"stage", &Extension::stage, "1", "Stage (0-based)"},
                Field{"limit", &Extension::limit, "1", "generations, evaluations or time"},
                Field{"value", &Extension::value, "1 or s", "New limit"});
  if (has_items_since(archive, 2))
    archive.array(Leaf{"/notes", "Remarks on the course of the study, one sentence each"}, study.notes, {kAnyRows});
  describe_problem(archive, study);
  describe_stages(archive, study);
  describe_best(archive, study);
  if (visit_optional(archive, "/final", study.final)) describe_final(archive, study.problem, *study.final);
}

}  // namespace pkm::schema
