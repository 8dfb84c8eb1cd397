// `pkmopt completion`: prints a completion script for bash, zsh or fish, generated from the declared options.

#include <algorithm>
#include <iostream>
#include <map>

#include "engine/core/instruction_set.hpp"
#include "experiments/app/declared_commands.hpp"

namespace pkm {
namespace {

/// What an option or an argument accepts: words, files, or both.
struct PossibleValues {
  std::vector<std::string> words;
  std::string extension;  ///< extension of the files, for example "h5"; "*": files with any name; "": no files
};

PossibleValues values_of(const std::string& command, const std::string& type, const Session& session) {
  if (type == "KIND" && command == "new") return {{"mechanism", "study"}, ""};
  if (type == "KIND") return {{"mechanisms", "objectives", "constraints", "optimisers"}, ""};
  if (type == "FORMAT") return {{"study", "mechanism", "motion", "motors"}, ""};
  if (type == "SET") return {{kInstructionSets.begin(), kInstructionSets.end()}, ""};
  if (type == "SHELL") return {shells(), ""};
  if (type.starts_with("FILE") && !type.ends_with(".toml")) return {{}, "*"};
  if (type.starts_with("DIR")) return {{}, "*"};
  if (type.starts_with("F.h5")) return {{}, "h5"};
  if (type.starts_with("MECHANISM|")) {
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
    if (!values.words.empty())
      line += "COMPREPLY=($(compgen -W " + in_quotes(join_words(values.words)) + " -- \"$word\"))";
    if (!values.extension.empty()) {
      if (!line.empty()) line += "; ";
      line += "_" + name + "_files " + in_quotes(values.extension);
    }
    return line.empty() ? std::string(":") : line;
  };
  std::vector<std::string> names;
  for (const DeclaredCommand& command : commands) names.push_back(command.name);
  std::cout << "# Completion of " << name << " for bash, printed by '" << name << " completion bash'.\n_" << name
            << R"(_files() {  # files of an extension, and folders
  local pattern='!*'
  [[ $1 == '*' ]] || pattern="!*.$1"
  compopt -o filenames
  local found
  while IFS= read -r found; do COMPREPLY+=("$found"); done < <(compgen -f -X "$pattern" -- "$word"; compgen -d -- "$word")
}
_)" << name << R"(() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W )"
            << in_quotes(join_words(names) + " --help --version") << R"( -- "$word"))
    return
  fi
  case "${COMP_WORDS[1]} $before" in
)";
  for (const DeclaredCommand& command : commands) {
    std::map<std::string, std::string> options;  // for each command, its options that accept these values
    for (const DeclaredOption& option : command.options)
      if (!option.type.empty()) {
        std::string& all = options[offer(values_of(command.name, option.type, session))];
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
                                                 : values_of(command.name, command.arguments.front().type, session))
              << "\n    fi ;;\n";
  }
  std::cout << "  esac\n}\ncomplete -F _" << name << ' ' << name << '\n';
}

void print_zsh(const std::vector<DeclaredCommand>& commands, const Session& session) {
  const auto action = [&](const std::string& command, const std::string& type) {
    const PossibleValues values = values_of(command, type, session);
    std::string files;
    if (values.extension == "*") files = "_files";
    if (!values.extension.empty() && files.empty()) files = "_files -g \"*." + values.extension + "\"";
    if (values.words.empty()) return files.empty() ? " " : files;
    if (files.empty()) return "(" + join_words(values.words) + ")";
    return "{compadd " + join_words(values.words) + "; " + files + "}";
  };
  std::cout << "#compdef " << session.program << "\n# Completion for zsh, printed by '" << session.program
            << " completion zsh'.\nlocal -a commands=(\n";
  for (const DeclaredCommand& command : commands)
    std::cout << "  " << in_quotes(command.name + ":" + command.meaning) << '\n';
  std::cout << ")\nif (( CURRENT == 2 )); then _describe command commands; return; fi\nshift words; (( CURRENT-- ))\n"
               "case $words[1] in\n";
  for (const DeclaredCommand& command : commands) {
    std::cout << "  " << command.name << ") _arguments";
    for (const DeclaredOption& option : command.options)
      for (const std::string& name : {option.name, option.short_name})
        if (!name.empty())
          std::cout << " \\\n    "
                    << in_quotes("*" + name + "[" + zsh_escaped(option.meaning) + "]" +
                                 (option.type.empty()
                                      ? ""
                                      : ":" + zsh_escaped(option.type) + ":" + action(command.name, option.type)));
    for (const DeclaredOption& argument : command.arguments)
      std::cout << " \\\n    "
                << in_quotes("*:" + zsh_escaped(argument.type) + ":" + action(command.name, argument.type));
    std::cout << " ;;\n";
  }
  std::cout << "esac\n";
}

void print_fish(const std::vector<DeclaredCommand>& commands, const Session& session) {
  const auto offer = [&](const std::string& command, const std::string& type) {
    const PossibleValues values = values_of(command, type, session);
    std::string words = join_words(values.words);
    if (!values.extension.empty() && values.extension != "*") {
      if (!words.empty()) words += ' ';
      words += "(__fish_complete_suffix ." + values.extension + ")";
    }
    return words.empty() ? std::string() : " -a " + in_quotes(words);
  };
  const std::string begin = "complete -c " + session.program;
  std::cout << "# Completion for fish, printed by '" << session.program << " completion fish'.\n" << begin << " -f\n";
  for (const DeclaredCommand& command : commands) {
    std::cout << begin << " -n __fish_use_subcommand -a " << command.name << " -d " << in_quotes(command.meaning)
              << '\n';
    const std::string here = begin + " -n '__fish_seen_subcommand_from " + command.name + "'";
    for (const DeclaredOption& option : command.options) {
      const bool any_file = values_of(command.name, option.type, session).extension == "*";
      std::cout << here << " -l " << option.name.substr(2)
                << (option.short_name.empty() ? "" : " -s " + option.short_name.substr(1))
                << (option.type.empty() ? ""
                    : any_file          ? " -r -F"
                                        : " -r -f")
                << offer(command.name, option.type) << " -d " << in_quotes(option.meaning) << '\n';
    }
    for (const DeclaredOption& argument : command.arguments)
      if (const std::string words = offer(command.name, argument.type); !words.empty())
        std::cout << here << words << '\n';
  }
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
    std::string shell;
  };
  auto [command, a] = add_command<CompletionArguments>(
      app, "completion", "Print a script for command-line completion in bash, zsh or fish.",
      "Example: source <(pkmopt completion bash)\nThe Debian package installs it for all three shells.",
      [&session](const CompletionArguments& arguments) {
        const auto found = std::ranges::find(kShells, arguments.shell, &std::pair<std::string, Print>::first);
        if (found == kShells.end())
          throw ConfigError({"", 0, "completion"}, "the unknown shell '" + arguments.shell + "'",
                            "one of " + join(shells()), nearest_name(arguments.shell, shells()));
        found->second(declared_commands(session), session);
      });
  add_option(command, "SHELL", a.shell, "bash, zsh or fish")->required();
}

}  // namespace pkm
