#include "experiments/app/command_line.hpp"

#include <algorithm>
#include <iostream>

#include "engine/config/renamed_keys.hpp"
#include "engine/core/error.hpp"
#include "engine/core/printable.hpp"
#include "engine/core/unit.hpp"
#include "experiments/app/commands.hpp"

namespace pkm {
namespace {

// Maximum number of bytes of a message of CLI11; longer messages are truncated.
constexpr std::size_t kMaxMessageLength = 1000;

/// Options whose value is a list of name=value.
const std::vector<std::string> kLists = {
    "--set",    "--limit",         "--at",    "--joints",      "--velocity",  "--acceleration", "--input",
    "--speeds", "--accelerations", "--near",  "--forces",      "--wrench",    "--fixed",        "--cut",
    "--cells",  "--box",           "--least", "--joint-error", "--tolerance", "--cylinder",     "--sphere"};

/// Repeats an option before each element of its list: "--set a=1 b=2" becomes "--set a=1 --set b=2".
std::vector<std::string> expand_lists(const std::vector<std::string>& arguments) {
  std::vector<std::string> expanded;
  std::string option;  // the option whose list is being read; "" outside of a list
  for (const auto& argument : arguments) {
    const bool assignment = !argument.starts_with('-') && argument.find('=') != std::string::npos;
    const bool continues_list = assignment && !option.empty() && expanded.back() != option;
    if (continues_list) expanded.push_back(option);
    if (!assignment) option = std::ranges::find(kLists, argument) != kLists.end() ? argument : "";
    expanded.push_back(argument);
  }
  return expanded;
}

std::vector<std::string> subcommand_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const auto* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const auto* option : app.get_options())
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// Throws ConfigError unless the first argument is the name of a subcommand, or an option of the program such as
/// --help.
void check_subcommand(const CLI::App& app, const std::vector<std::string>& arguments) {
  const auto known = subcommand_names(app);
  const std::string expected = "one of " + join(known) + " (see '" + app.get_name() + " --help')";
  const std::string& first = arguments.front();
  if (first.starts_with('-') || std::ranges::find(known, first) != known.end()) return;
  throw ConfigError({}, "the unknown command '" + first + "'", expected, nearest_name(first, known));
}

/// The error for the first argument that CLI11 could not assign: an unknown option or a superfluous argument.
ConfigError unexpected_argument(const CLI::App& app, const std::string& command) {
  const std::string program = app.get_parent() ? app.get_parent()->get_name() : app.get_name();
  const std::string word = app.remaining().front();
  if (!word.starts_with('-') || word == "-")
    return ConfigError({"", 0, command}, "the argument '" + word + "'",
                       "no further argument (see '" + program + " " + command + " --help')");
  const auto known = option_names(app);
  const std::string name = word.substr(0, word.find('='));
  if (const std::string present = present_option(name); std::ranges::find(known, present) != known.end())
    return ConfigError({"", 0, command}, "the option " + name + " is now called " + present);
  return ConfigError({"", 0, command}, "the unknown option '" + name + "'", "one of " + join(known),
                     nearest_name(name, known));
}

}  // namespace

std::string with_program_name(std::string help, const std::string& name) {
  const std::string own = "pkmopt ";
  for (auto at = help.find(own); at != std::string::npos; at = help.find(own, at + name.size()))
    help.replace(at, own.size() - 1, name);
  return help;
}

std::int64_t parse_option(const std::string& text, const std::string& option, std::int64_t lower, std::int64_t upper) {
  const auto number = parse_integer(text);
  if (number && *number >= lower && *number <= upper) return *number;
  throw ConfigError({"", 0, option}, "'" + text + "'",
                    "a whole number from " + std::to_string(lower) + " to " + std::to_string(upper) +
                        ", in decimal without leading zeros");
}

void parse_command_line(CLI::App& app, const std::vector<std::string>& arguments) {
  check_subcommand(app, arguments);
  auto expanded = expand_lists(arguments);
  std::ranges::reverse(expanded);  // CLI11 requires the arguments in reverse order
  try {
    app.parse(expanded);
  } catch (const CLI::CallForHelp&) {
    std::cout << with_program_name(app.help(), app.get_name()) << '\n';
  } catch (const CLI::CallForVersion& version) {
    std::cout << version.what() << '\n';
  } catch (const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    const CLI::App& where = chosen.empty() ? app : *chosen.front();
    const std::string command = chosen.empty() ? "" : where.get_name();
    if (!where.remaining().empty()) throw unexpected_argument(where, command);
    throw ConfigError({"", 0, command}, excerpt(error.what(), kMaxMessageLength) + " (see '" + app.get_name() + " " +
                                            command + (command.empty() ? "" : " ") + "--help')");
  }
}

}  // namespace pkm
