#include "experiments/app/program.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <exception>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "constraints/all.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/core/instruction_set.hpp"
#include "engine/core/printable.hpp"
#include "engine/core/ranks.hpp"
#include "engine/runner/stop_request.hpp"
#include "engine/runner/worker_ranks.hpp"
#include "engine/storage/subprocess_check.hpp"
#include "experiments/app/command_line.hpp"
#include "experiments/app/commands.hpp"
#include "experiments/app/line_wrapping.hpp"
#include "experiments/app/next_step.hpp"
#include "experiments/app/print.hpp"
#include "experiments/app/printable_stream.hpp"
#include "experiments/app/terminal_colours.hpp"
#include "experiments/app/version.hpp"
#include "objectives/all.hpp"

namespace pkm {
namespace {

/// Argument with which the program starts itself as a separate process to parse a study file that may crash the parser.
constexpr const char* kCheckFile = "--check-study-on-standard-input";
constexpr std::size_t kMaxProgramName = 40;  // maximum number of bytes of the program's name in messages

struct Command {
  std::string_view name;
  AddCommand* add;
  bool prints_results = false;  ///< true if the command prints computed values
  bool evaluates = false;  ///< true if the command evaluates many designs, so that the instruction set influences its
                           ///< run time
};

constexpr Command kCommands[] = {{"run", add_run, true, true},
                                 {"resume", add_resume, true, true},
                                 {"check", add_check},
                                 {"evaluate", add_evaluate, true, true},
                                 {"sensitivity", add_sensitivity, true, true},
                                 {"pose", add_pose, true},
                                 {"forward", add_forward, true},
                                 {"dynamics", add_dynamics, true},
                                 {"coupling", add_coupling, true, true},
                                 {"trajectory", add_trajectory, true},
                                 {"simulate", add_simulate, true},
                                 {"workspace", add_workspace, true},
                                 {"connect", add_connect, true},
                                 {"certify", add_certify, true},
                                 {"tolerances", add_tolerances, true},
                                 {"compare", add_compare, true},
                                 {"show", add_show, true},
                                 {"report", add_report},
                                 {"export", add_export},
                                 {"generate", add_generate},
                                 {"list", add_list},
                                 {"new", add_new},
                                 {"schema", add_schema},
                                 {"upgrade", add_upgrade},
                                 {"completion", add_completion},
                                 {"manual", add_manual}};

/// Declares --instruction-set, for comparisons of speed; the results do not depend on it.
void add_instruction_set(CLI::App& command) {
  const auto choose = [](const std::string& name) {
    const std::vector<std::string> known{kInstructionSets.begin(), kInstructionSets.end()};
    const auto found = std::ranges::find(known, name);
    if (found == known.end())
      throw ConfigError({"", 0, "--instruction-set"}, "'" + name + "'", "one of " + join(known),
                        nearest_name(name, known));
    try {
      use_instruction_set(static_cast<InstructionSet>(found - known.begin()));
    } catch (const std::invalid_argument& reason) {
      throw ConfigError({"", 0, "--instruction-set"}, reason.what());
    }
  };
  command
      .add_option_function<std::string>("--instruction-set", choose,
                                        "Vector instructions to use (default: the widest of the processor); "
                                        "affects the speed, but no result")
      ->type_name("SET");
}

/// Declares --digits.
void add_digits(CLI::App& command) {
  const auto choose = [](const std::string& text) {
    use_digits(static_cast<int>(parse_option(text, "--digits", 1, kFullDigits)));
  };
  command
      .add_option_function<std::string>("--digits", choose,
                                        "Significant digits of the numbers in texts (default: 4; 17: all)")
      ->type_name("N:INT in [1 - " + std::to_string(kFullDigits) + "]");
}

void add(const Command& command, CLI::App& app, Session& session) {
  command.add(app, session);
  CLI::App& added = *app.get_subcommand(std::string(command.name));
  if (command.evaluates) add_instruction_set(added);
  if (command.prints_results) add_digits(added);
}

/// Version, revision and instruction sets of the program, as text or as one JSON object.
std::string describe_version(bool as_json) {
  const std::vector<std::string> sets{kInstructionSets.begin(), kInstructionSets.end()};
  const std::string chosen(name_of(instruction_set()));
  if (!as_json) return program_words() + "\ninstruction set: " + chosen + " of " + join(sets);
  return Json({{"program", "pkmopt"},
               {"version", program_version()},
               {"revision", program_revision()},
               {"instruction_set", chosen},
               {"instruction_sets", sets}})
      .dump(2);
}

/// Text that is printed if no command is given.
constexpr const char* kFirstSteps =
    "First commands:\n"
    "  pkmopt list mechanisms                        list the built-in robots\n"
    "  pkmopt new mechanism my-robot -o robot.toml   create a mechanism file to edit\n"
    "  pkmopt new study robot.toml -o study.toml     create a study: variables and objectives\n"
    "  pkmopt check study.toml                       check the study and show how it is interpreted\n"
    "  pkmopt run study.toml                         find the best design and write study.h5\n"
    "  pkmopt report study.h5                        write the results as a web page with plots\n"
    "  pkmopt workspace robot.toml                   compute the workspace of one design\n"
    "'pkmopt --help' lists all commands; 'pkmopt help COMMAND' describes one of them.\n";

void run(std::vector<std::string> arguments, Session& session) {
  if (arguments.empty()) {
    std::cerr << kProgramMeaning << '\n' << with_program_name(kFirstSteps, session.program);
    session.exit_code = kBadInput;
    return;
  }
  CLI::App app(kProgramMeaning, session.program);
  CLI::Option* const version = app.set_version_flag("-V,--version", describe_version(contains(arguments, "--json")),
                                                    "Print the version and the git revision");
  bool json = false;  // only declared: --version is processed before this flag is set
  app.add_flag("--json", json, "With --version: print one JSON object")->needs(version);
  app.get_formatter()->column_width(36);
  app.get_formatter()->label("REQUIRED", "(required)");
  app.require_subcommand(1);
  app.footer(kProgramNotes);
  if (arguments[0] == "help") {  // "help", "help COMMAND": like "--help", "COMMAND --help"
    arguments[0] = "--help";
    std::rotate(arguments.begin(), arguments.begin() + 1, arguments.end());
  }
  // Only the command that is named is declared, because declaring all commands takes longer than executing most of
  // them.
  const auto named = std::ranges::find(kCommands, arguments[0], &Command::name);
  if (named != std::end(kCommands))
    add(*named, app, session);
  else
    add_all_commands(app, session);
  parse_command_line(app, arguments);
  std::cout.flush();
  if (!std::cout) throw std::runtime_error("the results cannot be written to the standard output");
}

}  // namespace

void add_all_commands(CLI::App& app, Session& session) {
  for (const Command& command : kCommands) add(command, app, session);
}

Catalogues all_catalogues() { return {all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()}; }

int program_main(int argc, char** argv, const Catalogues& catalogues) {
  if (argc == 2 && std::string_view(argv[1]) == kCheckFile) return check_study_on_standard_input();
  // The check command is not set within another program, such as a test or a fuzzer: its executable does not understand
  // kCheckFile and would just run again.
  if (argc > 0 && argv[0] == program_invocation_name) set_check_command({"/proc/self/exe", kCheckFile});
  const std::string name = argc > 0 ? std::filesystem::path(argv[0]).stem().string() : "";
  std::string words;
  for (int i = 1; i < argc; ++i) words += (i > 1 ? " " : "") + quoted(printable(argv[i]));
  Session session{catalogues, name.empty() ? "pkmopt" : name, words};
  const auto style_for = [&session](int descriptor) -> PrintableStream::Style {
    const std::size_t columns = terminal_width(descriptor);
    const bool colours = supports_colours(descriptor);
    if (!colours && columns == 0) return {};
    return [&session, columns, colours](std::string_view lines) {
      return wrap_table_rows(colours ? coloured(lines, session.program) : std::string(lines), columns);
    };
  };
  const PrintableStream out(std::cout, style_for(STDOUT_FILENO)), err(std::cerr, style_for(STDERR_FILENO));
  const auto report_error = [&session](const std::string& sentence, int exit_code) {
    std::cerr << excerpt(session.program, kMaxProgramName) << ": " << sentence << '\n';
    return exit_code;
  };
  const auto work = [&] {
    try {
      run({argv + std::min(argc, 1), argv + argc}, session);
      return session.exit_code;
    } catch (const ConfigError& error) {
      return report_error(error.what(), kBadInput);
    } catch (const std::exception& error) {
      return report_error(message_of(error), kFailure);
    } catch (const Stopped&) {
      return report_error("stopped by " + stop_words(StopRequest::name(StopRequest::signal())), kStoppedEarly);
    }
  };
  std::signal(SIGXFSZ, SIG_IGN);  // exceeding the file size limit is then an error that can be reported
  try {
    const ranks::Group group;
    if (ranks::rank() > 0) return run_worker_rank(catalogues, {program_version(), program_revision(), words});
    const int exit_code = work();
    if (ranks::size() > 1) stop_worker_ranks(exit_code);
    return exit_code;
  } catch (const std::exception& error) {  // thrown if the processes of an MPI run cannot connect
    return ranks::is_launched_as_rank_zero() ? report_error(message_of(error), kFailure) : kFailure;
  }
}

}  // namespace pkm
