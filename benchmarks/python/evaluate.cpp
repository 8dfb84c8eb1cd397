// The C++ side of evaluate.py: the time of ParallelEvaluator for the designs that Python evaluates in the same process.
#include <algorithm>
#include <chrono>
#include <exception>
#include <iostream>

#include "constraints/all.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/config/study.hpp"
#include "engine/problem/evaluator.hpp"
#include "objectives/all.hpp"

namespace pkm::benchmarks {
namespace {

/// A study, its evaluator and a table, which are kept from call to call like those of an optimiser.
struct Prepared {
  Study study;
  EvaluationTable table;
  ParallelEvaluator evaluator, on_one_thread;
};

Prepared& prepared(const char* toml) {
  static const Catalogues catalogues{all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()};
  static Prepared all = [toml] {
    Study study = read_study_toml(toml, "evaluate.toml", catalogues, std::nullopt, {});
    EvaluationTable table(study.problem->shape(Detail::complete));
    return Prepared{std::move(study), std::move(table), ParallelEvaluator(), ParallelEvaluator(1)};
  }();
  return all;
}

}  // namespace
}  // namespace pkm::benchmarks

/// Evaluates designs of a study, the one of the first call: a single design on this thread, several ones on all
/// threads.
/// @param designs     [count][variables]
/// @param objectives  [count][objectives]: receives the values
/// @return time of the evaluation [s], without that of copying; negative after an error, which is printed
extern "C" __attribute__((visibility("default"))) double pkm_evaluation_seconds(const char* toml, std::size_t count,
                                                                                const double* designs,
                                                                                double* objectives) try {
  auto& [study, table, evaluator, on_one_thread] = pkm::benchmarks::prepared(toml);
  table.truncate(0);
  table.extend(count);
  std::copy_n(designs, table.designs.size(), table.designs.begin());
  const auto begin = std::chrono::steady_clock::now();
  (count == 1 ? on_one_thread : evaluator).evaluate(*study.problem, table, 0);
  const auto end = std::chrono::steady_clock::now();
  std::ranges::copy(table.objectives, objectives);
  return std::chrono::duration<double>(end - begin).count();
} catch (const std::exception& error) {
  std::cerr << "pkm_evaluation_seconds: " << error.what() << '\n';
  return -1;
}
