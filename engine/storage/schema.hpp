// Where everything of a study lies in its file. Private to engine/storage.
//
// One function visits all of StudyContents and names path, unit and description of each item. The archive it is given
// decides what happens: ImageWriter writes the item, ImageReader fills it. So the two cannot disagree.
// What only a writer gets is for other programs: nothing reads it back.
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
  archive.group("/problem", "What is optimised");
  archive.attribute("/problem", "mechanism", problem.mechanism);
  records(archive, "/problem/parameters", "All parameters of the mechanism, in its order", problem.parameters,
          Field{"name", &ParameterRecord::name, "1", "Name"}, Field{"unit", &ParameterRecord::unit, "1", "SI unit"},
          Field{"value", &ParameterRecord::value, "see unit", "Fixed value; the nominal one where it varies"},
          Field{"variable", &ParameterRecord::variable, "1", "Index among the variables; -1: fixed"});
  records(archive, "/problem/variables", "What the optimisers change: the columns of every design", problem.variables,
          Field{"name", &Variable::name, "1", "Name of the parameter"}, Field{"unit", &Variable::unit, "1", "SI unit"},
          Field{"lower", &Variable::lower, "see unit", "Least value"},
          Field{"upper", &Variable::upper, "see unit", "Greatest value"},
          Field{"step", &Variable::step, "see unit", "Distance of allowed values; 0: continuous"});
  records(archive, "/problem/objectives", "What is optimised: the columns of every objective", problem.objectives,
          Field{"name", &ObjectiveInfo::name, "1", "Name"}, Field{"unit", &ObjectiveInfo::unit, "1", "Unit"},
          Field{"meaning", &ObjectiveInfo::meaning, "1", "Meaning"},
          Field{"direction", &ObjectiveInfo::direction, "1", "minimise or maximise"});
  records(archive, "/problem/margins", "Constraints: the columns of every margin, which holds when >= 0",
          problem.margins, Field{"name", &MarginInfo::name, "1", "Name"}, Field{"unit", &MarginInfo::unit, "1", "Unit"},
          Field{"meaning", &MarginInfo::meaning, "1", "Meaning"});
  records(archive, "/problem/reports", "Computed and stored, not optimised: the columns of every report",
          problem.reports, Field{"name", &ReportInfo::name, "1", "Name"}, Field{"unit", &ReportInfo::unit, "1", "Unit"},
          Field{"meaning", &ReportInfo::meaning, "1", "Meaning"});
}

/// "workspace-ratio", "d workspace-ratio / d a", ..., and their units.
template <class Problem>
std::vector<ReportInfo> slopes_of(const Problem& problem) {
  std::vector<ReportInfo> slopes;
  const auto add = [&](const auto& quantity) {
    slopes.push_back({quantity.name, quantity.unit, ""});
    for (const Variable& v : problem.variables)
      slopes.push_back({"d " + quantity.name + " / d " + v.name, "(" + quantity.unit + ")/(" + v.unit + ")", ""});
  };
  std::ranges::for_each(problem.objectives, add);
  std::ranges::for_each(problem.margins, add);
  return slopes;
}

template <class Archive, class Starts>
void describe_starts(Archive& archive, const std::string& group, Starts& starts) {
  records(archive, group, "Starts of the solver that have ended", starts,
          Field{"origin", &StartOutcome::origin, "1", "Where the start came from"},
          Field{"first_row", &StartOutcome::first_row, "1", "First row (0-based) in evaluations: the start itself"},
          Field{"rows", &StartOutcome::rows, "1", "Evaluations made"},
          Field{"end_row", &StartOutcome::end_row, "1", "Row of what is kept: the best of the start's evaluations"},
          Field{"stop", &StartOutcome::stop, "1", "converged, evaluation limit, time limit or failed"},
          Field{"message", &StartOutcome::message, "1", "What the solver said"},
          Field{"optimality", &StartOutcome::optimality, "1",
                "First-order optimality at the end, relative to the objective; NaN: no derivatives"});
}

template <class Archive, class Record>
void describe_optimality(Archive& archive, const std::string& group, Record& record) {
  archive.group(group, "First-order optimality of the stage's best design");
  archive.attribute(group, "optimality", record.optimality);
  records(archive, group + "/active", "Bounds and constraints that hold it back", record.active,
          Field{"name", &ActiveRecord::name, "1", "Variable or constraint"},
          Field{"kind", &ActiveRecord::kind, "1", "lower bound, upper bound or constraint"},
          Field{"multiplier", &ActiveRecord::multiplier, "objective/unit",
                "Gain of the objective per unit by which it is moved out of the way"},
          Field{"unit", &ActiveRecord::unit, "1", "Unit of what is moved"});
  records(archive, group + "/sensitivity", "What a change of each parameter does to the objective",
          record.sensitivities, Field{"parameter", &SensitivityRecord::parameter, "1", "Name"},
          Field{"unit", &SensitivityRecord::unit, "1", "Unit of the parameter"},
          Field{"as_built", &SensitivityRecord::as_built, "objective/unit", "The rest of the design as it is"},
          Field{"reoptimised", &SensitivityRecord::reoptimised, "objective/unit",
                "When the variables follow; NaN for variables"});
}

template <class Archive, class Problem, class Table>
void describe_evaluations(Archive& archive, const std::string& group, const Problem& problem, Table& table) {
  archive.group(group, "Every evaluation of the stage, one row each, in the order in which it was asked for");
  Detail detail = table.shape().detail;  // schema 1 had one answer only
  if (since(archive, 2)) choice(archive, group, "detail", detail);
  if constexpr (Archive::kReads) table = EvaluationTable(problem.shape(detail));
  const Leaf status{group + "/status", "0 feasible, 1 infeasible, 2 rejected before the survey, 3 failed"};
  std::vector<std::uint8_t> codes;
  for (const Status s : table.status) codes.push_back(static_cast<std::uint8_t>(s));
  archive.array(status, codes, {kAnyRows});
  if constexpr (Archive::kReads) {
    for (const std::uint8_t code : codes) {
      if (code >= words_of(Status{}).size())
        throw ImageError(status.path + ": the unknown code " + std::to_string(code));
      table.status.push_back(static_cast<Status>(code));
    }
  }
  const Extent rows = {codes.size()};
  columns(archive, group + "/design", "Values of the variables", problem.variables, table.designs, rows);
  columns(archive, group + "/objective", "Objectives, in their own direction; NaN: not computed", problem.objectives,
          table.objectives, rows);
  columns(archive, group + "/margin", "Margins, >= 0 holds; NaN: not computed", problem.margins, table.margins, rows);
  columns(archive, group + "/report", "Reports; NaN: not computed", problem.reports, table.reports, rows);
  if (detail == Detail::derivatives)
    columns(archive, group + "/slope", "Per objective, then per margin: smooth value, derivatives by each variable",
            slopes_of(problem), table.slopes, rows);
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
  array("best_row", "Row of the best evaluation so far; -1: none", generations.best_row, count);
  array("feasible_share", "Feasible share of the population", generations.feasible_share, count);
  array("diversity", "Diversity of the population", generations.diversity, count);
  array("seconds", "Wall time of the study at the generation's end", generations.seconds, count, "s");
  array("population_first", "First element (0-based) of the generation in population", generations.population_first,
        count);
  array("population", "Rows that form the population, generation after generation", generations.population, kAnyRows);
  if constexpr (!Archive::kReads)
    archive.array(Leaf{stage + "/evaluations/generation", "Generation, 0 is the start population"},
                  generations.generation_of_rows(rows), {rows});
}

template <class Archive, class Problem, class Stage, class Record>
void describe_front(Archive& archive, const std::string& group, const Problem& problem, const Stage& stage,
                    Record& front) {
  archive.group(group, "The trade-off: feasible designs that no other one dominates, of solvers the ends of starts");
  const auto series = [&](const char* name, const char* description, auto& values, const char* unit = "1") {
    archive.array(Leaf{group + "/" + name, description, {unit}}, values, {kAnyRows});
  };
  series("row", "Rows (0-based) in evaluations, the best by the first objective first", front.rows);
  series("reference", "Corner of the hypervolume, per objective; empty: none", front.reference, "as objectives");
  series("hypervolume", "After each generation: what reference and front enclose", front.hypervolume,
         "product of the objectives' units");
  series("spread", "After each generation: unevenness of the population's part of the front, 0 is even", front.spread);
  series("igd_plus", "After each generation: distance (IGD+) to the reference front; NaN: none given", front.igd_plus);
  if constexpr (!Archive::kReads) {
    std::vector<double> designs, objectives;
    for (const std::int64_t row : front.rows) {
      std::ranges::copy(stage.table.design(static_cast<std::size_t>(row)), std::back_inserter(designs));
      std::ranges::copy(stage.table.objective_row(static_cast<std::size_t>(row)), std::back_inserter(objectives));
    }
    const Extent rows = {front.rows.size()};
    columns(archive, group + "/design", "Values of the variables", problem.variables, designs, rows);
    columns(archive, group + "/objective", "Objectives, in their own direction", problem.objectives, objectives, rows);
    const Scores scores = scores_of(problem.objectives, stage.table, front.rows);
    std::vector<std::uint8_t> knee(front.rows.size(), 0);
    for (const std::size_t point : knees(scores)) knee[point] = 1;
    series("knee", "1 where the front bends, see engine/problem/front.hpp", knee);
    archive.attribute(group, "compromise",
                      knee.empty() ? std::int64_t{-1} : static_cast<std::int64_t>(compromise(scores)));
  }
}

template <class Archive, class Problem, class Starts>
void describe_ahead(Archive& archive, const std::string& group, const Problem& problem, Starts& ahead) {
  bool there = !ahead.empty();
  if constexpr (Archive::kReads) there = since(archive, 4) && archive.has(group);
  if (!there) return;
  archive.group(group, "What is known of starts whose evaluations cannot follow those of the starts before them yet");
  if constexpr (Archive::kReads) ahead.resize(archive.members(group));
  for (std::size_t i = 0; i < ahead.size(); ++i) {
    const std::string start = group + "/" + std::to_string(i + 1);
    archive.group(start, "One start");
    archive.attribute(start, "number", ahead[i].number);
    describe_evaluations(archive, start + "/evaluations", problem, ahead[i].table);
    std::vector<StartOutcome> ends;
    if (ahead[i].outcome) ends.push_back(*ahead[i].outcome);
    describe_starts(archive, start + "/end", ends);
    if constexpr (Archive::kReads) {
      if (ends.size() > 1) throw ImageError(start + "/end: one start has " + std::to_string(ends.size()) + " ends");
      if (!ends.empty()) ahead[i].outcome = ends.front();
    }
  }
}

template <class Archive, class Study>
void describe_stages(Archive& archive, Study& study) {
  archive.group("/stages", "The optimisers, run one after the other");
  auto count = static_cast<std::int64_t>(study.stages.size());
  archive.attribute("/stages", "count", count);
  if constexpr (Archive::kReads) {
    if (count < 0 || static_cast<std::size_t>(count) != archive.members("/stages"))
      throw ImageError("/stages@count: is " + std::to_string(count) + ", but it has " +
                       std::to_string(archive.members("/stages")) + " stages");
    study.stages.resize(static_cast<std::size_t>(count));
  }
  for (std::size_t i = 0; i < study.stages.size(); ++i) {
    const std::string group = "/stages/" + std::to_string(i + 1);
    auto& stage = study.stages[i];
    archive.group(group, "One optimiser");
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
    describe_ahead(archive, group + "/ahead", study.problem, stage.ahead);
    if (present(archive, group + "/optimality", stage.optimality))
      describe_optimality(archive, group + "/optimality", *stage.optimality);
    if (present(archive, group + "/front", stage.front))
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
      columns(archive, "/best/" + std::string(name), description, items, std::vector(span.begin(), span.end()));
    };
    copy("design", "Values of the variables", study.problem.variables, table.design(row));
    copy("objective", "Objectives", study.problem.objectives, table.objective_row(row));
    copy("margin", "Margins, >= 0 holds", study.problem.margins, table.margin_row(row));
    copy("report", "Reports", study.problem.reports, table.report_row(row));
  }
}

template <class Archive, class Problem, class Record>
void describe_design(Archive& archive, const std::string& group, const char* description, const Problem& problem,
                     Record& design) {
  archive.group(group, description);
  choice(archive, group, "status", design.status);
  archive.attribute(group, "reason", design.reason);
  archive.attribute(group, "volume", design.volume);
  archive.attribute(group, "cells", design.cells);
  archive.attribute(group, "feasible_cells", design.feasible_cells);
  archive.attribute(group, "cell_volume", design.cell_volume);
  archive.attribute(group, "touches_box", design.touches_box);
  if (const std::string bounds = group + "/certain"; present(archive, bounds, design.certain)) {
    archive.group(bounds, "Certain bounds of the volume");
    archive.attribute(bounds, "lower", design.certain->lower);
    archive.attribute(bounds, "upper", design.certain->upper);
  }
  columns(archive, group + "/parameter", "All parameters of the mechanism", problem.parameters, design.parameters);
  columns(archive, group + "/objective", "Objectives; NaN: not computed", problem.objectives, design.objectives);
  columns(archive, group + "/margin", "Margins, >= 0 holds; NaN: not computed", problem.margins, design.margins);
  columns(archive, group + "/report", "Reports; NaN: not computed", problem.reports, design.reports);
}

template <class Archive, class Map>
void describe_map(Archive& archive, Map& map) {
  const std::string group = "/final/map";
  archive.group(group, "Voxels of the best design's workspace");
  archive.array(Leaf{group + "/axis", "Names of the axes, outermost first"}, map.axes, {3});
  archive.array(Leaf{group + "/unit", "Their units"}, map.units, {3});
  triple(archive, Leaf{group + "/lower", "Least corner of the box", map.units, map.axes}, map.voxels.lower);
  triple(archive, Leaf{group + "/upper", "Greatest corner of the box", map.units, map.axes}, map.voxels.upper);
  triple(archive, Leaf{group + "/cells", "Cells along the axes"}, map.voxels.cells);
  archive.array(Leaf{group + "/feasible", "1 where the cell's centre is feasible; axes as in axis"},
                map.voxels.feasible, Extent(std::begin(map.voxels.cells), std::end(map.voxels.cells)));
}

template <class Archive, class Problem, class Final>
void describe_final(Archive& archive, const Problem& problem, Final& final) {
  archive.group("/final", "Worked out after the last stage");
  archive.attribute("/final", "volume_unit", final.volume_unit);
  archive.array(Leaf{"/final/active", "Active bounds and constraints of the best design"}, final.active, {kAnyRows});
  const auto design = [&](const std::string& name, const char* description, auto& record) {
    const std::string group = "/final/" + name;
    if (present(archive, group, record)) describe_design(archive, group, description, problem, *record);
  };
  design("best", "The best design", final.best);
  design("rounded", "The best design, rounded and evaluated again", final.rounded);
  design("baseline", "The design to compare with", final.baseline);
  design("best_exact", "The best design on exact columns", final.best_exact);
  design("baseline_exact", "The baseline on exact columns", final.baseline_exact);
  if (present(archive, "/final/map", final.map)) describe_map(archive, *final.map);
}

template <class Archive, class Text>
void describe_description(Archive& archive, Text& description) {
  archive.group("/mechanism", "The mechanism's file, which the study's text names");
  archive.attribute("/mechanism", "file", description.file_name);
  std::vector<std::string> text = {description.text};
  archive.array(Leaf{"/mechanism/toml", "Its text"}, text, {});
  if constexpr (Archive::kReads) description.text = text[0];
}

template <class Archive, class Study>
void describe(Archive& archive, Study& study) {
  archive.group("/", "Study of pkmopt: its schema is documented in engine/storage/README.md");
  if constexpr (!Archive::kReads) {  // for other programs; ours reads both in the seal
    archive.attribute("/", "format", std::string("pkmopt-study"));
    archive.attribute("/", "schema", std::int64_t{kStudySchema});
  }
  archive.attribute("/", "name", study.name);
  archive.attribute("/", "toml_file", study.toml_file);
  if (since(archive, 5)) archive.attribute("/", "text_digest", study.text_digest);
  archive.attribute("/", "seed", study.seed);
  archive.attribute("/", "program_version", study.program_version);
  archive.attribute("/", "program_revision", study.program_revision);
  archive.attribute("/", "algorithms", study.algorithms);
  archive.attribute("/", "machine", study.machine);
  archive.attribute("/", "created", study.created);
  archive.attribute("/", "updated", study.updated);
  choice(archive, "/", "state", study.state);
  archive.attribute("/", "seconds", study.seconds);
  if constexpr (!Archive::kReads) archive.attribute("/", "reproducible", study.reproducible());

  std::vector<std::string> text = {study.toml};
  archive.array(Leaf{"/toml", "The study file's text"}, text, {});
  if constexpr (Archive::kReads) study.toml = text[0];
  if (present(archive, "/mechanism", study.description)) describe_description(archive, *study.description);
  records(archive, "/extensions", "Limits changed by `pkmopt resume`, in the order of the changes", study.extensions,
          Field{"stage", &Extension::stage, "1", "Stage, 0 is the first"},
          Field{"limit", &Extension::limit, "1", "generations, evaluations or time"},
          Field{"value", &Extension::value, "1 or s", "New limit"});
  if (since(archive, 2))
    archive.array(Leaf{"/notes", "What happened to the study, in sentences"}, study.notes, {kAnyRows});
  describe_problem(archive, study);
  describe_stages(archive, study);
  describe_best(archive, study);
  if (present(archive, "/final", study.final)) describe_final(archive, study.problem, *study.final);
}

}  // namespace pkm::schema
