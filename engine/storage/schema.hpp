// Where everything of a study lies in its file. Private to engine/storage.
//
// One function visits all of StudyContents and names path, unit and description of each item. The archive it is given
// decides what happens: ImageWriter writes the item, ImageReader fills it, and the comparison collects it. So the three
// cannot disagree.
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

/// How much an evaluation holds. Schema 1 had one answer only.
template <class Archive>
Detail read_detail(Archive& archive, const std::string& group) {
  Detail detail = Detail::enough;
  if (archive.schema() > 1) choice(archive, group, "detail", detail, kDetailWords);
  return detail;
}

/// "workspace-ratio", "d workspace-ratio / d a", ...
template <class Problem>
std::vector<std::string> slope_columns(const Problem& problem) {
  std::vector<std::string> columns;
  const auto add = [&](const std::string& name) {
    columns.push_back(name);
    for (const auto& v : problem.variables) columns.push_back("d " + name + " / d " + v.name);
  };
  for (const auto& o : problem.objectives) add(o.name);
  for (const auto& m : problem.margins) add(m.name);
  return columns;
}

template <class Problem>
std::vector<std::string> slope_units(const Problem& problem) {
  std::vector<std::string> all;
  const auto add = [&](const std::string& unit) {
    all.push_back(unit);
    for (const auto& v : problem.variables) all.push_back("(" + unit + ")/(" + v.unit + ")");
  };
  for (const auto& o : problem.objectives) add(o.unit);
  for (const auto& m : problem.margins) add(m.unit);
  return all;
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
  if constexpr (Archive::kReads) table = EvaluationTable(problem.shape(read_detail(archive, group)));
  const EvaluationShape shape = table.shape();
  if constexpr (!Archive::kReads) {
    Detail detail = shape.detail;
    choice(archive, group, "detail", detail, kDetailWords);
  }
  const Leaf status{group + "/status", "0 feasible, 1 infeasible, 2 rejected before the survey, 3 failed", {"1"}, {}};
  std::vector<std::uint8_t> codes;
  if constexpr (!Archive::kReads)
    for (const Status s : table.status) codes.push_back(static_cast<std::uint8_t>(s));
  archive.array(status, codes, {kAnyRows});
  if constexpr (Archive::kReads) {
    for (const std::uint8_t code : codes) {
      if (code >= kStatusWords.size()) throw ImageError(status.path + ": the unknown code " + std::to_string(code));
      table.status.push_back(static_cast<Status>(code));
    }
  }
  const std::size_t rows = codes.size();
  const auto matrix = [&](const char* name, const char* description, const auto& items, auto& values) {
    archive.array(Leaf{group + "/" + name, description, units(items), names(items)}, values, {rows, items.size()});
  };
  matrix("design", "Values of the variables", problem.variables, table.designs);
  matrix("objective", "Objectives, in their own direction; NaN: not computed", problem.objectives, table.objectives);
  matrix("margin", "Margins, >= 0 holds; NaN: not computed", problem.margins, table.margins);
  matrix("report", "Reports; NaN: not computed", problem.reports, table.reports);
  if (shape.detail == Detail::derivatives)
    archive.array(Leaf{group + "/slope", "Per objective, then per margin: smooth value, derivatives by each variable",
                       slope_units(problem), slope_columns(problem)},
                  table.slopes, {rows, shape.slopes()});
  archive.array(Leaf{group + "/seconds", "Evaluation time", {"s"}, {}, Repeats::no}, table.seconds, {rows});
}

template <class Archive, class Generations>
void describe_generations(Archive& archive, const std::string& stage, Generations& generations, std::size_t rows) {
  const std::string group = stage + "/generations";
  archive.group(group, "One entry per complete generation");
  const auto array = [&](const char* name, const char* unit, const char* description, auto& values, std::size_t size,
                         Repeats repeats = Repeats::yes) {
    archive.array(Leaf{group + "/" + name, description, {unit}, {}, repeats}, values, {size});
  };
  array("first_row", "1", "First row (0-based) in evaluations", generations.first_row, kAnyRows);
  const std::size_t count = generations.first_row.size();
  array("best_row", "1", "Row of the best evaluation so far; -1: none", generations.best_row, count);
  array("feasible_share", "1", "Feasible share of the population", generations.feasible_share, count);
  array("diversity", "1", "Diversity of the population", generations.diversity, count);
  array("seconds", "s", "Wall time of the study at the generation's end", generations.seconds, count, Repeats::no);
  array("population_first", "1", "First element (0-based) of the generation in population",
        generations.population_first, count);
  array("population", "1", "Rows that form the population, generation after generation", generations.population,
        kAnyRows);
  if constexpr (Archive::kDerives) {
    archive.array(Leaf{stage + "/evaluations/generation", "Generation, 0 is the start population", {"1"}, {}},
                  generations.generation_of_rows(rows), {rows});
  }
}

template <class Archive, class Problem, class Stage, class Record>
void describe_front(Archive& archive, const std::string& group, const Problem& problem, const Stage& stage,
                    Record& front) {
  archive.group(group, "The trade-off: feasible designs that no other one dominates, of solvers the ends of starts");
  archive.array(Leaf{group + "/row", "Rows (0-based) in evaluations, the best by the first objective first", {"1"}, {}},
                front.rows, {kAnyRows});
  archive.array(
      Leaf{group + "/reference", "Corner of the hypervolume, per objective; empty: none", {"as objectives"}, {}},
      front.reference, {kAnyRows});
  const auto series = [&](const char* name, const char* description, auto& values, const char* unit = "1") {
    archive.array(Leaf{group + "/" + name, description, {unit}, {}}, values, {kAnyRows});
  };
  series("hypervolume", "After each generation: what reference and front enclose", front.hypervolume,
         "product of the objectives' units");
  series("spread", "After each generation: unevenness of the population's part of the front, 0 is even", front.spread);
  series("igd_plus", "After each generation: distance (IGD+) to the reference front; NaN: none given", front.igd_plus);
  if constexpr (Archive::kDerives) {
    std::vector<double> designs, objectives;
    for (const std::int64_t row : front.rows) {
      const auto design = stage.table.design(static_cast<std::size_t>(row));
      const auto objective = stage.table.objective_row(static_cast<std::size_t>(row));
      designs.insert(designs.end(), design.begin(), design.end());
      objectives.insert(objectives.end(), objective.begin(), objective.end());
    }
    const auto matrix = [&](const char* name, const char* description, const auto& items, const auto& values) {
      archive.array(Leaf{group + "/" + name, description, units(items), names(items)}, values,
                    {front.rows.size(), items.size()});
    };
    matrix("design", "Values of the variables", problem.variables, designs);
    matrix("objective", "Objectives, in their own direction", problem.objectives, objectives);
    const Scores scores = scores_of(problem.objectives, stage.table, front.rows);
    std::vector<std::uint8_t> knee(front.rows.size(), 0);
    for (const std::size_t point : knees(scores)) knee[point] = 1;
    archive.array(Leaf{group + "/knee", "1 where the front bends, see engine/problem/front.hpp", {"1"}, {}}, knee,
                  {knee.size()});
    archive.attribute(group, "compromise",
                      knee.empty() ? std::int64_t{-1} : static_cast<std::int64_t>(compromise(scores)));
  }
}

template <class Archive, class Study>
void describe_stages(Archive& archive, Study& study) {
  archive.group("/stages", "The optimisers, run one after the other");
  auto count = static_cast<std::int64_t>(study.stages.size());
  archive.attribute("/stages", "count", count);
  if constexpr (Archive::kReads) study.stages.resize(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < study.stages.size(); ++i) {
    const std::string group = "/stages/" + std::to_string(i + 1);
    auto& stage = study.stages[i];
    archive.group(group, "One optimiser");
    archive.attribute(group, "optimiser", stage.optimiser);
    archive.attribute(group, "finished", stage.finished);
    archive.attribute(group, "stop", stage.stop);
    archive.attribute(group, "best_row", stage.best_row);
    archive.array(Leaf{group + "/options", "The optimiser's options, defaults included", {"1"}, {}}, stage.options,
                  {kAnyRows});
    describe_evaluations(archive, group + "/evaluations", study.problem, stage.table);
    describe_generations(archive, group, stage.generations, stage.table.size());
    if constexpr (Archive::kReads) {
      if (archive.has(group + "/starts")) describe_starts(archive, group + "/starts", stage.starts);
    } else if (!stage.starts.empty()) {
      describe_starts(archive, group + "/starts", stage.starts);
    }
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
  if constexpr (Archive::kDerives) {
    if (study.best.row < 0) return;
    const auto& table = study.stages[static_cast<std::size_t>(study.best.stage)].table;
    const auto row = static_cast<std::size_t>(study.best.row);
    const auto copy = [&](const char* name, const char* description, const auto& items, std::span<const double> span) {
      archive.array(Leaf{"/best/" + std::string(name), description, units(items), names(items)},
                    std::vector<double>(span.begin(), span.end()), {span.size()});
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
  choice(archive, group, "status", design.status, kStatusWords);
  archive.attribute(group, "reason", design.reason);
  archive.attribute(group, "volume", design.volume);
  archive.attribute(group, "cells", design.cells);
  archive.attribute(group, "feasible_cells", design.feasible_cells);
  archive.attribute(group, "cell_volume", design.cell_volume);
  archive.attribute(group, "touches_box", design.touches_box);
  const auto row = [&](const char* name, const char* meaning, const auto& items, auto& values) {
    archive.array(Leaf{group + "/" + name, meaning, units(items), names(items)}, values, {items.size()});
  };
  row("parameter", "All parameters of the mechanism", problem.parameters, design.parameters);
  row("objective", "Objectives; NaN: not computed", problem.objectives, design.objectives);
  row("margin", "Margins, >= 0 holds; NaN: not computed", problem.margins, design.margins);
  row("report", "Reports; NaN: not computed", problem.reports, design.reports);
}

template <class Archive, class Map>
void describe_map(Archive& archive, Map& map) {
  const std::string group = "/final/map";
  archive.group(group, "Voxels of the best design's workspace");
  archive.array(Leaf{group + "/axis", "Names of the axes, outermost first", {"1"}, {}}, map.axes, {3});
  archive.array(Leaf{group + "/unit", "Their units", {"1"}, {}}, map.units, {3});
  triple<Archive, double>(archive, Leaf{group + "/lower", "Least corner of the box", map.units, map.axes},
                          map.voxels.lower);
  triple<Archive, double>(archive, Leaf{group + "/upper", "Greatest corner of the box", map.units, map.axes},
                          map.voxels.upper);
  triple<Archive, std::int64_t>(archive, Leaf{group + "/cells", "Cells along the axes", {"1"}, {}}, map.voxels.cells);
  Extent extent;
  for (const std::int64_t n : map.voxels.cells) extent.push_back(static_cast<std::size_t>(n));
  archive.array(Leaf{group + "/feasible", "1 where the cell's centre is feasible; axes as in axis", {"1"}, {}},
                map.voxels.feasible, extent);
}

template <class Archive, class Problem, class Final>
void describe_final(Archive& archive, const Problem& problem, Final& final) {
  archive.group("/final", "Worked out after the last stage");
  archive.attribute("/final", "volume_unit", final.volume_unit);
  archive.array(Leaf{"/final/active", "Active bounds and constraints of the best design", {"1"}, {}}, final.active,
                {kAnyRows});
  if (present(archive, "/final/best", final.best))
    describe_design(archive, "/final/best", "The best design", problem, *final.best);
  if (present(archive, "/final/rounded", final.rounded))
    describe_design(archive, "/final/rounded", "The best design, rounded and evaluated again", problem, *final.rounded);
  if (present(archive, "/final/baseline", final.baseline))
    describe_design(archive, "/final/baseline", "The design to compare with", problem, *final.baseline);
  if (present(archive, "/final/best_exact", final.best_exact))
    describe_design(archive, "/final/best_exact", "The best design on exact columns", problem, *final.best_exact);
  if (present(archive, "/final/baseline_exact", final.baseline_exact))
    describe_design(archive, "/final/baseline_exact", "The baseline on exact columns", problem, *final.baseline_exact);
  if (present(archive, "/final/map", final.map)) describe_map(archive, *final.map);
}

template <class Archive, class Study>
void describe(Archive& archive, Study& study) {
  archive.group("/", "Study of pkmopt: its schema is documented in engine/storage/README.md");
  if constexpr (Archive::kDerives) {  // for other programs; ours reads both in the seal
    archive.attribute("/", "format", std::string("pkmopt-study"));
    archive.attribute("/", "schema", std::int64_t{kStudySchema});
  }
  archive.attribute("/", "name", study.name);
  archive.attribute("/", "toml_file", study.toml_file, Repeats::no);
  archive.attribute("/", "seed", study.seed);
  archive.attribute("/", "program_version", study.program_version, Repeats::no);
  archive.attribute("/", "program_revision", study.program_revision, Repeats::no);
  archive.attribute("/", "algorithms", study.algorithms);
  archive.attribute("/", "machine", study.machine, Repeats::no);
  archive.attribute("/", "created", study.created, Repeats::no);
  archive.attribute("/", "updated", study.updated, Repeats::no);
  choice(archive, "/", "state", study.state, kStateWords);
  archive.attribute("/", "seconds", study.seconds, Repeats::no);
  if constexpr (Archive::kDerives) archive.attribute("/", "reproducible", study.reproducible());

  if constexpr (Archive::kReads) {
    std::vector<std::string> text;
    archive.array(Leaf{"/toml", "", {}, {}}, text, {});
    study.toml = text[0];
  } else {
    archive.array(Leaf{"/toml", "The study file's text", {"1"}, {}}, std::vector<std::string>{study.toml}, {});
  }
  records(archive, "/extensions", "Limits changed by `pkmopt resume`, in the order of the changes", study.extensions,
          Field{"stage", &Extension::stage, "1", "Stage, 0 is the first"},
          Field{"limit", &Extension::limit, "1", "generations, evaluations or time"},
          Field{"value", &Extension::value, "1 or s", "New limit"});
  bool notes = true;
  if constexpr (Archive::kReads) notes = archive.schema() > 1;
  if (notes)
    archive.array(Leaf{"/notes", "What happened to the study, in sentences", {"1"}, {}, Repeats::no}, study.notes,
                  {kAnyRows});
  describe_problem(archive, study);
  describe_stages(archive, study);
  describe_best(archive, study);
  if (present(archive, "/final", study.final)) describe_final(archive, study.problem, *study.final);
}

}  // namespace pkm::schema
