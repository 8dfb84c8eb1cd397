#include "engine/problem/evaluator.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>
#include <string>

#include "engine/core/error.hpp"
#include "engine/core/ranks.hpp"
#include "engine/core/stop.hpp"
#include "engine/problem/row_exchange.hpp"

namespace pkm {
namespace {

using Clock = std::chrono::steady_clock;

// Whether the values are inconsistent with the status: a feasible design has finite objectives and margins >= 0, an
// infeasible one has no NaN margin.
bool is_inconsistent(const EvaluationSlot& slot) {
  if (slot.status == Status::failed || slot.status == Status::rejected) return false;
  if (std::ranges::any_of(slot.margins, [](double m) { return std::isnan(m); })) return true;
  if (slot.status == Status::infeasible) return false;
  return !std::ranges::all_of(slot.objectives, [](double x) { return std::isfinite(x); }) ||
         std::ranges::any_of(slot.margins, [](double m) { return !(m >= 0); });
}

constexpr float kNotEvaluated = -1;  // marks the time of a row that is not evaluated yet

std::span<const double> design_of(const EvaluationTable& table, std::size_t row) { return table.design(row); }

// Evaluates a design, except for the values of Problem::complete().
void begin_evaluation(const Problem& problem, std::span<const double> design, Scratch& scratch,
                      const EvaluationSlot& slot) {
  try {
    problem.evaluate(design, scratch, slot);
    if (is_inconsistent(slot)) slot.status = Status::failed;
  } catch (const DesignError&) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto part : {slot.objectives, slot.margins, slot.reports}) std::ranges::fill(part, nan);
    slot.status = Status::failed;
  }
}

// Evaluates rows [first, last) and records the time of each. One clock reading ends a row and starts the next. Rows
// that need Problem::complete() keep a negative time, kNotEvaluated - time. Throws Stopped.
void evaluate_rows(const Problem& problem, EvaluationTable& table, std::size_t first, std::size_t last,
                   Scratch& scratch) {
  // Number of rows between two checks for a stop request, if rows take microseconds; the evaluation of a longer row
  // checks itself.
  constexpr std::size_t kRowsPerCheck = 64;
  const bool is_complete = !problem.needs_completion();
  auto begin = Clock::now();
  for (std::size_t row = first; row < last; ++row) {
    if (row % kRowsPerCheck == 0) check_stop();
    begin_evaluation(problem, design_of(table, row), scratch, table.slot(row));
    const auto end = Clock::now();
    const float seconds = std::chrono::duration<float>(end - begin).count();
    table.seconds[row] = is_complete ? seconds : kNotEvaluated - seconds;
    begin = end;
  }
}

// Calls Problem::complete() for the rows of ranges [first, end), after evaluate_rows() has evaluated them, and sets
// their times.
void complete_rows(const Problem& problem, EvaluationTable& table,
                   const std::vector<std::pair<std::size_t, std::size_t>>& ranges) {
  if (!problem.needs_completion()) return;
  std::vector<EvaluatedDesign> rows;
  std::vector<float*> times;
  for (const auto& [first, end] : ranges)
    for (std::size_t row = first; row < end; ++row) {
      rows.push_back({design_of(table, row), table.slot(row)});
      times.push_back(&table.seconds[row]);
    }
  const auto set_times = [&] {
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (rows[k].is_complete) *times[k] = static_cast<float>(rows[k].seconds) + kNotEvaluated - *times[k];
  };
  try {
    problem.complete(rows);
  } catch (const Stopped&) {
    set_times();
    throw;
  }
  set_times();
}

// Mean single-thread time per design over the last 100 evaluations before row `first` [s]; 0: unknown.
double mean_seconds(const EvaluationTable& table, std::size_t first) {
  const std::size_t sample = std::min<std::size_t>(first, 100);
  double sum = 0;
  for (std::size_t row = first - sample; row < first; ++row) sum += static_cast<double>(table.seconds[row]);
  return sample > 0 ? sum / static_cast<double>(sample) : 0;
}

// Rows [first, end) that an MPI rank evaluates if `count` rows, from row `first` on, are distributed statically by
// index.
std::pair<std::size_t, std::size_t> static_share(std::size_t rank, std::size_t ranks, std::size_t first,
                                                 std::size_t count) {
  return {first + rank * count / ranks, first + (rank + 1) * count / ranks};
}

// Boundaries of the chunks of `count` rows, for guided self-scheduling: each chunk is a fixed fraction of the remaining
// rows, as in parallel_for(), so that few claims suffice and all threads finish at about the same time.
std::vector<std::size_t> chunk_bounds(std::size_t count, std::size_t threads) {
  std::vector<std::size_t> begins = {0};
  while (begins.back() < count)
    begins.push_back(begins.back() + std::max<std::size_t>(1, (count - begins.back()) / (2 * threads)));
  return begins;
}

}  // namespace

void evaluate_design(const Problem& problem, std::span<const double> design, Scratch& scratch,
                     const EvaluationSlot& slot) {
  begin_evaluation(problem, design, scratch, slot);
  if (!problem.needs_completion()) return;
  EvaluatedDesign row{design, slot};
  problem.complete({&row, 1});
}

void ParallelEvaluator::evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) {
  constexpr double kMinTimeForMessages = 100e-6;  // batch time below which communication does not pay off [s]
  constexpr std::size_t kMaxTimingAge = 100;      // local batches after which the timings are measured again
  const std::size_t count = table.size() - first;
  BatchTimings& timings = timings_.at(static_cast<std::size_t>(table.shape().detail));
  const double each = timings.seconds_per_design;
  const bool is_cheap = each > 0 && each * static_cast<double>(count) < kMinTimeForMessages;
  if (ranks::size() == 1 || count < 2 || (is_cheap && ++timings.local_batches < kMaxTimingAge)) {
    std::fill(table.seconds.begin() + static_cast<std::ptrdiff_t>(first), table.seconds.end(), kNotEvaluated);
    try {
      evaluate_here(problem, table, {first, table.size()}, mean_seconds(table, first));
    } catch (const Stopped&) {  // keep the rows before the first incomplete one, from which a resumed run continues
      const auto begin = table.seconds.begin();
      const auto left = std::find_if(begin + static_cast<std::ptrdiff_t>(first), table.seconds.end(),
                                     [](float seconds) { return seconds < 0; });
      table.truncate(static_cast<std::size_t>(left - begin));
      throw;
    }
    return;
  }
  evaluate_with_ranks(problem, table, first, timings);
}

void ParallelEvaluator::evaluate_here(const Problem& problem, EvaluationTable& table, Rows rows,
                                      double design_seconds) {
  // Times [s]: a batch that takes less than kMinBatchTime is faster on one thread; a single design that takes longer
  // than kMinDesignTime is evaluated faster by several threads.
  constexpr double kMinBatchTime = 5e-6, kMinDesignTime = 200e-6;
  const auto [first, end] = rows;
  const std::size_t count = end - first;
  if (threads_ == 1 || (design_seconds > 0 && design_seconds * static_cast<double>(count) < kMinBatchTime)) {
    Scratch& own = scratch_[worker()];
    {
      const SerialScope alone;
      evaluate_rows(problem, table, first, end, own);
    }
    return complete_rows(problem, table, {rows});
  }
  with_team(threads_, [&, first = first, end = end] {
    const std::size_t team = workers(), rounds = (count + team - 1) / team;
    if (scratch_.size() < team) scratch_.resize(team);
    // True if evaluating each design on one thread would leave the threads idle for more than a quarter of the time.
    const bool imbalanced = 4 * count < 3 * rounds * team;
    if (imbalanced && design_seconds > kMinDesignTime)
      return evaluate_rows(problem, table, first, end, scratch_[worker()]);
    parallel_for(count,
                 [&](std::size_t begin, std::size_t stop, std::size_t worker) {  // a single design may use all threads
                   evaluate_rows(problem, table, first + begin, first + stop, scratch_[worker]);
                 });
  });
  complete_rows(problem, table, {rows});
}

// Claims chunks of rows from the counter shared by all MPI ranks and evaluates them, until all rows are claimed.
// Returns the rows that this rank has evaluated.
std::vector<ParallelEvaluator::Rows> ParallelEvaluator::claim_chunks(const Problem& problem, EvaluationTable& table,
                                                                     Rows rows) {
  const std::size_t threads = std::accumulate(threads_of_ranks_.begin(), threads_of_ranks_.end(), std::size_t{0});
  const std::vector<std::size_t> begins = chunk_bounds(rows.second - rows.first, threads);
  ranks::Counter claimed;
  std::vector<std::vector<Rows>> by_worker;
  with_team(threads_, [&] {
    const std::size_t team = workers();
    if (scratch_.size() < team) scratch_.resize(team);
    by_worker.resize(team);
    parallel_for(team, [&](std::size_t, std::size_t, std::size_t worker) {
      while (true) {
        const auto chunk = static_cast<std::size_t>(claimed.next());
        if (chunk + 1 >= begins.size()) return;
        const Rows mine{rows.first + begins[chunk], rows.first + begins[chunk + 1]};
        evaluate_rows(problem, table, mine.first, mine.second, scratch_[worker]);
        by_worker[worker].push_back(mine);
      }
    });
  });
  std::vector<Rows> all;
  for (const auto& rows_of_worker : by_worker) all.insert(all.end(), rows_of_worker.begin(), rows_of_worker.end());
  complete_rows(problem, table, all);
  return all;
}

// Compares a row that every MPI rank has evaluated: all ranks must compute the same bits, otherwise the run is aborted.
// The ranks also exchange their numbers of threads.
void ParallelEvaluator::compare_ranks(const EvaluationTable& table, std::size_t row) {
  const std::uint64_t own[2] = {hash_of_rows(table, row, row + 1), static_cast<std::uint64_t>(threads_)};
  std::uint64_t first_hash = 0;
  threads_of_ranks_.clear();
  for (const std::string& message : ranks::all_gather({reinterpret_cast<const char*>(own), sizeof own})) {
    std::uint64_t others[2];
    std::memcpy(others, message.data(), sizeof others);
    if (threads_of_ranks_.empty()) first_hash = others[0];
    threads_of_ranks_.push_back(others[1]);
  }
  if (own[0] != first_hash)
    ranks::abort_all_ranks("the results of the first design of the batch differ from those on rank 0 (" +
                           ranks::host(0) + "); every host must run the same program with the same libraries");
}

void ParallelEvaluator::evaluate_with_ranks(const Problem& problem, EvaluationTable& table, std::size_t first,
                                            BatchTimings& timings) {
  const auto ranks = static_cast<std::size_t>(ranks::size()), own = static_cast<std::size_t>(ranks::rank());
  Rows rows{first, table.size()};
  if (timings.seconds_per_design == 0) {
    evaluate_here(problem, table, {first, first + 1}, 0);
    compare_ranks(table, rows.first++);
  }
  const std::size_t count = rows.second - rows.first;
  std::vector<Rows> done;
  if (timings.imbalanced) {
    done = claim_chunks(problem, table, rows);
  } else {
    done = {static_share(own, ranks, rows.first, count)};
    evaluate_here(problem, table, done.front(), timings.seconds_per_design);
  }
  if (rows.first > first && own == 0) done.push_back({first, first + 1});

  std::string message;
  for (const auto& [begin, end] : done) pack_rows(table, begin, end - begin, message);
  std::size_t received = 0;
  for (const std::string& each : ranks::all_gather(message))
    for (std::size_t at = 0; at < each.size();) received += unpack_rows(each, at, table);
  PKM_EXPECTS(received == table.size() - first);

  // All MPI ranks have received the evaluation times of all rows: from here on every rank computes the same timings.
  const auto seconds_of = [&](Rows of) {
    return std::accumulate(table.seconds.begin() + static_cast<std::ptrdiff_t>(of.first),
                           table.seconds.begin() + static_cast<std::ptrdiff_t>(of.second), 0.0);
  };
  // Idle time that is accepted before rows are distributed dynamically: relative to the mean time of the threads, and
  // absolute [s].
  constexpr double kMaxIdleShare = 0.05, kMinIdleTime = 1e-3;
  // Batches that take longer than this per thread are always distributed dynamically: unforeseen delays would cost more
  // than the messages for claiming rows (at most 3 %).
  constexpr double kMaxStaticTime = 0.1;  // [s]
  double longest = 0, threads = 0;
  for (std::size_t rank = 0; rank < ranks; ++rank) {
    const auto team = static_cast<double>(threads_of_ranks_[rank]);
    longest = std::max(longest, seconds_of(static_share(rank, ranks, rows.first, count)) / team);
    threads += team;
  }
  const double all = seconds_of({first, table.size()}), mean = all / threads;
  timings = {.seconds_per_design = std::max(all / static_cast<double>(table.size() - first), 1e-9),
             .imbalanced = mean > kMaxStaticTime || longest - mean > std::max(kMaxIdleShare * mean, kMinIdleTime)};
}

}  // namespace pkm
