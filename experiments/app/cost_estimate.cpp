// Estimate of the run time of a study, measured and printed before it runs.

#include <iostream>

#include "engine/core/printable.hpp"
#include "engine/core/ranks.hpp"
#include "engine/core/stop.hpp"
#include "experiments/app/run.hpp"

namespace pkm {

RunCost measured_cost(const Study& study, const Session& session) {
  const SlowStepNotice slow = announce_slow_step(session, "measuring the time of an evaluation");
  return measure_run_cost(study);
}

void print_estimate(const Study& study, const RunCost& cost, int seeds, int threads_of_rank) {
  const int ranks = ranks::size(), threads = ranks * threads_of_rank;
  std::int64_t plain = 0, with_derivatives = 0;
  for (const auto& stage : study.stages)
    (stage.optimiser->detail() == Detail::derivatives ? with_derivatives : plain) +=
        stage.optimiser->evaluation_limit(*study.problem);
  std::vector<std::string> parts;
  bool is_lower_bound = false;
  const auto add = [&](std::int64_t limit, const char* what, double seconds) {
    const bool is_longer = seconds >= RunCost::kTimeLimit;
    is_lower_bound = is_lower_bound || is_longer;
    parts.push_back(std::to_string(limit) + what + (is_longer ? " of more than " : " of about ") +
                    duration_text(seconds));
  };
  if (plain > 0 || with_derivatives == 0) add(plain, " evaluations", cost.plain);
  if (with_derivatives > 0)
    add(with_derivatives, plain > 0 ? " with derivatives" : " evaluations with derivatives", cost.with_derivatives);
  const double together = max_stage_seconds(study, cost, threads) + cost.final_steps;
  std::cout << printable(study.name) << ": at most " << join(parts, " and ");
  if (seeds > 1) std::cout << ", for each of " << seeds << " seeds";
  std::cout << ", together " << (is_lower_bound ? "more than " : "about ") << duration_text(together * seeds) << " on "
            << (ranks > 1 ? std::to_string(ranks) + " ranks x " : "") << threads_of_rank
            << (threads_of_rank == 1 ? " thread" : " threads");
  for (const RunCost::LongStep& step : cost.long_steps)
    std::cout << ", then " << step.what << " in at most " << duration_text(step.seconds);
  std::cout << std::endl;  // std::endl flushes the stream, so that the text appears immediately, also in a pipe
}

}  // namespace pkm
