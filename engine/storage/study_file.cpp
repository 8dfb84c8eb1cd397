#include "engine/storage/study_file.hpp"

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/storage/contained_reading.hpp"
#include "engine/storage/file_seal.hpp"
#include "engine/storage/safe_file.hpp"
#include "engine/storage/schema.hpp"

namespace pkm {
namespace {

void require(bool holds, const std::string& where, const char* what) {
  if (!holds) throw ImageError(where + ": " + what);
}

/// True when 0 <= values[0] <= values[1] <= ... <= last.
bool ascends(const std::vector<std::int64_t>& values, std::size_t last) {
  return std::ranges::is_sorted(values) &&
         (values.empty() || (values.front() >= 0 && values.back() <= static_cast<std::int64_t>(last)));
}

bool is_row(std::int64_t row, std::size_t rows) { return row >= 0 && row < static_cast<std::int64_t>(rows); }
bool is_row_or_none(std::int64_t row, std::size_t rows) { return row == -1 || is_row(row, rows); }

void check_final(const FinalRecord& final, bool has_stages) {
  require(has_stages, "/final", "a study without stages has none");
  for (const auto& [name, design] : {std::pair{"best", &final.best},
                                     {"rounded", &final.rounded},
                                     {"baseline", &final.baseline},
                                     {"best_exact", &final.best_exact},
                                     {"baseline_exact", &final.baseline_exact}})
    require(!*design || ((*design)->feasible_cells >= 0 && (*design)->feasible_cells <= (*design)->cells),
            std::string("/final/") + name, "has more feasible cells than cells, or fewer than 0");
  if (final.map)
    for (const std::int64_t cells : final.map->voxels.cells) require(cells > 0, "/final/map", "has no cells");
}

/// One parameter for each variable, in any order.
void check_variables(const ProblemRecord& problem) {
  std::vector<bool> varied(problem.variables.size(), false);
  for (const ParameterRecord& parameter : problem.parameters) {
    if (parameter.variable == -1) continue;
    require(is_row(parameter.variable, varied.size()), "/problem/parameters", "variable is no index of a variable");
    const auto v = static_cast<std::size_t>(parameter.variable);
    require(!varied[v], "/problem/parameters", "two parameters have one variable");
    varied[v] = true;
  }
  require(std::ranges::find(varied, false) == varied.end(), "/problem/variables", "one is no parameter's");
}

/// Every index points at something: checked before writing, because nothing could read such a file, and after reading,
/// so that nobody after this has to ask.
void check_indices(const StudyContents& study) {
  check_variables(study.problem);
  require(study.stages.empty() || !study.problem.objectives.empty(), "/problem/objectives", "there are none");
  for (std::size_t i = 0; i < study.stages.size(); ++i) {
    const std::string group = "/stages/" + std::to_string(i + 1);
    const StageRecord& stage = study.stages[i];
    const GenerationRecords& generations = stage.generations;
    const std::size_t rows = stage.table.size();
    require(
        generations.best_row.size() == generations.size() && generations.population_first.size() == generations.size(),
        group, "generations have arrays of different lengths");
    require(is_row_or_none(stage.best_row, rows), group, "best_row is no row of evaluations");
    std::int64_t next = 0;
    for (const StartOutcome& start : stage.starts) {
      require(start.first_row == next && start.rows > 0 && start.rows <= static_cast<std::int64_t>(rows) - next, group,
              "starts do not follow one another within evaluations");
      next += start.rows;
      require(start.end_row >= start.first_row && start.end_row < next, group, "a start's end is not among its rows");
    }
    for (const StartAhead& ahead : stage.ahead) {
      const auto known = static_cast<std::int64_t>(ahead.table.size());
      require(ahead.number >= static_cast<std::int64_t>(stage.starts.size()) && known > 0, group,
              "a start ahead of the others is one of them, or has no evaluations");
      require(!ahead.outcome || (ahead.outcome->first_row == 0 && ahead.outcome->rows == known &&
                                 is_row(ahead.outcome->end_row, ahead.table.size())),
              group, "the end of a start ahead of the others is not among its rows");
    }
    if (stage.optimality) {
      require(study.problem.objectives.size() == 1, group, "optimality is there of studies with one objective only");
      require(stage.optimality->sensitivities.size() == study.problem.parameters.size(), group,
              "optimality has not one sensitivity per parameter");
    }
    if (stage.front) {
      for (const std::int64_t row : stage.front->rows)
        require(is_row(row, rows), group, "the front holds what is no row of evaluations");
      for (const auto* series : {&stage.front->hypervolume, &stage.front->spread, &stage.front->igd_plus})
        require(series->empty() || series->size() == generations.size(), group,
                "the front's indicators have another length than generations");
      require(stage.front->reference.empty() || stage.front->reference.size() == study.problem.objectives.size(), group,
              "the front's reference has not one value per objective");
    }
    require(ascends(generations.first_row, rows), group, "first_row does not ascend within evaluations");
    require(ascends(generations.population_first, generations.population.size()), group,
            "population_first does not ascend within population");
    for (const std::int64_t row : generations.best_row)
      require(is_row_or_none(row, rows), group, "best_row is no row of evaluations");
    for (const std::int64_t row : generations.population)
      require(is_row(row, rows), group, "population holds what is no row of evaluations");
  }
  const BestRow& best = study.best;
  require(best.row == -1 || (is_row(best.stage, study.stages.size()) &&
                             is_row(best.row, study.stages[static_cast<std::size_t>(best.stage)].table.size())),
          "/best", "row is no row of evaluations");
  require(!study.final || !study.final->best || best.row >= 0, "/best", "there is none, but in /final there is one");
  if (study.final) check_final(*study.final, !study.stages.empty());
}

}  // namespace

std::string pack_study(const StudyContents& contents) {
  check_indices(contents);
  ImageWriter image(kSealBytes);
  schema::describe(image, contents);
  std::string bytes = image.finish();
  seal(bytes, kStudySchema);
  return bytes;
}

void write_study(const std::string& path, const StudyContents& contents, Existing existing) {
  std::string bytes;
  try {
    bytes = pack_study(contents);
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
  constexpr std::size_t kBeginning = std::size_t{1} << 16;  // tells what kind of file it is, however large
  std::string bytes = read_file(path, kBeginning);
  if (bytes.size() == kBeginning && is_sealed(bytes)) bytes = read_file(path);
  const int schema = verify_seal(bytes, path, kStudySchema);
  try {
    check_contained(bytes, path);
    return parse_study(bytes, schema);
  } catch (const ImageError& error) {
    throw StorageError(path + ": not laid out as schema " + std::to_string(schema) + " says (" + error.what() + ")");
  }
}

}  // namespace pkm
