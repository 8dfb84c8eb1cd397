#include "experiments/app/declared_commands.hpp"

#include "experiments/app/command_line.hpp"

namespace pkm {
namespace {

DeclaredOption declared_option(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  DeclaredOption result{.name = "",
                        .short_name = "",
                        .type = type.substr(0, type.find_first_of(":=")),
                        .meaning = option.get_description(),
                        .required = option.get_required()};
  if (option.get_lnames().empty()) {
    if (result.type.empty()) result.type = option.get_name();
    result.name = result.type;
  } else {
    result.name = "--" + option.get_lnames().front();
    if (!option.get_snames().empty()) result.short_name = "-" + option.get_snames().front();
  }
  return result;
}

}  // namespace

std::vector<DeclaredCommand> declared_commands(Session& session) {
  CLI::App app("", session.program);
  add_all_commands(app, session);
  std::vector<DeclaredCommand> commands;
  for (const CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; })) {
    DeclaredCommand found{command->get_name(),
                          command->get_description(),
                          with_program_name(command->get_footer(), session.program),
                          {},
                          {}};
    for (const CLI::Option* const option : command->get_options())
      (option->get_lnames().empty() ? found.arguments : found.options).push_back(declared_option(*option));
    commands.push_back(std::move(found));
  }
  return commands;
}

std::string join_words(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : " ") + word;
  return all;
}

}  // namespace pkm
