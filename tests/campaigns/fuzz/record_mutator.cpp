#include "tests/campaigns/fuzz/record_mutator.hpp"

#include <algorithm>

#include "engine/storage/file_header.hpp"
#include "engine/storage/hdf5_image.hpp"
#include "engine/storage/schema.hpp"
#include "engine/storage/study_file.hpp"

namespace pkm::fuzz {
namespace {

/// Appends a copy of the last element, or removes it.
template <class T>
void lengthen_or_shorten(std::vector<T>& list, bool longer) {
  if (longer)
    list.push_back(list.empty() ? T() : list.back());
  else if (!list.empty())
    list.pop_back();
}

void fit(DesignRecord& design, const ProblemRecord& problem) {
  design.parameters.resize(problem.parameters.size());
  design.objectives.resize(problem.objectives.size());
  design.margins.resize(problem.margins.size());
  design.reports.resize(problem.reports.size());
}

bool is_row(std::int64_t row, const StageRecord& stage) {
  return row >= 0 && row < static_cast<std::int64_t>(stage.table.size());
}

/// Resizes every array to the sizes of the problem. References to rows that do not exist are removed, because they
/// cannot be written.
void fit(StudyContents& study) {
  for (StageRecord& stage : study.stages) {
    EvaluationTable table(study.problem.shape(stage.table.shape().detail));
    table.extend(stage.table.size());
    table.status = stage.table.status;
    table.seconds = stage.table.seconds;
    stage.table = std::move(table);
    if (!stage.front) continue;
    const auto has_row = [&stage](std::int64_t row) { return is_row(row, stage); };
    if (study.problem.objectives.empty() || !std::ranges::all_of(stage.front->rows, has_row))
      stage.front.reset();
    else if (!stage.front->reference.empty())
      stage.front->reference.resize(study.problem.objectives.size());
  }
  const auto stages = static_cast<std::int64_t>(study.stages.size());
  if (study.best.stage < 0 || study.best.stage >= stages || !is_row(study.best.row, study.best_stage()))
    study.best = {};
  if (!study.final) return;
  FinalRecord& final = *study.final;
  for (auto* design : {&final.best, &final.rounded, &final.baseline, &final.best_exact, &final.baseline_exact})
    if (*design) fit(**design, study.problem);
}

void change(StudyContents& study, std::mt19937& engine) {
  ProblemRecord& problem = study.problem;
  const bool longer = engine() % 2 == 0;
  switch (engine() % 10) {
    case 0:
      return lengthen_or_shorten(problem.variables, longer);
    case 1:
      return lengthen_or_shorten(problem.objectives, longer);
    case 2:
      return lengthen_or_shorten(problem.margins, longer);
    case 3:
      return lengthen_or_shorten(problem.reports, longer);
    case 4:
      return lengthen_or_shorten(problem.parameters, longer);
    case 5:
      problem.mechanism = longer ? "3crr-r-cru" : "2t1r-p-hybrid";
      return;
    case 6:
      lengthen_or_shorten(study.stages, longer);
      if (study.best.stage >= static_cast<std::int64_t>(study.stages.size())) study.best = {};
      return;
    case 7:
      study.stages.clear();
      study.best = {};
      return;
    case 8:
      study.state = longer ? StudyState::interrupted : StudyState::finished;
      return;
    default:
      study.extensions.push_back({longer ? -1 : 7, "generations", 1e18});
  }
}

}  // namespace

std::string with_mutated_record(const std::string& file, int schema, std::mt19937& engine) {
  try {
    StudyContents study = parse_study(file, schema);  // throws for files that could not be written again
    change(study, engine);
    fit(study);
    ImageWriter writer(kHeaderBytes);
    schema::describe(writer, study);
    std::string changed = writer.finish();
    seal(changed, kStudySchema);
    return changed;
  } catch (const ImageError&) {
    return file;
  }
}

}  // namespace pkm::fuzz
