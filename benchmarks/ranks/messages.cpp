// Cost of sharing the evaluations of a generation among ranks: mpirun -n 2 pkm_messages
//
// Measures the messages alone, and then the parallel efficiency of batches of 200 designs that take 30 ms each.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "engine/core/ranks.hpp"
#include "engine/problem/evaluator.hpp"
#include "engine/problem/row_exchange.hpp"

namespace pkm {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// A problem whose evaluation takes a given time.
class BusyProblem final : public Problem {
 public:
  explicit BusyProblem(double seconds)
      : seconds_(seconds), space_({{"a", "m", 0, 1}, {"b", "m", 0, 1}, {"c", "m", 0, 1}, {"d", "m", 0, 1}}) {}
  const DesignSpace& space() const override { return space_; }
  const std::vector<ObjectiveInfo>& objectives() const override { return objectives_; }
  const std::vector<MarginInfo>& margins() const override { return margins_; }
  const std::vector<OutputInfo>& reports() const override { return reports_; }
  void evaluate(std::span<const double> design, Scratch&, EvaluationSlot result) const override {
    const auto begin = Clock::now();
    do result.objectives[0] = design[0];
    while (seconds_since(begin) < seconds_);
    std::ranges::fill(result.margins, 1.0);
    result.status = Status::feasible;
  }

 private:
  double seconds_;
  DesignSpace space_;
  std::vector<ObjectiveInfo> objectives_ = {{"objective", "1", ""}};
  std::vector<MarginInfo> margins_ = {{"one", "1", ""}, {"two", "1", ""}, {"three", "1", ""}};
  std::vector<OutputInfo> reports_;
};

/// Exchanges the messages of a generation: the rows of all ranks, and the decision of rank 0. Returns the time [s].
double exchange(EvaluationTable& table) {
  const auto begin = Clock::now();
  const auto ranks = static_cast<std::size_t>(ranks::size()), own = static_cast<std::size_t>(ranks::rank());
  const std::size_t first = own * table.size() / ranks;
  std::string message;
  pack_rows(table, first, (own + 1) * table.size() / ranks - first, message);
  for (const std::string& each : ranks::all_gather(message))
    for (std::size_t at = 0; at < each.size();) unpack_rows(each, at, table);
  std::string decision = std::to_string(hash_of_rows(table, 0, table.size()));
  ranks::broadcast(decision);
  return seconds_since(begin);
}

void measure() {
  const bool prints = ranks::rank() == 0;
  for (const std::size_t rows : {100u, 1000u, 10000u}) {
    EvaluationTable table(BusyProblem(0).shape());
    table.extend(rows);
    std::vector<double> times;
    for (int i = 0; i < 301; ++i) times.push_back(exchange(table));
    std::ranges::nth_element(times, times.begin() + 150);
    if (prints) std::printf("%6zu rows: %8.1f us a generation in messages\n", rows, 1e6 * times[150]);
  }
  const BusyProblem problem(30e-3);
  ParallelEvaluator evaluator(1);
  EvaluationTable table(problem.shape());
  for (int batch = 0; batch < 3; ++batch) {
    const std::size_t first = table.extend(200);
    const auto begin = Clock::now();
    evaluator.evaluate(problem, table, first);
    const double wall = seconds_since(begin);
    double busy = 0;
    for (std::size_t row = first; row < table.size(); ++row) busy += static_cast<double>(table.seconds[row]);
    if (prints)
      std::printf("200 designs of 30 ms on %d ranks: %.3f s, efficiency %.1f %%\n", ranks::size(), wall,
                  100 * busy / (wall * ranks::size()));
  }
}

}  // namespace
}  // namespace pkm

int main() {
  const pkm::ranks::Group group;
  pkm::measure();
}
