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
#include "engine/core/instruction_set.hpp"
#include "engine/core/printable.hpp"
#include "engine/core/ranks.hpp"
#include "engine/mechanisms/all.hpp"
#include "engine/storage/contained_reading.hpp"
#include "engine/study/stop_request.hpp"
#include "engine/study/take_part.hpp"
#include "experiments/app/colours.hpp"
#include "experiments/app/command_line.hpp"
#include "experiments/app/commands.hpp"
#include "experiments/app/fitted.hpp"
#include "experiments/app/next_step.hpp"
#include "experiments/app/printable_stream.hpp"
#include "experiments/app/version.hpp"
#include "objectives/all.hpp"

namespace pkm {
namespace {

/// How the program calls itself to parse a study file that may crash the parser.
constexpr const char* kCheckFile = "--check-study-on-standard-input";
constexpr std::size_t kLongestProgram = 40;  // bytes of its name in messages

struct Command {
  std::string_view name;
  AddCommand* add;
  bool evaluates = false;  ///< many designs, so that the instruction set counts
};

constexpr Command kCommands[] = {{"run", add_run, true},
                                 {"resume", add_resume, true},
                                 {"check", add_check},
                                 {"evaluate", add_evaluate, true},
                                 {"pose", add_pose},
                                 {"forward", add_forward},
                                 {"dynamics", add_dynamics},
                                 {"coupling", add_coupling, true},
                                 {"trajectory", add_trajectory},
                                 {"simulate", add_simulate},
                                 {"workspace", add_workspace},
                                 {"certify", add_certify},
                                 {"show", add_show},
                                 {"report", add_report},
                                 {"export", add_export},
                                 {"list", add_list},
                                 {"new", add_new},
                                 {"completion", add_completion},
                                 {"manual", add_manual}};

/// For comparisons: results are the same on all.
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
                                        "Vector instructions to use (default: the widest that the processor has); "
                                        "changes the speed, never a result")
      ->type_name("SET");
}

void add(const Command& command, CLI::App& app, Session& session) {
  command.add(app, session);
  if (command.evaluates) add_instruction_set(*app.get_subcommand(std::string(command.name)));
}

/// What is said where no command is named.
constexpr const char* kFirstSteps =
    "Commands to begin with:\n"
    "  pkmopt list mechanisms                        the robots that are built in\n"
    "  pkmopt new mechanism my-robot -o robot.toml   one of your own, as a text to change\n"
    "  pkmopt new study robot.toml -o study.toml     what may vary, and what is wanted\n"
    "  pkmopt check study.toml                       what is understood of it\n"
    "  pkmopt run study.toml                         the best design, into study.h5\n"
    "  pkmopt report study.h5                        what was found, as a page with plots\n"
    "  pkmopt workspace robot.toml                   the workspace of one design\n"
    "'pkmopt --help' lists all commands, 'pkmopt COMMAND --help' tells more of one.\n";

void run(const std::vector<std::string>& arguments, Session& session) {
  if (arguments.empty()) {
    std::cerr << kProgramMeaning << '\n' << with_name(kFirstSteps, session.program);
    session.exit_code = kBadInput;
    return;
  }
  CLI::App app(kProgramMeaning, session.program);
  app.set_version_flag("--version", program_words() + "\ninstruction set: " + std::string(name_of(instruction_set())) +
                                        " of " + join({kInstructionSets.begin(), kInstructionSets.end()}));
  app.get_formatter()->column_width(36);
  app.get_formatter()->label("REQUIRED", "(required)");
  app.require_subcommand(1);
  app.footer(kProgramNotes);
  // To declare all commands takes longer than to carry out most of them: where one is named, the others are left out.
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
  if (argc == 2 && std::string_view(argv[1]) == kCheckFile) return check_standard_input();
  // Within another program (a test, a fuzzer) this file is not one that could be called so: it would run that one
  // again.
  if (argc > 0 && argv[0] == program_invocation_name) use_file_checker({"/proc/self/exe", kCheckFile});
  const std::string name = argc > 0 ? std::filesystem::path(argv[0]).stem().string() : "";
  std::string words;
  for (int i = 1; i < argc; ++i) words += (i > 1 ? " " : "") + quoted(printable(argv[i]));
  Session session{catalogues, name.empty() ? "pkmopt" : name, words};
  const auto paint_on = [&session](int descriptor) -> PrintableStream::Paint {
    const std::size_t columns = columns_of_terminal(descriptor);
    const bool colours = shows_colours(descriptor);
    if (!colours && columns == 0) return {};
    return [&session, columns, colours](std::string_view lines) {
      return fitted(colours ? painted(lines, session.program) : std::string(lines), columns);
    };
  };
  const PrintableStream out(std::cout, paint_on(STDOUT_FILENO)), err(std::cerr, paint_on(STDERR_FILENO));
  const auto complain = [&session](const std::string& sentence, int exit_code) {
    std::cerr << excerpt(session.program, kLongestProgram) << ": " << sentence << '\n';
    return exit_code;
  };
  const auto work = [&] {
    try {
      run({argv + std::min(argc, 1), argv + argc}, session);
      return session.exit_code;
    } catch (const ConfigError& error) {
      return complain(error.what(), kBadInput);
    } catch (const std::exception& error) {
      return complain(message_of(error), kFailure);
    } catch (const Stopped&) {
      return complain(std::string("stopped by ") + StopRequest::name(StopRequest::signal()), kStoppedEarly);
    }
  };
  std::signal(SIGXFSZ, SIG_IGN);  // so that a limit of file sizes is an error that can be told
  try {
    const ranks::Group group;
    if (ranks::rank() > 0) return take_part(catalogues, {program_version(), program_revision(), words});
    const int exit_code = work();
    if (ranks::size() > 1) dismiss_ranks(exit_code);
    return exit_code;
  } catch (const std::exception& error) {  // the processes that were started do not find one another
    return ranks::launched_first() ? complain(message_of(error), kFailure) : kFailure;
  }
}

}  // namespace pkm
