// What `run` and `resume` have in common.
#pragma once

#include <memory>
#include <string>

#include "engine/problem/verdict.hpp"
#include "engine/study/run_study.hpp"
#include "experiments/app/commands.hpp"

namespace pkm {

struct RunningArguments {
  int threads = 0;
  bool quiet = false;
};

/// Declares --threads.
void add_threads(CLI::App& command, int& threads);
/// Declares --threads and --quiet.
void add_running_options(CLI::App& command, RunningArguments& arguments);

RunOptions run_options(const RunningArguments& arguments);
/// A bar or lines on stderr; nothing when quiet.
std::unique_ptr<Progress> make_progress(const RunningArguments& arguments);

/// A word for a shell: quoted where it needs to be.
std::string quoted(const std::string& word);
/// Sets the exit code where the study found nothing, and says so in a line on stderr when quiet.
void conclude(const std::optional<Verdict>& verdict, const RunningArguments& arguments, Session& session);
/// The end of a run, and what the program's exit code is for it.
void print_outcome(const RunOutcome& outcome, const Study& study, const std::string& file,
                   const RunningArguments& arguments, Session& session);

}  // namespace pkm
