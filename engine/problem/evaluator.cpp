#include "engine/problem/evaluator.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <new>
#include <numeric>
#include <string>

#include "engine/core/error.hpp"
#include "engine/core/ranks.hpp"
#include "engine/core/stop.hpp"
#include "engine/problem/row_exchange.hpp"

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

constexpr float kNotEvaluated = -1;  // seconds of a row

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
    } catch (const Stopped&) {
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

// Rows of a rank where `count` are shared by index.
std::pair<std::size_t, std::size_t> share_of(std::size_t rank, std::size_t ranks, std::size_t first,
                                             std::size_t count) {
  return {first + rank * count / ranks, first + (rank + 1) * count / ranks};
}

// Where chunks of `count` rows begin, and the end: each a share of what is left, as share_pieces() has it, so that few
// claims keep everybody at work until the end.
std::vector<std::size_t> chunks_of(std::size_t count, std::size_t threads) {
  std::vector<std::size_t> begins = {0};
  while (begins.back() < count)
    begins.push_back(begins.back() + std::max<std::size_t>(1, (count - begins.back()) / (2 * threads)));
  return begins;
}

}  // namespace

void ParallelEvaluator::evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) {
  constexpr double kWorthMessages = 100e-6;  // s
  constexpr std::size_t kOutdated = 100;     // batches
  const std::size_t count = table.size() - first;
  Experience& known = experience_.at(static_cast<std::size_t>(table.shape().detail));
  const bool quick = known.each > 0 && known.each * static_cast<double>(count) < kWorthMessages;
  if (ranks::size() == 1 || count < 2 || (quick && ++known.alone < kOutdated)) {
    std::fill(table.seconds.begin() + static_cast<std::ptrdiff_t>(first), table.seconds.end(), kNotEvaluated);
    try {
      evaluate_here(problem, table, {first, table.size()}, seconds_each(table, first));
    } catch (const Stopped&) {  // what is complete up to the first row that is not can be resumed from
      const auto begin = table.seconds.begin();
      const auto left = std::find(begin + static_cast<std::ptrdiff_t>(first), table.seconds.end(), kNotEvaluated);
      table.truncate(static_cast<std::size_t>(left - begin));
      throw;
    }
    return;
  }
  evaluate_with_ranks(problem, table, first, known);
}

void ParallelEvaluator::evaluate_here(const Problem& problem, EvaluationTable& table, Rows rows, double each) {
  constexpr double kWorthSharing = 5e-6, kLong = 200e-6;  // s
  const auto [first, end] = rows;
  const std::size_t count = end - first;
  if (threads_ == 1 || (each > 0 && each * static_cast<double>(count) < kWorthSharing)) {
    Scratch& own = scratch_[worker()];
    const WithoutTeam alone;
    return evaluate_rows(problem, table, first, end, own);
  }
  with_team(threads_, [&, first = first, end = end] {
    const std::size_t team = workers(), rounds = (count + team - 1) / team;
    if (scratch_.size() < team) scratch_.resize(team);
    const bool uneven = 4 * count < 3 * rounds * team;  // shared out, a quarter of the threads' time would be waiting
    if (uneven && each > kLong) return evaluate_rows(problem, table, first, end, scratch_[worker()]);
    share_pieces(count, [&](std::size_t begin, std::size_t stop, std::size_t worker) {  // of one design, what is within
      evaluate_rows(problem, table, first + begin, first + stop, scratch_[worker]);
    });
  });
}

// Rows that nobody else takes, until none is left.
std::vector<ParallelEvaluator::Rows> ParallelEvaluator::claim_chunks(const Problem& problem, EvaluationTable& table,
                                                                     Rows rows) {
  const std::size_t threads = std::accumulate(threads_of_ranks_.begin(), threads_of_ranks_.end(), std::size_t{0});
  const std::vector<std::size_t> begins = chunks_of(rows.second - rows.first, threads);
  ranks::Counter claimed;
  std::vector<std::vector<Rows>> of_workers;
  with_team(threads_, [&] {
    const std::size_t team = workers();
    if (scratch_.size() < team) scratch_.resize(team);
    of_workers.resize(team);
    share_pieces(team, [&](std::size_t, std::size_t, std::size_t worker) {
      while (true) {
        const auto chunk = static_cast<std::size_t>(claimed.next());
        if (chunk + 1 >= begins.size()) return;
        const Rows mine{rows.first + begins[chunk], rows.first + begins[chunk + 1]};
        evaluate_rows(problem, table, mine.first, mine.second, scratch_[worker]);
        of_workers[worker].push_back(mine);
      }
    });
  });
  std::vector<Rows> all;
  for (const auto& each : of_workers) all.insert(all.end(), each.begin(), each.end());
  return all;
}

// A row that every rank has evaluated: whether they compute the same. They tell their threads as well.
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
    ranks::abandon("the design that rank 0 on " + ranks::host(0) + " begins with has other results here: the same " +
                   "program with the same libraries has to run on every host");
}

void ParallelEvaluator::evaluate_with_ranks(const Problem& problem, EvaluationTable& table, std::size_t first,
                                            Experience& known) {
  const auto ranks = static_cast<std::size_t>(ranks::size()), own = static_cast<std::size_t>(ranks::rank());
  Rows rows{first, table.size()};
  if (known.each == 0) {
    evaluate_here(problem, table, {first, first + 1}, 0);
    compare_ranks(table, rows.first++);
  }
  const std::size_t count = rows.second - rows.first;
  std::vector<Rows> done;
  if (known.uneven) {
    done = claim_chunks(problem, table, rows);
  } else {
    done = {share_of(own, ranks, rows.first, count)};
    evaluate_here(problem, table, done.front(), known.each);
  }
  if (rows.first > first && own == 0) done.push_back({first, first + 1});

  std::string message;
  for (const auto& [begin, end] : done) pack_rows(table, begin, end - begin, message);
  std::size_t came = 0;
  for (const std::string& each : ranks::all_gather(message))
    for (std::size_t at = 0; at < each.size();) came += unpack_rows(each, at, table);
  PKM_EXPECTS(came == table.size() - first);

  // The same on every rank from here on: the times have been exchanged.
  const auto time_of = [&](Rows of) {
    return std::accumulate(table.seconds.begin() + static_cast<std::ptrdiff_t>(of.first),
                           table.seconds.begin() + static_cast<std::ptrdiff_t>(of.second), 0.0);
  };
  constexpr double kWaiting = 0.05, kWorthClaiming = 1e-3;  // of all ranks' time; s
  constexpr double kLong = 0.1;  // s, of a thread: what may delay it is unknown, and claims are some 3 % of it at most
  double longest = 0, threads = 0;
  for (std::size_t rank = 0; rank < ranks; ++rank) {
    const auto team = static_cast<double>(threads_of_ranks_[rank]);
    longest = std::max(longest, time_of(share_of(rank, ranks, rows.first, count)) / team);
    threads += team;
  }
  const double all = time_of({first, table.size()}), even = all / threads;
  known = {.each = std::max(all / static_cast<double>(table.size() - first), 1e-9),
           .uneven = even > kLong || longest - even > std::max(kWaiting * even, kWorthClaiming)};
}

}  // namespace pkm
