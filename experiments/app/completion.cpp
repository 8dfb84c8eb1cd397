// `pkmopt completion`: prints a completion script for bash, zsh or fish, generated from the declared options.

#include <algorithm>
#include <iostream>
#include <map>

#include "engine/core/instruction_set.hpp"
#include "experiments/app/declared_commands.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

/// Values that an option or an argument accepts: words, files, or both, or names that belong to the robot on the
/// command line (parameters, limits).
struct PossibleValues {
  std::vector<std::string> words;
  std::string extension;   ///< extension of the files, for example "h5"; "*": files with any name; "": no files
  std::string names = {};  ///< option of `completion` that prints the names; "": none
};

constexpr const char *kHelpMeaning = "Print the help of the program, or of a command",
                     *kVersionMeaning = "Print the version and the git revision";

PossibleValues values_of(const std::string& command, const DeclaredOption& option, const Session& session) {
  const std::string& type = option.type;
  if (option.name == "--set") return {{}, "", "--parameters"};
  if (option.name == "--limit") return {{}, "", "--limits"};
  if (type == "KIND" && command == "new") return {{"mechanism", "study"}, ""};
  if (type == "KIND") return {{"mechanisms", "objectives", "constraints", "optimisers"}, ""};
  if (type == "FORMAT") return {{"study", "mechanism", "motion", "motors"}, ""};
  if (type == "SET") return {{kInstructionSets.begin(), kInstructionSets.end()}, ""};
  if (type == "SHELL") return {shells(), ""};
  if (type.starts_with("FILE") && !type.ends_with(".toml")) return {{}, "*"};
  if (type.starts_with("DIR")) return {{}, "*"};
  if (type.starts_with("F.h5")) return {{}, "h5"};
  if (type.starts_with("MECHANISM|") || (type == "NAME" && command == "new")) {
    PossibleValues values{{}, "toml"};
    for (const auto& mechanism : session.catalogues.mechanisms) values.words.push_back(mechanism.name());
    return values;
  }
  if (type.ends_with(".toml")) return {{}, "toml"};
  return {};
}

/// The text in single quotes, in a form that is valid in bash, zsh and fish.
std::string in_quotes(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "'\\''" : std::string(1, c);
  return result + "'";
}

/// Escapes brackets and colons, which have a meaning in the descriptions of zsh's function _arguments.
std::string zsh_escaped(std::string text) {
  for (const char* const special : {"[", "]", ":"})
    for (auto at = text.find(special); at != std::string::npos; at = text.find(special, at + 2)) text.insert(at, "\\");
  return text;
}

void print_bash(const std::vector<DeclaredCommand>& commands, const Session& session) {
  const std::string& name = session.program;
  const auto offer = [&](const PossibleValues& values) {
    std::string line;
    if (!values.names.empty()) line = "_" + name + "_names " + values.names;
    if (!values.words.empty())
      line += "COMPREPLY=($(compgen -W " + in_quotes(join_words(values.words)) + " -- \"$word\"))";
    if (!values.extension.empty()) {
      if (!line.empty()) line += "; ";
      line += "_" + name + "_files " + in_quotes(values.extension);
    }
    return line.empty() ? std::string(":") : line;
  };
  const std::string names = join_words(names_of(commands));
  std::cout << "# Completion of " << name << " for bash, printed by '" << name << " completion bash'.\n_" << name
            << R"(_files() {  # files of an extension, and folders
  local pattern='!*'
  [[ $1 == '*' ]] || pattern="!*.$1"
  compopt -o filenames
  local found
  while IFS= read -r found; do COMPREPLY+=("$found"); done < <(compgen -f -X "$pattern" -- "$word"; compgen -d -- "$word")
}
_)" << name << R"shell(_names() {  # names of the robot on the command line, printed by an option of 'completion'
  local robot found
  for robot in "${COMP_WORDS[@]:2:COMP_CWORD-2}"; do
    [[ $robot == -* ]] && continue
    found=$("${COMP_WORDS[0]}" completion "$1" "$robot" 2> /dev/null) && break
  done
  compopt -o nospace
  local given=''  # what precedes the last name of a list: a=1,b=2,
  [[ $word == *,* ]] && given=${word%,*},
  COMPREPLY=($(compgen -P "$given" -W "$found" -- "${word#"$given"}"))
}
_)shell" << name
            << R"(() {
  local word=${COMP_WORDS[COMP_CWORD]} option=$((COMP_CWORD - 1))
  COMPREPLY=()
  while [[ $option -gt 2 && ${COMP_WORDS[option]} == = ]]; do ((option -= 2)); done  # bash divides a=1,b=2 at each =
  [[ $option -lt $((COMP_CWORD - 1)) && $word != *,* ]] && return  # the value of a name
  local before=${COMP_WORDS[option]}
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W )"
            << in_quotes(names + " help --help --version") << R"( -- "$word"))
    return
  fi
  case "${COMP_WORDS[1]} $before" in
)";
  for (const DeclaredCommand& command : commands) {
    std::map<std::string, std::string> options;  // for each command, its options that accept these values
    for (const DeclaredOption& option : command.options)
      if (!option.type.empty()) {
        std::string& all = options[offer(values_of(command.name, option, session))];
        for (const std::string& spelling : {option.name, option.short_name})
          if (!spelling.empty()) all += (all.empty() ? "" : "|") + in_quotes(command.name + " " + spelling);
      }
    for (const auto& [values, names_of_options] : options)
      std::cout << "  " << names_of_options << ") " << values << "; return ;;\n";
  }
  std::cout << "  esac\n  case \"${COMP_WORDS[1]}\" in\n";
  for (const DeclaredCommand& command : commands) {
    std::vector<std::string> options;
    for (const DeclaredOption& option : command.options) options.push_back(option.name);
    std::cout << "  " << command.name << ")\n    if [[ $word == -* ]]; then COMPREPLY=($(compgen -W "
              << in_quotes(join_words(options)) << " -- \"$word\"))\n    else ";
    std::cout << offer(command.arguments.empty() ? PossibleValues{}
                                                 : values_of(command.name, command.arguments.front(), session))
              << "\n    fi ;;\n";
  }
  std::cout << "  help) COMPREPLY=($(compgen -W " << in_quotes(names) << " -- \"$word\")) ;;\n  esac\n}\ncomplete -F _"
            << name << ' ' << name << '\n';
}

void print_zsh(const std::vector<DeclaredCommand>& commands, const Session& session) {
  const auto action = [&](const std::string& command, const DeclaredOption& option) {
    const PossibleValues values = values_of(command, option, session);
    if (!values.names.empty()) return "{_" + session.program + "_names " + values.names + "}";
    std::string files;
    if (values.extension == "*") files = "_files";
    if (!values.extension.empty() && files.empty()) files = "_files -g \"*." + values.extension + "\"";
    if (values.words.empty()) return files.empty() ? " " : files;
    if (files.empty()) return "(" + join_words(values.words) + ")";
    return "{compadd " + join_words(values.words) + "; " + files + "}";
  };
  std::cout << "#compdef " << session.program << "\n# Completion for zsh, printed by '" << session.program
            << " completion zsh'.\n_" << session.program << R"shell(_names() {  # names of the robot on the command line
  local robot
  local -a found
  for robot in ${words[2,CURRENT-1]}; do
    [[ $robot == -* ]] && continue
    found=(${(f)"$()shell"
            << session.program << R"shell( completion $1 $robot 2> /dev/null)"}) && (( $#found )) && break
  done
  compset -P '*,'
  compadd -S '' -- $found
}
local -a commands=(
)shell";
  for (const DeclaredCommand& command : commands)
    std::cout << "  " << in_quotes(command.name + ":" + command.meaning) << '\n';
  std::cout << "  " << in_quotes(std::string("help:") + kHelpMeaning) << "\n)\nlocal -a of_program=("
            << in_quotes(std::string("--help:") + kHelpMeaning) << ' '
            << in_quotes(std::string("--version:") + kVersionMeaning) << R"()
if (( CURRENT == 2 )); then _describe command commands; _describe -o option of_program; return; fi
shift words; (( CURRENT-- ))
case $words[1] in
  help) _describe command commands ;;
)";
  for (const DeclaredCommand& command : commands) {
    std::cout << "  " << command.name << ") _arguments";
    for (const DeclaredOption& option : command.options)
      for (const std::string& name : {option.name, option.short_name})
        if (!name.empty())
          std::cout << " \\\n    "
                    << in_quotes("*" + name + "[" + zsh_escaped(option.meaning) + "]" +
                                 (option.type.empty()
                                      ? ""
                                      : ":" + zsh_escaped(option.type) + ":" + action(command.name, option)));
    for (std::size_t i = 0; i < command.arguments.size(); ++i) {
      const DeclaredOption& argument = command.arguments[i];
      const std::string position = i + 1 == command.arguments.size() ? "*" : std::to_string(i + 1);
      std::cout << " \\\n    "
                << in_quotes(position + ":" + zsh_escaped(argument.type) + ":" + action(command.name, argument));
    }
    std::cout << " ;;\n";
  }
  std::cout << "esac\n";
}

void print_fish(const std::vector<DeclaredCommand>& commands, const Session& session) {
  const auto offer = [&](const std::string& command, const DeclaredOption& option) {
    const PossibleValues values = values_of(command, option, session);
    if (!values.names.empty()) return " -a '(__" + session.program + "_names " + values.names + ")'";
    std::string words = join_words(values.words);
    if (!values.extension.empty() && values.extension != "*") {
      if (!words.empty()) words += ' ';
      words += "(__" + session.program + "_files " + values.extension + ")";
    }
    return words.empty() ? std::string() : " -a " + in_quotes(words);
  };
  const std::string begin = "complete -c " + session.program;
  std::cout << "# Completion for fish, printed by '" << session.program << " completion fish'.\n"
            << "function __" << session.program << R"(_names  # names of the robot on the command line
  set -l given (commandline -ct | string replace -r '[^,]*$' '')  # what precedes the last name of a list
  for robot in (commandline -opc)[3..-1]
    string match -q -- '-*' $robot; and continue
    )" << session.program
            << R"( completion $argv[1] $robot 2> /dev/null | string replace -r '^' "$given"; and return
  end
end
function __)"
            << session.program << R"(_files  # files of an extension, and folders
  __fish_complete_suffix .$argv[1] | string match -r -- ".*(?:/|\\.$argv[1])(?:\t.*)?\$"
end
)" << begin << " -f\n"
            << begin << " -n __fish_use_subcommand -a help -d " << in_quotes(kHelpMeaning) << '\n'
            << begin << " -n __fish_use_subcommand -l help -s h -d " << in_quotes(kHelpMeaning) << '\n'
            << begin << " -n __fish_use_subcommand -l version -s V -d " << in_quotes(kVersionMeaning) << '\n'
            << begin << " -n '__fish_seen_subcommand_from help' -a " << in_quotes(join_words(names_of(commands)))
            << '\n';
  for (const DeclaredCommand& command : commands) {
    std::cout << begin << " -n __fish_use_subcommand -a " << command.name << " -d " << in_quotes(command.meaning)
              << '\n';
    const std::string here = begin + " -n '__fish_seen_subcommand_from " + command.name + "'";
    for (const DeclaredOption& option : command.options) {
      const bool any_file = values_of(command.name, option, session).extension == "*";
      std::cout << here << " -l " << option.name.substr(2)
                << (option.short_name.empty() ? "" : " -s " + option.short_name.substr(1))
                << (option.type.empty() ? ""
                    : any_file          ? " -r -F"
                                        : " -r -f")
                << offer(command.name, option) << " -d " << in_quotes(option.meaning) << '\n';
    }
    for (const DeclaredOption& argument : command.arguments)
      if (const std::string words = offer(command.name, argument); !words.empty()) std::cout << here << words << '\n';
  }
}

/// Prints the names that --set or --limit accept for a robot, one per line, each followed by "=".
void print_names(const Session& session, const std::string& robot, bool limits) {
  DesignArguments arguments;
  (robot.ends_with(".h5") ? arguments.from : arguments.target) = robot;
  const MechanismInfo& info = find_target(session, arguments).info();
  for (const std::string& name : limits ? names_of(info.limits) : names_of(info.parameters)) std::cout << name << "=\n";
}

using Print = void (*)(const std::vector<DeclaredCommand>&, const Session&);
const std::vector<std::pair<std::string, Print>> kShells = {
    {"bash", print_bash}, {"zsh", print_zsh}, {"fish", print_fish}};

}  // namespace

std::vector<std::string> shells() {
  std::vector<std::string> names;
  for (const auto& [name, print] : kShells) names.push_back(name);
  return names;
}

void add_completion(CLI::App& app, Session& session) {
  struct CompletionArguments {
    std::string shell, parameters, limits;
  };
  auto [command, a] = add_command<CompletionArguments>(
      app, "completion", "Print a script for command-line completion in bash, zsh or fish.",
      "Example: source <(pkmopt completion bash)\nThe Debian package installs it for all three shells.",
      [&session](const CompletionArguments& arguments) {
        for (const bool limits : {false, true})
          if (const std::string& robot = limits ? arguments.limits : arguments.parameters; !robot.empty()) {
            print_names(session, robot, limits);
            return;
          }
        const auto found = std::ranges::find(kShells, arguments.shell, &std::pair<std::string, Print>::first);
        if (found == kShells.end())
          throw ConfigError({"", 0, "completion"}, "the unknown shell '" + arguments.shell + "'",
                            "one of " + join(shells()), nearest_name(arguments.shell, shells()));
        found->second(declared_commands(session), session);
      });
  add_option(command, "SHELL", a.shell, "bash, zsh or fish");
  const std::string of = " of a mechanism, a study or a study file accepts, for the shell";
  add_option(command, "--parameters ROBOT", a.parameters, "Print the names that --set" + of);
  add_option(command, "--limits ROBOT", a.limits, "Print the names that --limit" + of);
}

}  // namespace pkm
