// What a study's evaluations will cost, said before it runs.

#include <algorithm>
#include <chrono>
#include <iostream>

#include "engine/core/printable.hpp"
#include "engine/core/ranks.hpp"
#include "experiments/app/run.hpp"

namespace pkm {
namespace {

/// What an evaluation takes [s]: in the middle of the design space or at the baseline, whichever takes longer, for a
/// design that cannot be evaluated takes no time.
double seconds_of_one(const Study& study, Detail detail) {
  const DesignProblem& problem = *study.problem;
  EvaluationTable table(problem.shape(detail));
  table.extend(study.baseline ? 2 : 1);
  for (std::size_t i = 0; i < problem.space().dimension(); ++i) {
    table.design(0)[i] = problem.space().from_unit(i, 0.5);
    if (study.baseline) table.design(1)[i] = (*study.baseline)[problem.parts().varies[i]];
  }
  using Clock = std::chrono::steady_clock;
  Scratch scratch;
  double longest = 0;
  for (std::size_t row = 0; row < table.size(); ++row) {
    double seconds = 1e30;
    for (int i = 0; i < 3 && (i == 0 || seconds < 1); ++i) {  // the first one also warms up
      const auto begin = Clock::now();
      problem.evaluate(table.design(row), scratch, table.slot(row));
      seconds = std::min(seconds, std::chrono::duration<double>(Clock::now() - begin).count());
    }
    longest = std::max(longest, seconds);
  }
  return longest;
}

}  // namespace

void print_estimate(const Study& study, int seeds, int threads_of_rank) {
  const int ranks = ranks::size(), threads = ranks * threads_of_rank;
  std::int64_t plain = 0, with_derivatives = 0;
  double plain_rounds = 0, derivative_rounds = 0;  // of evaluations side by side
  for (const auto& stage : study.stages) {
    const bool slopes = stage.optimiser->detail() == Detail::derivatives;
    const std::int64_t limit = stage.optimiser->evaluation_limit(*study.problem);
    const auto at_once = std::min<std::int64_t>(threads, stage.optimiser->at_once());
    (slopes ? with_derivatives : plain) += limit;
    (slopes ? derivative_rounds : plain_rounds) += static_cast<double>(limit) / static_cast<double>(at_once);
  }
  double together = 0;
  std::vector<std::string> parts;
  const auto add = [&](std::int64_t limit, const char* what, double seconds, double rounds) {
    parts.push_back(std::to_string(limit) + what + " of about " + duration_text(seconds));
    together += seconds * rounds;
  };
  if (plain > 0 || with_derivatives == 0)
    add(plain, " evaluations", seconds_of_one(study, Detail::complete), plain_rounds);
  if (with_derivatives > 0)
    add(with_derivatives, plain > 0 ? " with derivatives" : " evaluations with derivatives",
        seconds_of_one(study, Detail::derivatives), derivative_rounds);
  std::cout << printable(study.name) << ": at most " << join(parts, " and ");
  if (seeds > 1) std::cout << ", for each of " << seeds << " seeds";
  std::cout << ", together about " << duration_text(together * seeds) << " on "
            << (ranks > 1 ? std::to_string(ranks) + " ranks x " : "") << threads_of_rank
            << (threads_of_rank == 1 ? " thread" : " threads") << std::endl;  // at once, also into a pipe
}

}  // namespace pkm
