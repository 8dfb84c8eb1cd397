#include "experiments/app/command_line.hpp"

#include <algorithm>
#include <iostream>

#include "engine/core/error.hpp"
#include "engine/core/printable.hpp"
#include "engine/core/unit.hpp"
#include "experiments/app/commands.hpp"

namespace pkm {
namespace {

constexpr std::size_t kLongestComplaint = 1000;  // bytes, of CLI11's own messages

/// Options that take a list of name=value.
const std::vector<std::string> kLists = {
    "--set",    "--limit",         "--at",   "--joints", "--velocity",    "--acceleration",
    "--speeds", "--accelerations", "--near", "--forces", "--wrench",      "--held",
    "--cut",    "--cells",         "--box",  "--least",  "--joint-error", "--tolerance"};

/// "--set a=1 b=2" becomes "--set a=1 --set b=2", for every option that takes a list of name=value.
std::vector<std::string> spread_lists(const std::vector<std::string>& arguments) {
  std::vector<std::string> spread;
  std::string option;  // whose list we are in; "" outside of one
  for (const auto& argument : arguments) {
    const bool assignment = !argument.starts_with('-') && argument.find('=') != std::string::npos;
    const bool goes_on = assignment && !option.empty() && spread.back() != option;
    if (goes_on) spread.push_back(option);
    if (!assignment) option = std::ranges::find(kLists, argument) != kLists.end() ? argument : "";
    spread.push_back(argument);
  }
  return spread;
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

/// A subcommand has to come first, unless the program's own --help or --version is asked for.
void check_subcommand(const CLI::App& app, const std::vector<std::string>& arguments) {
  const auto known = subcommand_names(app);
  const std::string expected = "one of " + join(known) + " (see '" + app.get_name() + " --help')";
  const std::string& first = arguments.front();
  if (first.starts_with('-') || std::ranges::find(known, first) != known.end()) return;
  throw ConfigError({}, "the unknown command '" + first + "'", expected, nearest_name(first, known));
}

/// What is left over after parsing: an unknown option or one argument too many.
ConfigError left_over(const CLI::App& app, const std::string& command) {
  const std::string program = app.get_parent() ? app.get_parent()->get_name() : app.get_name();
  const std::string word = app.remaining().front();
  if (!word.starts_with('-') || word == "-")
    return ConfigError({"", 0, command}, "the argument '" + word + "'",
                       "no further argument (see '" + program + " " + command + " --help')");
  const auto known = option_names(app);
  const std::string name = word.substr(0, word.find('='));
  return ConfigError({"", 0, command}, "the unknown option '" + name + "'", "one of " + join(known),
                     nearest_name(name, known));
}

}  // namespace

std::string with_name(std::string help, const std::string& name) {
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
  auto spread = spread_lists(arguments);
  std::ranges::reverse(spread);  // the order that CLI11 takes them in
  try {
    app.parse(spread);
  } catch (const CLI::CallForHelp&) {
    std::cout << with_name(app.help(), app.get_name()) << '\n';
  } catch (const CLI::CallForVersion& version) {
    std::cout << version.what() << '\n';
  } catch (const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    const CLI::App& where = chosen.empty() ? app : *chosen.front();
    const std::string command = chosen.empty() ? "" : where.get_name();
    if (!where.remaining().empty()) throw left_over(where, command);
    throw ConfigError({"", 0, command}, excerpt(error.what(), kLongestComplaint) + " (see '" + app.get_name() + " " +
                                            command + (command.empty() ? "" : " ") + "--help')");
  }
}

}  // namespace pkm
