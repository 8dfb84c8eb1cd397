// What the commands that look at one design have in common: MECHANISM|FILE.toml or --from F.h5, --set and --json.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/report/chosen_design.hpp"
#include "engine/report/csv_table.hpp"
#include "experiments/app/next_step.hpp"
#include "experiments/app/print.hpp"

namespace pkm {

struct DesignArguments {
  std::string target;            ///< a mechanism's name, or the path of its description or of a study
  std::vector<std::string> set;  ///< lists of name=value
  StudyChanges changes;          ///< limits, and of some commands cells
  std::string masses;            ///< a mass model; "": the study's, else the mechanism's default
  std::string from;              ///< instead of `target`: a study file
  DesignChoice choice;           ///< which of the file's designs
  bool json = false;
};

/// Declares --baseline, --generation, --individual, --front and --stage.
void add_choice_options(CLI::App& command, DesignChoice& choice);
/// The first of them that is given; null: none.
const char* given_option(const DesignChoice& choice);

/// Declares a list option such as --at: name=value, separated by commas, repeatable.
CLI::Option* add_list_option(CLI::App& command, const std::string& option, std::vector<std::string>& lists,
                             const std::string& meaning);

/// Declares --cells: one number, or NAME=CELLS.
void add_cells_option(CLI::App& command, std::vector<std::string>& lists, const std::string& meaning);
/// Declares --limit.
void add_limit_option(CLI::App& command, std::vector<std::string>& lists);
/// Declares --set, --limit and --cells, which change a study that is run.
void add_change_options(CLI::App& command, StudyChanges& changes);

struct ModeArguments {
  std::string mode;    ///< "": the default
  std::string branch;  ///< sign required of the mechanism's branch; "": what the mode says
};

/// Declares --mode and --branch.
void add_mode_options(CLI::App& command, ModeArguments& arguments);
/// The mode asked for, as the mechanism calls it. Refuses one that it does not have.
std::string known_mode(const MechanismInfo& info, const ModeArguments& arguments);

/// A pose and how the mechanism moves there.
struct MotionArguments : ModeArguments {
  std::vector<std::string> at, velocity, acceleration;
};
/// What they say, an auxiliary chain's input included; rates that are not given are 0.
MotionSample parse_motion(const Mechanism& mechanism, const MotionArguments& arguments);

/// The ability of a mechanism that a command needs. Throws ConfigError, naming both, where it has it not.
template <class Ability>
const Ability& needed(const Ability* ability, const std::string& command, const std::string& what,
                      const MechanismInfo& info) {
  if (!ability) throw ConfigError({}, command + " needs " + what + ", and mechanism " + info.name + " has none");
  return *ability;
}

/// The gap of certain bounds that an option asks for.
double parse_gap(const std::string& text, const std::string& option);

/// One design of a mechanism, and the study that it comes from, if it does: the study's baseline, else its parameters,
/// else the mechanism's defaults, unless a study file's design is chosen; then what --set names.
struct Target : ChosenDesign {
  std::shared_ptr<const Mechanism> mechanism;
  std::optional<Study> study;
  LimitSpec limits;                ///< the study's; none for a bare mechanism
  std::vector<std::string> files;  ///< that this was read from: no output may be one of them

  const MechanismInfo& info() const { return mechanism->info(); }
  /// The study's, else columns over all that the design reaches; under the limits.
  SurveyPlan plan() const;
};

/// A table that a command writes when it is asked for.
struct TableOutput {
  std::string csv;
  bool force = false;
};
/// Declares --csv and --force.
void add_table_output(CLI::App& command, TableOutput& output, const std::string& meaning);
void write_table(const TableOutput& output, const CsvTable& table);

/// A word of the command line is a file's name: it looks so, or there is one.
bool may_be_file(const std::string& name);
/// The built-in mechanism of that name, or the one that a file describes. Throws ConfigError.
std::shared_ptr<const Mechanism> find_mechanism(const Catalogues& catalogues, const std::string& name);

/// A [[motion]] of the study by its name, else a file.
std::shared_ptr<const Motion> find_motion(const Target& target, const std::string& name);

/// Throws ConfigError when there is no such mechanism or study, or --set describes no mechanism.
Target find_target(const Session& session, const DesignArguments& arguments);

/// Declares the arguments of one design; what is parsed goes to `arguments`, which must outlive `command`.
void add_design_arguments(CLI::App& command, DesignArguments& arguments);

/// Adds a subcommand that looks at one design and tells what it finds. What `look` returns is wrong with that all the
/// same, for exit code 1; "": nothing.
template <class Arguments, class Look>
std::pair<CLI::App&, Arguments&> add_design_command(CLI::App& app, Session& session, const std::string& name,
                                                    const std::string& meaning, const std::string& footer, Look look) {
  const auto added =
      add_command<Arguments>(app, name, meaning, footer, [&session, look, name](const Arguments& arguments) {
        expect_toml(arguments.target, name + " --from", session);
        Printout out{.for_programs = arguments.json};
        const SlowStep slow = announced(session, name + " is computing, Ctrl-C ends it");
        const std::string wrong = look(find_target(session, arguments), arguments, out);
        out.print();
        if (!wrong.empty()) throw std::runtime_error(wrong);
      });
  add_design_arguments(added.first, added.second);
  return added;
}

}  // namespace pkm
