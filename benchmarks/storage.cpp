// Checkpoints: time to write (with both fsyncs) and read a study file in the folder for temporary files.
#include <filesystem>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "benchmarks/inputs.hpp"
#include "engine/math/random.hpp"
#include "engine/runner/records.hpp"
#include "engine/storage/study_file.hpp"

namespace pkm::benchmarks {
namespace {

/// A study of the paper's problem (four variables, one objective, one output) with random numbers, which compress no
/// better than real ones.
StudyContents study_of(std::int64_t generations, std::int64_t population) {
  const Study source = paper_study();
  const Problem& problem = *source.problem;
  StudyContents study = new_contents(source);
  StageRecord& stage = study.stages.emplace_back();
  stage.optimiser = "ga";
  stage.table = EvaluationTable(problem.shape());
  Stream stream(1, 0, 0, Stream::Use::start);
  for (std::int64_t g = 0; g < generations; ++g) {
    const std::size_t first = stage.table.extend(static_cast<std::size_t>(population));
    stage.generations.first_row.push_back(static_cast<std::int64_t>(first));
    stage.generations.population_first.push_back(static_cast<std::int64_t>(first));
    stage.generations.best_row.push_back(static_cast<std::int64_t>(first));
    stage.generations.feasible_share.push_back(1);
    stage.generations.diversity.push_back(stream.u01());
    stage.generations.seconds.push_back(0.01 * static_cast<double>(g));
    for (std::size_t row = first; row < stage.table.size(); ++row) {
      for (std::size_t i = 0; i < problem.space().dimension(); ++i)
        stage.table.design(row)[i] = problem.space().from_unit(i, stream.u01());
      const EvaluationSlot slot = stage.table.slot(row);
      for (const auto part : {slot.objectives, slot.margins, slot.reports})
        for (double& value : part) value = stream.u01();
      stage.table.status[row] = Status::feasible;
      stage.table.seconds[row] = static_cast<float>(2e-5 * stream.u01());
      stage.generations.population.push_back(static_cast<std::int64_t>(row));
    }
  }
  return study;
}

/// Path of a temporary file, which the destructor removes.
struct TemporaryFile {
  std::string path =
      (std::filesystem::temp_directory_path() / ("pkm-benchmark-" + std::to_string(getpid()) + ".h5")).string();
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

void write(benchmark::State& state) {
  const StudyContents study = study_of(state.range(0), state.range(1));
  const TemporaryFile file;
  for (auto _ : state) write_study(file.path, study);
  state.counters["bytes"] = static_cast<double>(std::filesystem::file_size(file.path));
}
void read(benchmark::State& state) {
  const TemporaryFile file;
  write_study(file.path, study_of(state.range(0), state.range(1)));
  for (auto _ : state) benchmark::DoNotOptimize(read_study(file.path).stages.size());
}
BENCHMARK(write)
    ->Name("checkpoint/write")
    ->ArgNames({"generations", "population"})
    ->Args({100, 20})
    ->Args({200, 1000})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(read)
    ->Name("checkpoint/read")
    ->ArgNames({"generations", "population"})
    ->Args({100, 20})
    ->Args({200, 1000})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace pkm::benchmarks
