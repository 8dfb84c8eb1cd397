// What `run` and `resume` have in common.
#pragma once

#include <memory>
#include <string>

#include "engine/study/run_study.hpp"
#include "experiments/app/commands.hpp"

namespace pkm {

struct RunningArguments {
  int threads = 0;
  std::string time;
  bool quiet = false;
};

/// Declares --threads.
void add_threads(CLI::App& command, int& threads);
/// Declares --threads, --time and --quiet.
void add_running_options(CLI::App& command, RunningArguments& arguments);

/// Threads of this rank.
int threads_of(const RunningArguments& arguments);
/// Warns of more threads than cores.
RunOptions run_options(const RunningArguments& arguments, const Session& session);
/// A bar or lines on stderr; nothing when quiet.
std::unique_ptr<Progress> make_progress(const RunningArguments& arguments);

/// A word for a shell: quoted where it needs to be.
std::string quoted(const std::string& word);
/// The end of a run, and what the program's exit code is for it.
void print_outcome(const RunOutcome& outcome, const Study& study, const std::string& file,
                   const RunningArguments& arguments, Session& session);

}  // namespace pkm
