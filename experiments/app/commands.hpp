// The program's subcommands: one function each, which declares the command line and says what runs when it is chosen.
//
// To add one: a file of its own, a declaration here and a line in program.cpp. A command reports bad input by
// ConfigError and everything else by another exception; program_main turns both into one sentence on stderr and an exit
// code.
#pragma once

#include <string>

#include "engine/setup/study.hpp"

namespace CLI {
class App;
}

namespace pkm {

// What the program's exit code says.
inline constexpr int kDone = 0;
inline constexpr int kFailure = 1;
inline constexpr int kBadInput = 2;
inline constexpr int kStoppedEarly = 3;  ///< with a checkpoint to go on from

/// What every command is given, and gives back.
struct Session {
  const Catalogues& catalogues;
  std::string program;  ///< as it was called: "pkmopt", or the name of a user's own
  int exit_code = kDone;
};

/// Each adds its subcommand to `app`. `session` must outlive the parsing of the command line.
void add_run(CLI::App& app, Session& session);
void add_resume(CLI::App& app, Session& session);
void add_check(CLI::App& app, Session& session);
void add_evaluate(CLI::App& app, Session& session);
void add_pose(CLI::App& app, Session& session);
void add_forward(CLI::App& app, Session& session);
void add_dynamics(CLI::App& app, Session& session);
void add_coupling(CLI::App& app, Session& session);
void add_trajectory(CLI::App& app, Session& session);
void add_simulate(CLI::App& app, Session& session);
void add_workspace(CLI::App& app, Session& session);
void add_show(CLI::App& app, Session& session);
void add_report(CLI::App& app, Session& session);
void add_export(CLI::App& app, Session& session);
void add_list(CLI::App& app, Session& session);

}  // namespace pkm
