// Parallel evaluation and replay of recorded evaluations: reproducibility, exceptions, stops.
#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <stdexcept>

#include "engine/core/error.hpp"
#include "engine/core/stop.hpp"
#include "tests/unit/optimisers/known_problems.hpp"
#include "tests/unit/optimisers/stage.hpp"

namespace pkm::test {
namespace {

/// A table of `rows` designs with different values, not evaluated.
EvaluationTable unevaluated(const Problem& problem, std::size_t rows) {
  EvaluationTable table(problem.shape());
  table.extend(rows);
  for (std::size_t i = 0; i < table.designs.size(); ++i) table.designs[i] = 1e-3 * static_cast<double>(i % 997);
  return table;
}

TEST(Evaluator, ParallelEqualsSerialForAnyNumberOfThreads) {
  const auto problem = welded_beam();
  for (const std::size_t rows : {0, 1, 2, 19, 1000}) {
    EvaluationTable expected = unevaluated(problem, rows);
    ParallelEvaluator(1).evaluate(problem, expected, 0);
    for (const int threads : {0, 1, 2, 7}) {
      EvaluationTable table = unevaluated(problem, rows);
      ParallelEvaluator(threads).evaluate(problem, table, 0);
      EXPECT_TRUE(same_bits(table, expected)) << rows << " rows, " << threads << " threads";
    }
  }
}

TEST(Evaluator, DoesNotChangeEarlierRows) {
  const auto problem = sphere(2);
  for (const int threads : {1, 2}) {
    EvaluationTable table = unevaluated(problem, 50);
    ParallelEvaluator(threads).evaluate(problem, table, 20);
    for (std::size_t row = 0; row < 50; ++row) {
      EXPECT_EQ(table.status[row], row < 20 ? Status::failed : Status::feasible);
      EXPECT_EQ(std::isnan(table.objectives[row]), row < 20);
    }
  }
}

TEST(Evaluator, ADesignErrorFailsOnlyItsOwnRow) {
  const FunctionProblem problem(box(1, 0, 1), 1, [](std::span<const double> x, std::span<double> g) {
    g[0] = 1;
    if (x[0] > 0.0125 && x[0] < 0.0135) throw DesignError("no");
    return x[0];
  });
  for (const int threads : {1, 2, 7}) {
    EvaluationTable table = unevaluated(problem, 100);
    ParallelEvaluator(threads).evaluate(problem, table, 0);
    for (std::size_t row = 0; row < 100; ++row) {
      EXPECT_EQ(table.status[row], row == 13 ? Status::failed : Status::feasible) << row;
      if (row == 13) {
        EXPECT_TRUE(std::isnan(table.objectives[row]) && std::isnan(table.margins[row]));
      } else {
        EXPECT_EQ(table.objectives[row], table.designs[row]);
      }
    }
  }
}

template <class Error>
void expect_rethrown(const Error& error) {
  const FunctionProblem problem(box(1, 0, 1), 0, [&](std::span<const double> x, std::span<double>) {
    if (x[0] > 0.0125 && x[0] < 0.0135) throw error;
    return x[0];
  });
  for (const int threads : {1, 2, 7}) {
    EvaluationTable table = unevaluated(problem, 100);
    EXPECT_THROW(ParallelEvaluator(threads).evaluate(problem, table, 0), Error);
  }
}

TEST(Evaluator, OtherExceptionsAreRethrown) {
  expect_rethrown(std::bad_alloc());
  expect_rethrown(std::logic_error("a bug"));
  expect_rethrown(std::invalid_argument("a wrong argument"));
}

TEST(Evaluator, AStoppedBatchKeepsCompleteRowsAndCanBeResumed) {
  std::atomic<bool> stop_requested = false;
  const FunctionProblem problem(box(1, 0, 1), 0, [&](std::span<const double> x, std::span<double>) {
    if (x[0] > 0.0125 && x[0] < 0.0135) stop_requested = true;
    check_stop();
    return x[0];
  });
  for (const int threads : {1, 2, 7}) {
    EvaluationTable table = unevaluated(problem, 100);
    {
      const StopScope scope([&] { return stop_requested.load(); });
      EXPECT_THROW(ParallelEvaluator(threads).evaluate(problem, table, 0), Stopped);
    }
    EXPECT_LE(table.size(), 13u);
    for (std::size_t row = 0; row < table.size(); ++row) EXPECT_EQ(table.status[row], Status::feasible);
    EvaluationTable expected = unevaluated(problem, 100), resumed = unevaluated(problem, 100);
    ParallelEvaluator(1).evaluate(problem, expected, 0);
    ParallelEvaluator parallel(threads);
    ReplayEvaluator(parallel, table).evaluate(problem, resumed, 0);
    EXPECT_TRUE(same_bits(resumed, expected));
    stop_requested = false;
  }
}

TEST(Evaluator, InconsistentStatusBecomesFailed) {
  const auto status_of = [](double objective, double margin) {
    const FunctionProblem problem(box(1, 0, 1), 1, [=](std::span<const double>, std::span<double> g) {
      g[0] = margin;
      return objective;
    });
    EvaluationTable table = unevaluated(problem, 1);
    ParallelEvaluator(1).evaluate(problem, table, 0);
    return table.status[0];
  };
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(status_of(1, 0), Status::feasible);
  EXPECT_EQ(status_of(1, -1), Status::infeasible);
  EXPECT_EQ(status_of(nan, 1), Status::failed);
  EXPECT_EQ(status_of(infinity, 1), Status::failed);
  EXPECT_EQ(status_of(1, nan), Status::failed);  // a NaN margin is not satisfied
}

TEST(Evaluator, RecordsTheTimeOfEachDesign) {
  const FunctionProblem problem(box(1, 0, 1), 0, [](std::span<const double> x, std::span<double>) {
    double sum = 0;
    for (int i = 0; i < (x[0] == 0 ? 2000000 : 1); ++i) sum += std::sqrt(static_cast<double>(i));
    return sum;
  });
  EvaluationTable table = unevaluated(problem, 3);
  ParallelEvaluator(1).evaluate(problem, table, 0);
  EXPECT_GT(table.seconds[0], 0.0005f);
  EXPECT_LT(table.seconds[1], table.seconds[0]);
}

TEST(Replay, ReturnsRecordedRowsAndComputesTheRest) {
  const auto problem = welded_beam();
  EvaluationTable whole = unevaluated(problem, 30), record = unevaluated(problem, 20);
  ParallelEvaluator serial(1);
  serial.evaluate(problem, whole, 0);
  serial.evaluate(problem, record, 0);
  record.seconds.assign(20, 42);
  record.objectives[3] = -7;  // shows that the record is used
  ReplayEvaluator replay(serial, record);
  EvaluationTable table = unevaluated(problem, 12);
  replay.evaluate(problem, table, 0);
  table.extend(18);
  table.designs = whole.designs;
  replay.evaluate(problem, table, 12);
  EXPECT_EQ(table.objectives[3], -7);
  table.objectives[3] = whole.objectives[3];
  EXPECT_TRUE(same_bits(table, whole));
  EXPECT_EQ(table.seconds[19], 42);
  EXPECT_NE(table.seconds[20], 42);
}

TEST(Replay, ReportsTheRowOfADifferentDesign) {
  const auto problem = sphere(2);
  EvaluationTable record = unevaluated(problem, 5);
  ParallelEvaluator serial(1);
  serial.evaluate(problem, record, 0);
  EvaluationTable table = unevaluated(problem, 8);
  table.designs[9] = std::nextafter(table.designs[9], 1);
  try {
    ReplayEvaluator(serial, record).evaluate(problem, table, 0);
    FAIL() << "accepted";
  } catch (const ReplayMismatch& error) {
    EXPECT_STREQ(error.what(),
                 "recorded evaluation 4 differs from the design that the optimiser requests; the record cannot be "
                 "continued");
  }
}

TEST(Replay, RejectsARecordOfAnotherShape) {
  const auto problem = sphere(2);
  EvaluationTable record = unevaluated(sphere(3), 5);
  ParallelEvaluator serial(1);
  EvaluationTable table = unevaluated(problem, 5);
  EXPECT_THROW(ReplayEvaluator(serial, record).evaluate(problem, table, 0), ReplayMismatch);
}

}  // namespace
}  // namespace pkm::test
