#include "engine/export/study_tables.hpp"

#include <algorithm>

#include "engine/problem/front.hpp"
#include "engine/results/comparison.hpp"
#include "engine/results/design_values.hpp"

namespace pkm {
namespace {

using Names = std::vector<std::string>;

/// Appends the column headers of a list of named values, such as "objective conditioning" or "margin rail-length [m]".
template <class Named>
void add_headers(Names& columns, const std::string& prefix, const std::vector<Named>& items) {
  for (const Named& item : items) columns.push_back(column_header(prefix + item.name, item.unit));
}

/// Adds the value of a variable, or the name of the row that it selects from a catalogue.
void add_variable(CsvTable& table, const ProblemRecord& problem, std::size_t variable, double value) {
  if (const std::string name = choice_name(problem, variable, value); name.empty())
    table.add(value);
  else
    table.add(name);
}

void add_design(CsvTable& table, const ProblemRecord& problem, std::span<const double> design) {
  for (std::size_t v = 0; v < design.size(); ++v) add_variable(table, problem, v, design[v]);
}

CsvTable evaluations(const StudyContents& contents) {
  const ProblemRecord& problem = contents.problem;
  Names columns = {"stage", "evaluation", "generation", "status"};
  add_headers(columns, "", problem.variables);
  add_headers(columns, "objective ", problem.objectives);
  add_headers(columns, "margin ", problem.margins);
  add_headers(columns, "output ", problem.reports);
  CsvTable table(columns);
  for (std::size_t s = 0; s < contents.stages.size(); ++s) {
    const EvaluationTable& rows = contents.stages[s].table;
    const auto generation = contents.stages[s].generations.generation_of_rows(rows.size());
    for (std::size_t row = 0; row < rows.size(); ++row) {
      table.row(s + 1, row, generation[row], words(rows.status[row]));
      add_design(table, problem, rows.design(row));
      table.add(rows.objective_row(row));
      table.add(rows.margin_row(row));
      table.add(rows.output_row(row));
    }
  }
  return table;
}

CsvTable generations(const StudyContents& contents) {
  Names columns = {"stage", "generation", "evaluations", "best evaluation"};
  add_headers(columns, "objective ", contents.problem.objectives);
  columns.insert(columns.end(), {"feasible_share", "diversity", "seconds [s]", "hypervolume", "spread", "igd_plus"});
  CsvTable table(columns);
  for (std::size_t s = 0; s < contents.stages.size(); ++s) {
    const StageRecord& stage = contents.stages[s];
    const GenerationRecords& list = stage.generations;
    for (std::size_t g = 0; g < list.size(); ++g) {
      table.row(s + 1, g, list.end_of(g, stage.table.size()));
      if (list.best_row[g] < 0) {
        table.add_empty(1 + contents.problem.objectives.size());
      } else {
        table.add(list.best_row[g]);
        table.add(stage.table.objective_row(static_cast<std::size_t>(list.best_row[g])));
      }
      for (const double value : {list.feasible_share[g], list.diversity[g], list.seconds[g]}) table.add(value);
      for (const auto indicator : {&FrontRecord::hypervolume, &FrontRecord::spread, &FrontRecord::igd_plus})
        if (stage.front && g < (*stage.front.*indicator).size())
          table.add((*stage.front.*indicator)[g]);
        else
          table.add_empty(1);
    }
  }
  return table;
}

CsvTable populations(const StudyContents& contents) {
  CsvTable table({"stage", "generation", "individual", "evaluation"});
  for (std::size_t s = 0; s < contents.stages.size(); ++s) {
    const GenerationRecords& list = contents.stages[s].generations;
    for (std::size_t g = 0; g < list.size(); ++g) {
      const auto population = list.population_of(g);
      for (std::size_t k = 0; k < population.size(); ++k) table.row(s + 1, g, k + 1, population[k]);
    }
  }
  return table;
}

CsvTable best(const StudyContents& contents) {
  std::vector<std::pair<std::string, DesignRecord>> designs;
  const auto& final = contents.final;
  if (!final || !final->best) designs.emplace_back("best", best_so_far(contents).value());
  if (final) {
    const auto add = [&](const char* name, const std::optional<DesignRecord>& record) {
      if (record) designs.emplace_back(name, *record);
    };
    add("best", final->best);
    add("rounded", final->rounded);
    add("baseline", final->baseline);
    add("best_exact", final->best_exact);
    add("baseline_exact", final->baseline_exact);
  }
  Names columns = {"kind", "name", "unit"};
  for (const auto& [name, design] : designs) columns.push_back(name);
  CsvTable table(columns);
  const auto add_rows = [&](const auto& items, std::vector<double> DesignRecord::*values, const auto& kind) {
    for (std::size_t i = 0; i < items.size(); ++i) {
      table.row(kind(items[i]), items[i].name, items[i].unit);
      for (const auto& entry : designs) table.add((entry.second.*values)[i]);
    }
  };
  const ProblemRecord& problem = contents.problem;
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    const ParameterRecord& p = problem.parameters[i];
    table.row(p.variable < 0 ? "parameter" : "variable", p.name, p.unit);
    for (const auto& [label, design] : designs)
      if (p.variable < 0)
        table.add(design.parameters[i]);
      else
        add_variable(table, problem, static_cast<std::size_t>(p.variable), design.parameters[i]);
  }
  add_rows(problem.objectives, &DesignRecord::objectives, [](const auto&) { return "objective"; });
  add_rows(problem.margins, &DesignRecord::margins, [](const auto&) { return "margin"; });
  add_rows(problem.reports, &DesignRecord::reports, [](const auto&) { return "output"; });
  const auto add_bounds = [&](const char* name, double VolumeBounds::*end) {
    if (std::ranges::none_of(designs, [](const auto& entry) { return entry.second.certified.has_value(); })) return;
    table.row("workspace", name, final->volume_unit);
    for (const auto& [label, design] : designs)
      design.certified ? table.add((*design.certified).*end) : table.add_empty(1);
  };
  if (final) {
    table.row("workspace", "volume", final->volume_unit);
    for (const auto& entry : designs) table.add(entry.second.volume);
    add_bounds("volume at least", &VolumeBounds::lower);
    add_bounds("volume at most", &VolumeBounds::upper);
  }
  table.row("status", "status", "");
  for (const auto& entry : designs) table.add(words(entry.second.status));
  return table;
}

CsvTable front(const StudyContents& contents) {
  const ProblemRecord& problem = contents.problem;
  Names columns = {"stage", "point", "evaluation", "knee", "compromise"};
  add_headers(columns, "objective ", problem.objectives);
  add_headers(columns, "", problem.variables);
  CsvTable table(columns);
  for (std::size_t s = 0; s < contents.stages.size(); ++s) {
    const StageRecord& stage = contents.stages[s];
    if (!stage.has_front()) continue;
    const std::vector<std::int64_t>& rows = stage.front->rows;
    const Scores scores = scores_of(problem.objectives, stage.table, rows);
    std::vector<bool> knee(rows.size());
    for (const std::size_t k : knees(scores)) knee[k] = true;
    const std::size_t compromise_point = compromise(scores);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const auto row = static_cast<std::size_t>(rows[k]);
      table.row(s + 1, k + 1, rows[k], bool{knee[k]}, k == compromise_point, stage.table.objective_row(row));
      add_design(table, problem, stage.table.design(row));
    }
  }
  return table;
}

}  // namespace

std::vector<NamedTable> study_tables(const StudyContents& contents) {
  std::vector<NamedTable> tables = {{"evaluations.csv", evaluations(contents)},
                                    {"generations.csv", generations(contents)},
                                    {"populations.csv", populations(contents)}};
  if (contents.best.row >= 0) tables.push_back({"best.csv", best(contents)});
  if (std::ranges::any_of(contents.stages, &StageRecord::has_front)) tables.push_back({"front.csv", front(contents)});
  return tables;
}

}  // namespace pkm
