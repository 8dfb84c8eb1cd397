// Selection of the design that a command works on, by MECHANISM|FILE.toml or --from F.h5, --set and further options;
// and other options that several commands share.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/export/csv_table.hpp"
#include "engine/results/chosen_design.hpp"
#include "experiments/app/next_step.hpp"
#include "experiments/app/print.hpp"

namespace pkm {

struct DesignArguments {
  std::string target;            ///< name of a mechanism, or path of a mechanism file or a study
  std::vector<std::string> set;  ///< values of --set, lists of NAME=VALUE
  StudyChanges changes;          ///< changes to limits and, for some commands, to numbers of cells
  std::string masses;   ///< name of the mass model; "": that of the study or, without a study, the mechanism's default
  std::string from;     ///< name of a study file that contains the design, instead of `target`; "": none
  DesignChoice choice;  ///< selects the design of the study file
  bool json = false;
};

/// Declares --baseline, --generation, --individual, --front and --stage.
void add_choice_options(CLI::App& command, DesignChoice& choice);
/// Name of the first option that selects a design (--baseline, --front ..) and that the command line gives; nullptr if
/// it gives none.
const char* first_given_option(const DesignChoice& choice);

/// Declares an option such as --at, whose value is a list of NAME=VALUE, separated by commas. The option can be
/// repeated.
CLI::Option* add_list_option(CLI::App& command, const std::string& option, std::vector<std::string>& lists,
                             const std::string& meaning);

/// Declares --cells, whose value is one number for all axes, or NAME=CELLS for single ones.
void add_cells_option(CLI::App& command, std::vector<std::string>& lists, const std::string& meaning);
/// Declares --limit.
void add_limit_option(CLI::App& command, std::vector<std::string>& lists);
/// Declares --set, --limit and --cells, which override values of a study to be run.
void add_change_options(CLI::App& command, StudyChanges& changes);

struct ModeArguments {
  std::string mode;    ///< name of the working mode; "": the default mode
  std::string branch;  ///< sign of the required assembly branch; "": that of the mode
};

/// Declares --mode and --branch.
void add_mode_options(CLI::App& command, ModeArguments& arguments);
/// The name of the selected working mode, including the branch. Throws ConfigError if the mechanism does not have it.
std::string parse_mode(const MechanismInfo& info, const ModeArguments& arguments);

/// Values of --at, --velocity and --acceleration: a pose, and the first and second time derivatives of its coordinates.
struct MotionArguments : ModeArguments {
  std::vector<std::string> at, velocity, acceleration;
};
/// Parses the arguments. Rates that are not given are 0; inputs have their default values.
MotionSample parse_motion(const Mechanism& mechanism, const MotionArguments& arguments);

/// Returns a capability of the mechanism that a command needs. Throws ConfigError if the mechanism does not have it,
/// i.e. if `capability` is null.
/// @param what  name of the capability, for the message
template <class Capability>
const Capability& require_capability(const Capability* capability, const std::string& command, const std::string& what,
                                     const MechanismInfo& info) {
  if (!capability) throw ConfigError({}, command + " needs " + what + ", and mechanism " + info.name + " has none");
  return *capability;
}

/// Parses a relative gap of certified bounds, between 0 and 2. Throws ConfigError.
double parse_gap(const std::string& text, const std::string& option);

/// The design that a command works on, with its mechanism and study. Its parameters are those of the selected design of
/// a study file; for a study in TOML, those of its baseline or, without a baseline, of the study itself; for a
/// mechanism, the default values. --set overrides them.
struct Target : ChosenDesign {
  std::shared_ptr<const Mechanism> mechanism;
  std::optional<Study> study;      ///< the study that gives the design; std::nullopt: a mechanism without a study
  LimitSpec limits;                ///< limits of the study; if there is no study, no limits are set
  std::vector<std::string> files;  ///< names of the files that were read, which no output may overwrite

  const MechanismInfo& info() const { return mechanism->info(); }
  /// The study's plan of the workspace analysis or, without a study, columns over the whole reach of the design; in
  /// both cases under `limits`.
  WorkspacePlan plan() const;
};

/// The file that a command writes a table to, if the option --csv is given.
struct TableOutput {
  std::string csv;
  bool force = false;
};
/// Declares --csv and --force.
void add_table_output(CLI::App& command, TableOutput& output, const std::string& meaning);
void write_table(const TableOutput& output, const CsvTable& table);

/// Returns true if a word of the command line is meant as a file name: it ends in ".toml", or a file of this name
/// exists.
bool looks_like_file(const std::string& name);
/// Finds a built-in mechanism by its name, or reads a mechanism file. Throws ConfigError.
std::shared_ptr<const Mechanism> find_mechanism(const Catalogues& catalogues, const std::string& name);

/// Finds the [[motion]] of the study that has this name; if there is none, reads the motion file of this name. Throws
/// ConfigError.
std::shared_ptr<const Motion> find_motion(const Target& target, const std::string& name);

/// Finds the design. Throws ConfigError if there is no such mechanism, study or design, or if the parameters do not
/// give a valid mechanism.
Target find_target(const Session& session, const DesignArguments& arguments);

/// Declares the arguments that select a design.
/// @param arguments  receives the parsed values; must outlive `command`
void add_design_arguments(CLI::App& command, DesignArguments& arguments);
/// Declares the options that select a design of a study file or change the design (--set, --limit, --masses), and
/// --json.
void add_design_options(CLI::App& command, DesignArguments& arguments);

/// Adds a subcommand that analyses one design and prints the results.
/// @param run  run(Target, Arguments, Printout&): returns "", or an error message, which is printed after the results,
///             for exit code 1
template <class Arguments, class Run>
std::pair<CLI::App&, Arguments&> add_design_command(CLI::App& app, Session& session, const std::string& name,
                                                    const std::string& meaning, const std::string& footer, Run run) {
  const auto added =
      add_command<Arguments>(app, name, meaning, footer, [&session, run, name](const Arguments& arguments) {
        expect_toml(arguments.target, name + " --from", session);
        Printout out{.as_json = arguments.json};
        const SlowStepNotice slow = announce_slow_step(session, name + " is computing, Ctrl-C ends it");
        const std::string error = run(find_target(session, arguments), arguments, out);
        out.print();
        if (!error.empty()) throw std::runtime_error(error);
      });
  add_design_arguments(added.first, added.second);
  return added;
}

}  // namespace pkm
