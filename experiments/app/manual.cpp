// `pkmopt manual`: generates manual pages in roff, the format of man(1), from the command declarations that also give
// --help.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "experiments/app/declared_commands.hpp"
#include "experiments/app/version.hpp"

namespace pkm {
namespace {

/// Escapes text for roff: dots and apostrophes at the beginning of a line, which would start a request, backslashes,
/// and hyphens, which are printed as minus signs so that options can be copied.
std::string escaped(const std::string& text) {
  std::string result;
  bool at_line_start = true;
  for (const char c : text) {
    if (at_line_start && (c == '.' || c == '\'')) result += "\\&";
    at_line_start = c == '\n';
    result += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
  }
  return result;
}

std::string upper(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) { return c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c; });
  return text;
}

void print_heading(std::ostream& out, const std::string& page, const std::string& meaning) {
  out << ".TH " << upper(page) << " 1 \"\" \"" << program_version() << "\" \"Commands\"\n.SH NAME\n"
      << escaped(page + " - " + meaning) << '\n';
}

void print_options(std::ostream& out, const std::vector<DeclaredOption>& options) {
  for (const DeclaredOption& option : options) {
    out << ".TP\n.B " << escaped((option.short_name.empty() ? "" : option.short_name + ", ") + option.name)
        << (option.type.empty() || option.type == option.name ? "" : " ")
        << (option.type == option.name ? "" : escaped(option.type)) << '\n'
        << escaped(option.meaning) << (option.required ? " (required)" : "") << '\n';
  }
}

/// Prints the lines of a footer; a line that begins with "Example:" becomes a section with a verbatim block.
void print_footer(std::ostream& out, const std::string& footer) {
  std::istringstream lines(footer);
  for (std::string line; std::getline(lines, line);) {
    const std::string example = "Example: ";
    if (line.starts_with(example))
      out << ".SH EXAMPLE\n.EX\n" << escaped(line.substr(example.size())) << "\n.EE\n";
    else
      out << escaped(line) << '\n';
  }
}

void print_command(std::ostream& out, const DeclaredCommand& command, const std::string& program) {
  print_heading(out, program + "-" + command.name, command.meaning);
  out << ".SH SYNOPSIS\n.B " << escaped(program + " " + command.name);
  for (const DeclaredOption& argument : command.arguments)
    out << ' ' << escaped(argument.required ? argument.type : "[" + argument.type + "]");
  out << " [OPTIONS]\n";
  if (!command.arguments.empty()) out << ".SH ARGUMENTS\n";
  print_options(out, command.arguments);
  out << ".SH OPTIONS\n";
  print_options(out, command.options);
  if (!command.footer.empty()) out << ".SH NOTES\n";
  print_footer(out, command.footer);
  out << ".SH SEE ALSO\n.BR " << escaped(program) << " (1)\n";
}

void print_program(std::ostream& out, const std::vector<DeclaredCommand>& commands, const std::string& program) {
  print_heading(out, program, kProgramMeaning);
  out << ".SH SYNOPSIS\n.B " << escaped(program) << " COMMAND [ARGUMENTS] [OPTIONS]\n.SH COMMANDS\n";
  for (const DeclaredCommand& command : commands)
    out << ".TP\n.BR " << escaped(program + "-" + command.name) << " (1)\n" << escaped(command.meaning) << '\n';
  out << ".SH NOTES\n";
  print_footer(out, kProgramNotes);
}

void print_page(std::ostream& out, const std::string& name, const std::vector<DeclaredCommand>& commands,
                const std::string& program) {
  if (name.empty()) return print_program(out, commands, program);
  const auto found = std::ranges::find(commands, name, &DeclaredCommand::name);
  if (found != commands.end()) return print_command(out, *found, program);
  std::vector<std::string> known;
  for (const DeclaredCommand& command : commands) known.push_back(command.name);
  throw ConfigError({"", 0, "manual"}, "the unknown command '" + name + "'", "one of " + join(known),
                    nearest_name(name, known));
}

void write_page(const std::filesystem::path& file, const std::string& name,
                const std::vector<DeclaredCommand>& commands, const std::string& program) {
  std::ofstream out(file);
  print_page(out, name, commands, program);
  out.close();
  if (!out) throw std::runtime_error(file.string() + ": cannot be written");
}

void write_pages(const std::filesystem::path& folder, const std::vector<DeclaredCommand>& commands,
                 const std::string& program) {
  std::filesystem::create_directories(folder);
  write_page(folder / (program + ".1"), "", commands, program);
  for (const DeclaredCommand& command : commands)
    write_page(folder / (program + "-" + command.name + ".1"), command.name, commands, program);
}

}  // namespace

void add_manual(CLI::App& app, Session& session) {
  struct ManualArguments {
    std::string command, into;
  };
  auto [command, a] = add_command<ManualArguments>(
      app, "manual", "Print a manual page in the format of man(1).",
      "Example: pkmopt manual run | man -l -\nInstalled packages contain these pages: 'man pkmopt', 'man pkmopt-run'.",
      [&session](const ManualArguments& arguments) {
        const std::vector<DeclaredCommand> commands = declared_commands(session);
        if (arguments.into.empty())
          print_page(std::cout, arguments.command, commands, session.program);
        else
          write_pages(arguments.into, commands, session.program);
      });
  auto* const one =
      add_option(command, "COMMAND", a.command, "Command whose page to print (default: the page of the program)");
  add_option(command, "-o,--into DIR", a.into, "Write all pages into this folder")->excludes(one);
}

}  // namespace pkm
