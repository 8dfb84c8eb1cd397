// Study files of the C interface: their contents, and reports.
#include <algorithm>
#include <filesystem>

#include "bindings/c/handles.hpp"
#include "engine/report/html_page.hpp"
#include "engine/results/comparison.hpp"
#include "engine/runner/records.hpp"
#include "engine/storage/safe_file.hpp"
#include "engine/storage/study_file.hpp"
#include "engine/storage/study_lock.hpp"
#include "experiments/app/summary.hpp"
#include "experiments/app/version.hpp"

struct pkmopt_results {
  std::string path;
  pkm::StudyContents contents;
};

namespace pkm::c {
namespace {

const StageRecord& stage_of(const pkmopt_results& results, std::size_t stage) {
  const std::vector<StageRecord>& stages = results.contents.stages;
  if (stage >= stages.size())
    throw ConfigError({"", 0, "stage"}, std::to_string(stage), "less than " + std::to_string(stages.size()));
  return stages[stage];
}

/// The study of a file; throws StorageError with the file's name.
Study study_of_file(const StudyContents& contents, const std::string& path) {
  try {
    return study_of(contents, catalogues());
  } catch (const StorageError& error) {
    throw StorageError(path + ": " + error.what());
  }
}

}  // namespace
}  // namespace pkm::c

using namespace pkm::c;

pkmopt_status pkmopt_results_open(const char* path, pkmopt_results** results) {
  return guarded([&] {
    const std::string file = required_text(path, "path");
    auto made = std::make_unique<pkmopt_results>(pkmopt_results{file, pkm::read_study(file)});
    if (made->contents.state == pkm::StudyState::running && !pkm::StudyLock::holder(file))
      made->contents.state = pkm::StudyState::interrupted;
    *results = made.release();
  });
}

void pkmopt_results_free(pkmopt_results* results) { delete results; }

pkmopt_status pkmopt_results_info(const pkmopt_results* results, char** json) {
  return guarded([&] {
    const pkm::StudyContents& contents = results->contents;
    std::optional<pkm::Study> study;
    std::string why;
    try {
      study = study_of_file(contents, results->path);
    } catch (const std::runtime_error& error) {
      why = error.what();
    }
    const pkm::DesignProblem* const problem = study ? study->problem.get() : nullptr;
    Json info = pkm::summary_json(contents, pkm::diagnose(contents, problem), pkm::collect_failures(contents, problem));
    info["why_unreadable"] = why.empty() ? Json() : Json(why);
    info["tables"] = Json::array();
    for (const pkm::StageRecord& stage : contents.stages)
      info["tables"].push_back({{"optimiser", stage.optimiser},
                                {"rows", stage.table.size()},
                                {"generations", stage.generations.size()},
                                {"best_row", stage.best_row},
                                {"finished", stage.finished}});
    *json = allocated(info);
  });
}

pkmopt_status pkmopt_results_evaluations(const pkmopt_results* results, size_t stage, double* designs,
                                         double* objectives, double* margins, double* outputs, uint8_t* status,
                                         int64_t* generation, double* seconds) {
  return guarded([&] {
    const pkm::StageRecord& record = stage_of(*results, stage);
    const pkm::EvaluationTable& table = record.table;
    const auto copy = [](const auto& from, auto* to) {
      if (to) std::ranges::copy(from, to);
    };
    copy(table.designs, designs);
    copy(table.objectives, objectives);
    copy(table.margins, margins);
    copy(table.reports, outputs);
    copy(table.seconds, seconds);
    if (generation) copy(record.generations.generation_of_rows(table.size()), generation);
    for (std::size_t row = 0; status && row < table.size(); ++row)
      status[row] = static_cast<std::uint8_t>(table.status[row]);
  });
}

pkmopt_status pkmopt_results_population(const pkmopt_results* results, size_t stage, int64_t generation, size_t* count,
                                        int64_t** rows) {
  return guarded([&] {
    const pkm::StageRecord& record = stage_of(*results, stage);
    std::span<const std::int64_t> found;
    if (generation < 0) {
      if (record.front) found = record.front->rows;
    } else {
      if (static_cast<std::size_t>(generation) >= record.generations.size())
        throw pkm::ConfigError({"", 0, "generation"}, std::to_string(generation),
                               "less than " + std::to_string(record.generations.size()));
      found = record.generations.population_of(static_cast<std::size_t>(generation));
    }
    *count = found.size();
    if (!rows) return;
    *rows = allocated_array<std::int64_t>(found.size());
    std::ranges::copy(found, *rows);
  });
}

pkmopt_status pkmopt_results_study(const pkmopt_results* results, pkmopt_study** study) {
  return guarded([&] { *study = study_handle(study_of_file(results->contents, results->path)).release(); });
}

pkmopt_status pkmopt_report(size_t count, const char* const* paths, const char* output, int overwrite,
                            const pkmopt_options* options) {
  return guarded([&] {
    const std::string file = required_text(output, "output");
    refuse_existing(file, overwrite != 0);
    // Throws std::runtime_error now, before any evaluation, if this library was built without the files of the HTML
    // page.
    pkm::page_assets();
    std::vector<pkm::PageStudy> studies;
    for (std::size_t i = 0; i < count; ++i) {
      const std::string path = required_text(paths[i], "paths");
      if (path == file) throw pkm::ConfigError({"", 0, "output"}, "'" + file + "'", "another file than the study's");
      pkm::PageStudy page{std::filesystem::path(path).filename().string(), pkm::read_study(path), {}};
      try {
        page.study = study_of_file(page.contents, path);
      } catch (const std::runtime_error& error) {
        page.unreadable = error.what();
      }
      studies.push_back(std::move(page));
    }
    std::string page;
    with_options(options, true, [&] { page = pkm::html_page(pkm::page_data(studies, pkm::program_words())); });
    pkm::write_file(file, page, pkm::if_forced(overwrite != 0));
  });
}
