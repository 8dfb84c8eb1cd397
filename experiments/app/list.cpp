// `pkmopt list`: shows the entries of the catalogues, and mechanism files in the same form. The text is generated from
// the JSON: one line per value, one table per list.

#include <algorithm>
#include <iostream>
#include <iterator>
#include <stdexcept>

#include "engine/config/built_in_mechanisms.hpp"
#include "engine/core/catalogue.hpp"
#include "experiments/app/catalogue.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

struct ListArguments {
  std::string kind, name;
  bool json = false, markdown = false, file = false;
};

/// Prints the entries found. If they are from several catalogues, each is preceded by the name of its catalogue.
void print_found(const Json& found) {
  bool first = true;
  for (const auto& [kind, entry] : found.items()) {
    if (found.size() > 1) std::cout << (first ? "" : "\n") << kind << '\n';
    std::cout << entry_text(entry);
    first = false;
  }
}

void print_overview(const Json& catalogues, const std::string& program) {
  bool first = true;
  for (const auto& [kind, entries] : catalogues.items()) {
    std::cout << (first ? "" : "\n") << kind << '\n';
    std::vector<Row> rows;
    for (const auto& entry : entries) rows.push_back({cell_text(entry["name"]), cell_text(entry["meaning"])});
    std::cout << aligned(rows);
    if (kind == "constraints") std::cout << "  or any objective, with min = .. or max = ..\n";
    first = false;
  }
  std::cout << "\n'" << program << " list KIND NAME' shows the details of one entry.\n";
}

std::vector<std::string> entry_names(const Json& entries) {
  std::vector<std::string> names;
  for (const auto& entry : entries) names.push_back(entry["name"].get<std::string>());
  return names;
}

/// The entry `name` of one catalogue. Throws ConfigError if there is none.
const Json& find_entry(const Json& entries, const std::string& kind, const std::string& name) {
  for (const auto& entry : entries)
    if (entry["name"] == name) return entry;
  const auto known = entry_names(entries);
  throw ConfigError({"", 0, "list " + kind}, "the unknown name '" + name + "'",
                    "one of " + join(known) + (kind == "mechanisms" ? ", or a mechanism file" : ""),
                    nearest_name(name, known));
}

/// @return true if a catalogue has an entry of that name
bool is_known(const Json& catalogues, const std::string& name) {
  return std::ranges::any_of(catalogues, [&name](const Json& entries) {
    return std::ranges::any_of(entries, [&name](const Json& entry) { return entry["name"] == name; });
  });
}

/// All entries of the name `word`, as an object with one member for each catalogue that has one. Throws ConfigError if
/// there is none.
Json find_anywhere(const Json& catalogues, const std::string& word) {
  std::vector<std::string> known;
  Json found = Json::object();
  for (const auto& [kind, entries] : catalogues.items()) {
    known.push_back(kind);
    for (const auto& entry : entries)
      if (entry["name"] == word) found[kind] = entry;
  }
  if (!found.empty()) return found;
  const std::string expected = "one of " + join(known) + ", the name of an entry, or a mechanism file";
  for (const auto& [kind, entries] : catalogues.items())
    for (const auto& name : entry_names(entries)) known.push_back(name);
  throw ConfigError({"", 0, "list"}, "the unknown word '" + word + "'", expected, nearest_name(word, known));
}

/// Prints the text of the mechanism file of a built-in mechanism.
void print_mechanism_file(const std::string& name, const Session& session) {
  const auto known = [](const auto& entry) { return entry.name(); };
  std::vector<std::string> names;
  std::ranges::transform(session.catalogues.mechanisms, std::back_inserter(names), known);
  if (!contains(names, name))
    throw ConfigError({"", 0, "--file"}, "'" + name + "', which is not a mechanism of the catalogue",
                      "one of " + join(names), nearest_name(name, names));
  try {
    std::cout << mechanism_file_text(name);
  } catch (const std::invalid_argument&) {
    throw ConfigError({"", 0, "--file"}, "mechanism " + name + " is written in C++ and has no file");
  }
}

void list(const Session& session, const ListArguments& arguments) {
  const auto& [kind, name, json, markdown, file] = arguments;
  if (file) return print_mechanism_file(name.empty() ? kind : name, session);
  const Json all = catalogues_json(session.catalogues);
  if (markdown) {
    std::cout << catalogues_markdown(all);
  } else if (kind.empty() || (name.empty() && all.contains(kind))) {
    const Json listed = kind.empty() ? all : Json{{kind, all[kind]}};
    json ? print_json(listed) : print_overview(listed, session.program);
  } else {
    Json found = Json::object();
    const auto json_of_file = [&session](const std::string& mechanism) {
      return mechanism_json(*find_mechanism(session.catalogues, mechanism), session.catalogues);
    };
    if (kind == "mechanisms" && !is_known(all, name) && looks_like_file(name))
      found[kind] = json_of_file(name);
    else if (all.contains(kind))
      found[kind] = find_entry(all[kind], kind, name);
    else if (name.empty() && !is_known(all, kind) && looks_like_file(kind))
      found["mechanisms"] = json_of_file(kind);
    else
      found = find_anywhere(all, kind);
    json ? print_json(found.size() == 1 ? found.front() : found) : print_found(found);
  }
}

}  // namespace

void add_list(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_command<ListArguments>(
      app, "list", "List the mechanisms, objectives, constraints and optimisers that a study can use.",
      "Example: pkmopt list mechanisms 4ppa-2par", [&session](const ListArguments& given) { list(session, given); });
  add_option(command, "KIND", arguments.kind,
             "mechanisms, objectives, constraints or optimisers (default: all), a name, or a mechanism file");
  add_option(command, "NAME", arguments.name, "Show the details of one entry: parameters, limits, options, ..");
  command.add_flag("--json", arguments.json, "Print one JSON object with the details of all entries");
  command
      .add_flag("--markdown", arguments.markdown,
                "Print the details of all entries in Markdown, as in docs/reference/catalogue.md")
      ->excludes("KIND")
      ->excludes("--json");
  command.add_flag("--file", arguments.file, "Print the file of a mechanism of the catalogue, a start for your own")
      ->needs("KIND")
      ->excludes("--json")
      ->excludes("--markdown");
}

}  // namespace pkm
