#include "engine/problem/evaluator.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <new>

namespace pkm {
namespace {

using Clock = std::chrono::steady_clock;

// What is stored must not contradict its status: a feasible design has finite objectives and margins >= 0.
bool contradicts(const EvaluationSlot& slot) {
  if (slot.status == Status::failed || slot.status == Status::rejected) return false;
  if (std::ranges::any_of(slot.margins, [](double m) { return std::isnan(m); })) return true;
  if (slot.status == Status::infeasible) return false;
  return !std::ranges::all_of(slot.objectives, [](double x) { return std::isfinite(x); }) ||
         std::ranges::any_of(slot.margins, [](double m) { return !(m >= 0); });
}

// Rows [first, last), each with its time. One reading of the clock ends a row and begins the next.
void evaluate_rows(const Problem& problem, EvaluationTable& table, std::size_t first, std::size_t last,
                   Scratch& scratch) {
  auto begin = Clock::now();
  for (std::size_t row = first; row < last; ++row) {
    const EvaluationSlot slot = table.slot(row);
    try {
      problem.evaluate(static_cast<const EvaluationTable&>(table).design(row), scratch, slot);
      if (contradicts(slot)) slot.status = Status::failed;
    } catch (const std::bad_alloc&) {  // of the machine, not of this design
      throw;
    } catch (...) {  // whatever else went wrong belongs to this design alone
      constexpr double nan = std::numeric_limits<double>::quiet_NaN();
      for (const auto part : {slot.objectives, slot.margins, slot.reports}) std::ranges::fill(part, nan);
      slot.status = Status::failed;
    }
    const auto end = Clock::now();
    table.seconds[row] = std::chrono::duration<float>(end - begin).count();
    begin = end;
  }
}

// What a design takes on one thread, from those evaluated last; unknown: 0.
double seconds_each(const EvaluationTable& table, std::size_t first) {
  const std::size_t sample = std::min<std::size_t>(first, 100);
  double sum = 0;
  for (std::size_t row = first - sample; row < first; ++row) sum += static_cast<double>(table.seconds[row]);
  return sample > 0 ? sum / static_cast<double>(sample) : 0;
}

}  // namespace

void ParallelEvaluator::evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) {
  constexpr double kWorthSharing = 5e-6, kLong = 200e-6;  // s
  const std::size_t end = table.size(), count = end - first;
  const double each = seconds_each(table, first);
  if (threads_ == 1 || (each > 0 && each * static_cast<double>(count) < kWorthSharing)) {
    const WithoutTeam alone;
    return evaluate_rows(problem, table, first, end, scratch_.front());
  }
  with_team(threads_, [&] {
    const std::size_t team = workers(), rounds = (count + team - 1) / team;
    if (scratch_.size() < team) scratch_.resize(team);
    const bool uneven = 4 * count < 3 * rounds * team;  // shared out, a quarter of the threads' time would be waiting
    if (uneven && each > kLong) return evaluate_rows(problem, table, first, end, scratch_.front());
    share_pieces(count, [&](std::size_t begin, std::size_t stop, std::size_t worker) {  // of one design, what is within
      evaluate_rows(problem, table, first + begin, first + stop, scratch_[worker]);
    });
  });
}

}  // namespace pkm
