#include "engine/problem/evaluator.hpp"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace pkm {
namespace {

using Clock = std::chrono::steady_clock;

// What is stored must not contradict its status: a feasible design has finite objectives and margins >= 0.
bool contradicts(const EvaluationSlot& slot) {
  if (slot.status == Status::failed || slot.status == Status::rejected) return false;
  const auto finite = [](double x) { return std::isfinite(x); };
  if (std::any_of(slot.margins.begin(), slot.margins.end(), [](double m) { return std::isnan(m); })) return true;
  if (slot.status == Status::infeasible) return false;
  return !std::all_of(slot.objectives.begin(), slot.objectives.end(), finite) ||
         std::any_of(slot.margins.begin(), slot.margins.end(), [](double m) { return !(m >= 0); });
}

void evaluate_row(const Problem& problem, EvaluationTable& table, std::size_t row) {
  const EvaluationSlot slot = table.slot(row);
  try {
    problem.evaluate(static_cast<const EvaluationTable&>(table).design(row), slot);
    if (contradicts(slot)) slot.status = Status::failed;
  } catch (...) {  // whatever went wrong belongs to this design alone
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto part : {slot.objectives, slot.margins, slot.reports}) std::fill(part.begin(), part.end(), nan);
    slot.status = Status::failed;
  }
}

// Rows [first, last), each with its time. One reading of the clock ends a row and begins the next.
void evaluate_rows(const Problem& problem, EvaluationTable& table, std::size_t first, std::size_t last) {
  auto begin = Clock::now();
  for (std::size_t row = first; row < last; ++row) {
    evaluate_row(problem, table, row);
    const auto end = Clock::now();
    table.seconds[row] = std::chrono::duration<float>(end - begin).count();
    begin = end;
  }
}

// What the batch from `first` on will take on one thread, from the designs evaluated just before it; unknown: infinite.
double expected_seconds(const EvaluationTable& table, std::size_t first) {
  if (first == 0) return std::numeric_limits<double>::infinity();
  const std::size_t sample = std::min<std::size_t>(first, 100);
  double sum = 0;
  for (std::size_t row = first - sample; row < first; ++row) sum += static_cast<double>(table.seconds[row]);
  return sum / static_cast<double>(sample) * static_cast<double>(table.size() - first);
}

constexpr double kWakeSeconds = 20e-6;  // a batch shorter than this is not worth waking a team for

}  // namespace

void SerialEvaluator::evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) {
  evaluate_rows(problem, table, first, table.size());
}

ParallelEvaluator::ParallelEvaluator(int threads) : threads_(threads > 0 ? threads : omp_get_num_procs()) {}

void ParallelEvaluator::evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) {
  const std::size_t end = table.size(), count = end - first;
  const auto team = std::min<std::size_t>(static_cast<std::size_t>(threads_), count);
  if (team <= 1 || expected_seconds(table, first) < kWakeSeconds) {
    evaluate_rows(problem, table, first, end);
    return;
  }
  // Handed out on demand, because designs differ in cost, and in pieces, so that threads seldom write one cache line.
  const std::size_t piece = std::clamp<std::size_t>(count / (team * 16), 1, 64);
#pragma omp parallel for num_threads(static_cast <int>(team)) schedule(dynamic)
  for (std::size_t begin = first; begin < end; begin += piece)
    evaluate_rows(problem, table, begin, std::min(begin + piece, end));
}

}  // namespace pkm
