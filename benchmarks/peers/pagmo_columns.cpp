// pagmo's optimisers on the exact volumes of pkmopt, to compare only the optimisers: pkm_peer_pagmo_columns TOOL
// STUDY.toml TARGET ACTION... (pagmo_search.hpp).
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

#include "benchmarks/peers/pagmo_search.hpp"
#include "constraints/all.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/config/study.hpp"
#include "objectives/all.hpp"

namespace {

using namespace pkm;

/// Ratio and constraint values of a design, feasible or not, because the penalty needs both.
peers::Candidate evaluate(const DesignProblem& problem, const std::vector<double>& design) {
  peers::Candidate candidate{0, std::vector<double>(problem.margins().size())};
  std::vector<double> reports(problem.reports().size());
  Status status = Status::failed;
  thread_local Scratch scratch;
  problem.evaluate(design, scratch, {{&candidate.ratio, 1}, candidate.margins, reports, status, Detail::complete});
  return candidate;
}

}  // namespace

int main(int count, char** arguments) {
  try {
    if (count < 5) throw std::invalid_argument("too few arguments; expected TOOL STUDY.toml TARGET ACTION...");
    const Study study =
        load_study_toml(arguments[2], {all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()});
    const DesignProblem& problem = *study.problem;
    peers::Task task;
    for (const Variable& variable : problem.space().variables()) {
      task.lower.push_back(variable.lower);
      task.upper.push_back(variable.upper);
    }
    task.constraints = problem.margins().size();
    task.evaluate = [&](const std::vector<double>& design) { return evaluate(problem, design); };
    task.target = std::stod(arguments[3]);
    peers::run_pagmo(arguments[1], task, {arguments + 4, arguments + count});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
