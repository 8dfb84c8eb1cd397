// `pkmopt list`: the catalogues. The text shows what the JSON holds: a value per line, a table per list.

#include <iostream>

#include "experiments/app/catalogue.hpp"
#include "experiments/app/commands.hpp"

namespace pkm {
namespace {

struct ListArguments {
  std::string kind, name;
  bool json = false, markdown = false;
};

/// A word that several catalogues know is told once per catalogue.
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
  std::cout << "\n'" << program << " list KIND NAME' tells everything of one entry.\n";
}

std::vector<std::string> entry_names(const Json& entries) {
  std::vector<std::string> names;
  for (const auto& entry : entries) names.push_back(entry["name"].get<std::string>());
  return names;
}

/// The entry of one catalogue called `name`.
const Json& find_entry(const Json& entries, const std::string& kind, const std::string& name) {
  for (const auto& entry : entries)
    if (entry["name"] == name) return entry;
  const auto known = entry_names(entries);
  throw ConfigError({"", 0, "list " + kind}, "the unknown name '" + name + "'", "one of " + join(known),
                    nearest_name(name, known));
}

/// The entries called `word` by their catalogue, where a catalogue's name was expected.
Json find_anywhere(const Json& catalogues, const std::string& word) {
  std::vector<std::string> known;
  Json found = Json::object();
  for (const auto& [kind, entries] : catalogues.items()) {
    known.push_back(kind);
    for (const auto& entry : entries)
      if (entry["name"] == word) found[kind] = entry;
  }
  if (!found.empty()) return found;
  const std::string expected = "one of " + join(known) + ", or the name of an entry";
  for (const auto& [kind, entries] : catalogues.items())
    for (const auto& name : entry_names(entries)) known.push_back(name);
  throw ConfigError({"", 0, "list"}, "the unknown word '" + word + "'", expected, nearest_name(word, known));
}

void list(const Session& session, const ListArguments& arguments) {
  const auto& [kind, name, json, markdown] = arguments;
  const Json all = catalogues_json(session.catalogues);
  if (markdown) {
    std::cout << catalogues_markdown(all);
  } else if (kind.empty() || (name.empty() && all.contains(kind))) {
    const Json listed = kind.empty() ? all : Json{{kind, all[kind]}};
    json ? print_json(listed) : print_overview(listed, session.program);
  } else {
    Json found = Json::object();
    if (all.contains(kind))
      found[kind] = find_entry(all[kind], kind, name);
    else
      found = find_anywhere(all, kind);
    json ? print_json(found.size() == 1 ? found.front() : found) : print_found(found);
  }
}

}  // namespace

void add_list(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_command<ListArguments>(
      app, "list", "What a study may name: mechanisms, objectives, constraints, optimisers.",
      "Example: pkmopt list mechanisms 4ppa-2par", [&session](const ListArguments& given) { list(session, given); });
  add_option(command, "KIND", arguments.kind, "mechanisms, objectives, constraints or optimisers (default: all)");
  add_option(command, "NAME", arguments.name,
             "One entry, with everything known of it: parameters, limits, options, ...");
  command.add_flag("--json", arguments.json, "Print one JSON object, with everything known of each entry");
  command
      .add_flag("--markdown", arguments.markdown,
                "Print everything known of all entries, as it stands in experiments/catalogue.md")
      ->excludes("KIND")
      ->excludes("--json");
}

}  // namespace pkm
