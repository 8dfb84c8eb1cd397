// A sample study that contains every kind of item, and temporary folders, for tests of study files.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm::test {

/// A NaN with a payload, whose bits must be preserved.
inline double odd_nan() { return std::bit_cast<double>(std::uint64_t{0x7ff8dead00c0ffee}); }

/// A stage with generations of `population` designs each. The values are iterates of the logistic map, so that all
/// differ.
inline StageRecord sample_stage(const EvaluationShape& shape, std::int64_t generations, std::int64_t population) {
  StageRecord stage;
  stage.optimiser = "ga";
  stage.options = {"population = " + std::to_string(population), "crossover = sbx"};
  stage.table = EvaluationTable(shape);
  double value = 0.1;
  for (std::int64_t g = 0; g < generations; ++g) {
    const std::size_t first = stage.table.extend(static_cast<std::size_t>(population));
    GenerationRecords& records = stage.generations;
    records.first_row.push_back(static_cast<std::int64_t>(first));
    records.population_first.push_back(static_cast<std::int64_t>(records.population.size()));
    for (std::size_t row = first; row < stage.table.size(); ++row) {
      for (double& x : stage.table.design(row)) x = value = 3.9 * value * (1 - value);
      for (double& x : stage.table.slot(row).objectives) x = value = 3.9 * value * (1 - value);
      for (double& x : stage.table.slot(row).margins) x = 0.5 - (value = 3.9 * value * (1 - value));
      stage.table.status[row] = static_cast<Status>(row % 4);
      stage.table.seconds[row] = 1e-5f * static_cast<float>(row);
      records.population.push_back(static_cast<std::int64_t>(row));
    }
    records.best_row.push_back(static_cast<std::int64_t>(first));
    records.feasible_share.push_back(0.25);
    records.diversity.push_back(value);
    records.seconds.push_back(0.01 * static_cast<double>(g + 1));
  }
  return stage;
}

inline DesignRecord sample_design(double scale) {
  DesignRecord design;
  design.parameters = {0.2 * scale, 0.8 * scale, 2.5};
  design.objectives = {0.19 * scale};
  design.margins = {0.1 * scale, odd_nan()};
  design.reports = {0.5};
  design.status = Status::feasible;
  design.volume = 0.55 * scale;
  design.cells = 65280;
  design.feasible_cells = 12412;
  design.cell_volume = 4.4e-5;
  design.touches_box = true;
  return design;
}

inline StudyContents sample_study() {
  StudyContents study;
  study.name = "Größe, 4PPa-2PaR <b>";
  study.toml = "[study]\nname = \"Größe\"  # with a long comment " + std::string(70000, '.') + "\n";
  study.toml_file = "wide.toml";
  study.description = {"# Größe\n" + std::string(70000, '.') + "\n", "delta.toml"};
  study.text_digest = "0123456789abcdef";
  study.seed = 0xfedcba9876543210;
  study.program_version = "0.1.0";
  study.program_revision = "abc123";
  study.algorithms = 3;
  study.machine = "a processor, 2 cores";
  study.created = "2026-01-02T03:04:05Z";
  study.updated = "2026-01-02T03:04:06Z";
  study.problem.mechanism = "4ppa-2par";
  study.problem.parameters = {{"a", "m", 0.2, 0}, {"b", "m", 0.8, 1}, {"L0", "m", 2.5, -1}};
  study.problem.variables = {{"a", "m", 0.1, 0.3, 0.001}, {"b", "m", 0.35, std::numeric_limits<double>::infinity(), 0}};
  study.problem.objectives = {{"workspace-ratio", "rad/m", "V / V_mech", Direction::maximise}};
  study.problem.margins = {{"workspace-shape", "m", "eq 21"}, {"rail-length", "m", "eq 18"}};
  study.problem.reports = {{"conditioning", "1", "mean"}};
  study.extensions = {{0, "generations", 200}, {1, "time", 1.5}};
  study.state = StudyState::interrupted;
  study.seconds = 12.5;
  study.stages.push_back(sample_stage(study.problem.shape(), 3, 4));
  EvaluationTable& table = study.stages[0].table;
  table.objectives[1] = odd_nan();
  table.margins[0] = -0.0;
  table.margins[3] = -std::numeric_limits<double>::infinity();
  table.designs[5] = std::numeric_limits<double>::denorm_min();
  study.stages[0].finished = true;
  study.stages[0].stop = "generation limit";
  study.stages[0].best_row = 8;
  study.stages[0].front = FrontRecord{{4, 0, 8}, {0.25}, {odd_nan(), 0.5, 0.75}, {0.1, 0.2, 0.3}, {3, 2, 1}};
  study.stages.push_back(sample_stage(study.problem.shape(), 0, 0));  // started, without evaluations
  study.stages[1].optimiser = "nlopt";
  study.stages[1].options.clear();
  study.stages.push_back(sample_stage(study.problem.shape(Detail::derivatives), 6, 1));
  StageRecord& solver = study.stages.back();
  solver.optimiser = "ipopt";
  double slope = 0.25;
  for (double& x : solver.table.derivatives) x = slope = 3.9 * slope * (1 - slope);
  solver.starts = {{"best of stage 1", 0, 2, 1, "converged", "optimal solution found", 3e-8},
                   {"Sobol point 1", 2, 3, 2, "time limit", "", odd_nan()}};
  solver.ahead = {{3, solver.table.slice(1, 4), {}},
                  {4, solver.table.slice(0, 2), StartOutcome{"Sobol point 3", 0, 2, 1, "converged", "", 1e-9}}};
  solver.optimality = OptimalityRecord{3e-8,
                                       {{"rail-length", "constraint", 0.2, "m"}, {"a", "upper bound", 1.5, "m"}},
                                       {{"a", "m", 1.5, odd_nan()}, {"b", "m", -2, odd_nan()}, {"L0", "m", 0.1, 0.3}}};
  study.notes = {"stage 3: start 1 began anew."};
  study.best = {0, 8};
  FinalRecord& final = study.final.emplace();
  final.best = sample_design(1);
  final.baseline = sample_design(0.5);
  final.baseline->status = Status::failed;
  final.baseline->reason = "does not assemble";
  final.best_exact = sample_design(0.25);
  final.map = MapRecord{
      {{0, 1, 1, 0, 1, 0}, {1, 2, 3}, {0, -1.3, -1.5}, {0.8, -0.1, 1.5}}, {"x", "z", "theta"}, {"m", "m", "rad"}};
  final.volume_unit = "m^2 rad";
  final.active = {"a at its upper bound", "rail-length"};
  return study;
}

/// A temporary folder, removed with its contents at the end of the test.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "pkm-storage-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }
  /// Names of the entries, in alphabetical order.
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) names.push_back(entry.path().filename());
    std::ranges::sort(names);
    return names;
  }

 private:
  std::string path_;
};

/// @return the bytes of a file
inline std::string slurp(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Writes bytes to a file, replacing its contents.
inline void spill(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

/// @return the message of the StorageError that `action` throws; "" if it throws none
template <class F>
std::string storage_error(F&& action) {
  try {
    action();
  } catch (const StorageError& error) {
    return error.what();
  }
  return "";
}

}  // namespace pkm::test
