// Runs one optimiser on one problem and records its reports.
#pragma once

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "engine/optimisers/optimiser.hpp"

namespace pkm::test {

/// Records every generation; stops the stage after generation `last`.
class Recorder final : public Monitor {
 public:
  explicit Recorder(std::int64_t last = std::numeric_limits<std::int64_t>::max()) : last_(last) {}

  bool generation(const Generation& generation) override {
    numbers.push_back(generation.number);
    first_rows.push_back(generation.first_row);
    sizes.push_back(generation.table->size());
    populations.push_back(*generation.population);
    best_rows.push_back(generation.best_row);
    starts = generation.starts ? *generation.starts : std::vector<StartOutcome>();
    if (generation.front) fronts.push_back(*generation.front);
    return generation.number < last_;
  }
  void warn(const std::string& sentence) override { warnings.push_back(sentence); }

  std::vector<std::int64_t> numbers, best_rows;
  std::vector<std::size_t> first_rows, sizes;
  std::vector<std::vector<std::int64_t>> populations;
  std::vector<StartOutcome> starts;  ///< finished starts at the last report
  std::vector<std::string> warnings;
  std::vector<Front> fronts;  ///< several objectives

 private:
  std::int64_t last_;
};

struct Outcome {
  EvaluationTable table;
  Recorder recorder;
  StageResult result;
};

inline const OptimiserEntry& entry(const std::string& name) {
  for (const OptimiserEntry& candidate : all_optimisers())
    if (candidate.name == name) return candidate;
  throw std::invalid_argument("no optimiser " + name);
}

/// Creates an optimiser with default options except `changes`.
inline std::unique_ptr<Optimiser> make(const OptimiserEntry& e, const Problem& problem,
                                       const std::vector<std::pair<std::string, OptionValue>>& changes = {}) {
  Options options = default_options(e.options);
  for (const auto& [name, value] : changes) options.set(name, value);
  return e.make(options, problem.space());
}

inline Outcome run(const Optimiser& optimiser, const Problem& problem, std::uint64_t seed = 1,
                   std::int64_t last = std::numeric_limits<std::int64_t>::max(), Evaluator* evaluator = nullptr,
                   const std::vector<std::vector<double>>& starts = {}) {
  ParallelEvaluator serial(1);
  Outcome outcome{EvaluationTable(problem.shape(optimiser.detail())), Recorder(last), {}};
  StageInput input{problem, evaluator ? *evaluator : serial, outcome.recorder, seed};
  for (const auto& design : starts) input.starts.push_back({design, "given"});
  outcome.result = optimiser.minimise(input, outcome.table);
  return outcome;
}

/// Resumes a stopped stage: its rows are replayed, and its finished starts are not run again.
inline Outcome resume(const Optimiser& optimiser, const Problem& problem, std::uint64_t seed, const Outcome& stopped,
                      std::int64_t last = std::numeric_limits<std::int64_t>::max(),
                      const std::vector<std::vector<double>>& starts = {}) {
  ParallelEvaluator serial(1);
  Outcome outcome{EvaluationTable(problem.shape(optimiser.detail())), Recorder(last), {}};
  StageInput input{problem, serial, outcome.recorder, seed};
  for (const auto& design : starts) input.starts.push_back({design, "given"});
  input.recorded = &stopped.table;
  input.recorded_starts = stopped.recorder.starts;
  input.recorded_unmerged_runs = stopped.result.ahead;
  outcome.result = optimiser.minimise(input, outcome.table);
  return outcome;
}

inline bool same_starts(const std::vector<StartOutcome>& a, const std::vector<StartOutcome>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const StartOutcome& x, const StartOutcome& y) {
    return x.origin == y.origin && x.first_row == y.first_row && x.rows == y.rows && x.end_row == y.end_row &&
           x.stop == y.stop && x.message == y.message &&
           std::memcmp(&x.optimality, &y.optimality, sizeof x.optimality) == 0;
  });
}

inline bool same_bits(const Front& a, const Front& b) {
  const auto same = [](double x, double y) { return std::memcmp(&x, &y, sizeof x) == 0; };
  return a.rows == b.rows && a.reference == b.reference && same(a.hypervolume, b.hypervolume) &&
         same(a.spread, b.spread) && same(a.igd_plus, b.igd_plus);
}

/// True if designs, results and their order are bit-identical; times may differ.
inline bool same_bits(const EvaluationTable& a, const EvaluationTable& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
  };
  return a.shape() == b.shape() && same(a.designs, b.designs) && same(a.objectives, b.objectives) &&
         same(a.margins, b.margins) && same(a.reports, b.reports) && same(a.derivatives, b.derivatives) &&
         same(a.status, b.status);
}

inline bool same_bits(const Outcome& a, const Outcome& b) {
  return same_bits(a.table, b.table) && a.recorder.populations == b.recorder.populations &&
         a.recorder.best_rows == b.recorder.best_rows && a.recorder.numbers == b.recorder.numbers &&
         a.recorder.first_rows == b.recorder.first_rows && a.result.reason == b.result.reason &&
         std::equal(a.recorder.fronts.begin(), a.recorder.fronts.end(), b.recorder.fronts.begin(),
                    b.recorder.fronts.end(), [](const Front& x, const Front& y) { return same_bits(x, y); }) &&
         a.result.best_row == b.result.best_row && same_starts(a.result.starts, b.result.starts);
}

}  // namespace pkm::test
