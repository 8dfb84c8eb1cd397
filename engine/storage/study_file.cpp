#include "engine/storage/study_file.hpp"

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/storage/file_header.hpp"
#include "engine/storage/safe_file.hpp"
#include "engine/storage/schema.hpp"
#include "engine/storage/subprocess_check.hpp"

namespace pkm {
namespace {

/// Throws ImageError if the condition is false.
/// @param problem  text of the message: what is wrong
void require(bool condition, const std::string& where, const char* problem) {
  if (!condition) throw ImageError(where + ": " + problem);
}

/// @return true if 0 <= values[0] <= values[1] <= ... <= last
bool ascends(const std::vector<std::int64_t>& values, std::size_t last) {
  return std::ranges::is_sorted(values) &&
         (values.empty() || (values.front() >= 0 && values.back() <= static_cast<std::int64_t>(last)));
}

bool is_row(std::int64_t row, std::size_t rows) { return row >= 0 && row < static_cast<std::int64_t>(rows); }
bool is_row_or_none(std::int64_t row, std::size_t rows) { return row == -1 || is_row(row, rows); }

void check_final(const FinalRecord& final, bool has_stages) {
  require(has_stages, "/final", "final results in a study without stages");
  for (const auto& [name, design] : {std::pair{"best", &final.best},
                                     {"rounded", &final.rounded},
                                     {"baseline", &final.baseline},
                                     {"best_exact", &final.best_exact},
                                     {"baseline_exact", &final.baseline_exact}})
    require(!*design || ((*design)->feasible_cells >= 0 && (*design)->feasible_cells <= (*design)->cells),
            std::string("/final/") + name, "feasible_cells is negative or larger than cells");
  if (final.map)
    for (const std::int64_t cells : final.map->voxels.cells) require(cells > 0, "/final/map", "cells is not positive");
}

/// Checks that parameters and variables correspond one to one, in any order.
void check_variables(const ProblemRecord& problem) {
  std::vector<bool> assigned(problem.variables.size(), false);
  for (const ParameterRecord& parameter : problem.parameters) {
    if (parameter.variable == -1) continue;
    require(is_row(parameter.variable, assigned.size()), "/problem/parameters", "variable: index out of range");
    const auto v = static_cast<std::size_t>(parameter.variable);
    require(!assigned[v], "/problem/parameters", "two parameters have the same variable");
    assigned[v] = true;
  }
  require(std::ranges::find(assigned, false) == assigned.end(), "/problem/variables", "a variable has no parameter");
}

/// Validates all indices and array lengths: before writing, so that no unreadable file is written, and after reading,
/// so that all other code may rely on them. Throws ImageError.
void check_indices(const StudyContents& study) {
  check_variables(study.problem);
  require(study.stages.empty() || !study.problem.objectives.empty(), "/problem/objectives", "no objective");
  for (std::size_t i = 0; i < study.stages.size(); ++i) {
    const std::string group = "/stages/" + std::to_string(i + 1);
    const StageRecord& stage = study.stages[i];
    const GenerationRecords& generations = stage.generations;
    const std::size_t rows = stage.table.size();
    require(
        generations.best_row.size() == generations.size() && generations.population_first.size() == generations.size(),
        group, "generations: arrays of different lengths");
    require(is_row_or_none(stage.best_row, rows), group, "best_row: row index out of range");
    std::int64_t next = 0;
    for (const StartOutcome& start : stage.starts) {
      require(start.first_row == next && start.rows > 0 && start.rows <= static_cast<std::int64_t>(rows) - next, group,
              "starts: rows overlap, leave a gap or exceed the evaluations");
      next += start.rows;
      require(start.end_row >= start.first_row && start.end_row < next, group, "starts: end_row out of range");
    }
    for (const UnmergedRun& ahead : stage.ahead) {
      const auto count = static_cast<std::int64_t>(ahead.table.size());
      require(ahead.number >= static_cast<std::int64_t>(stage.starts.size()) && count > 0, group,
              "ahead: a start is also in starts, or has no evaluations");
      require(!ahead.outcome || (ahead.outcome->first_row == 0 && ahead.outcome->rows == count &&
                                 is_row(ahead.outcome->end_row, ahead.table.size())),
              group, "ahead: row index out of range");
    }
    if (stage.optimality) {
      require(study.problem.objectives.size() == 1, group, "optimality is defined for single-objective studies only");
      require(stage.optimality->sensitivities.size() == study.problem.parameters.size(), group,
              "optimality: number of sensitivities differs from number of parameters");
    }
    if (stage.front) {
      for (const std::int64_t row : stage.front->rows)
        require(is_row(row, rows), group, "front: row index out of range");
      for (const auto* series : {&stage.front->hypervolume, &stage.front->spread, &stage.front->igd_plus})
        require(series->empty() || series->size() == generations.size(), group,
                "front: length of the indicators differs from number of generations");
      require(stage.front->reference.empty() || stage.front->reference.size() == study.problem.objectives.size(), group,
              "front: size of the reference point differs from number of objectives");
    }
    require(ascends(generations.first_row, rows), group, "generations: first_row is not ascending or out of range");
    require(ascends(generations.population_first, generations.population.size()), group,
            "generations: population_first is not ascending or out of range");
    for (const std::int64_t row : generations.best_row)
      require(is_row_or_none(row, rows), group, "generations: best_row: row index out of range");
    for (const std::int64_t row : generations.population)
      require(is_row(row, rows), group, "generations: population: row index out of range");
  }
  const BestRow& best = study.best;
  require(best.row == -1 || (is_row(best.stage, study.stages.size()) &&
                             is_row(best.row, study.stages[static_cast<std::size_t>(best.stage)].table.size())),
          "/best", "row index out of range");
  require(!study.final || !study.final->best || best.row >= 0, "/best", "row is -1, but /final/best exists");
  if (study.final) check_final(*study.final, !study.stages.empty());
}

}  // namespace

std::string serialise_study(const StudyContents& contents) {
  check_indices(contents);
  ImageWriter image(kHeaderBytes);
  schema::describe(image, contents);
  std::string bytes = image.finish();
  seal(bytes, kStudySchema);
  return bytes;
}

void write_study(const std::string& path, const StudyContents& contents, Existing existing) {
  std::string bytes;
  try {
    bytes = serialise_study(contents);
  } catch (const ImageError& error) {
    throw StorageError(path + ": cannot be written (" + error.what() + ")");
  }
  write_file(path, bytes, existing);
}

StudyContents parse_study(const std::string& bytes, int schema) {
  StudyContents contents;
  const ImageReader image(bytes, schema);
  schema::describe(image, contents);
  check_indices(contents);
  return contents;
}

StudyContents read_study(const std::string& path) {
  // Number of bytes that suffices to recognise a file of another format, however large it is.
  constexpr std::size_t kProbeBytes = std::size_t{1} << 16;
  std::string bytes = read_file(path, kProbeBytes);
  if (bytes.size() == kProbeBytes && has_study_header(bytes)) bytes = read_file(path);
  const int schema = verify_header(bytes, path, kStudySchema);
  try {
    check_in_subprocess(bytes, path);
    return parse_study(bytes, schema);
  } catch (const ImageError& error) {
    throw StorageError(path + ": does not conform to schema " + std::to_string(schema) + " (" + error.what() + ")");
  }
}

}  // namespace pkm
