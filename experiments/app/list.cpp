// `pkmopt list`: the catalogues, and mechanisms that a file describes. The text shows what the JSON holds: a value per
// line, a table per list.

#include <algorithm>
#include <iostream>

#include "experiments/app/catalogue.hpp"
#include "experiments/app/target.hpp"

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
  throw ConfigError({"", 0, "list " + kind}, "the unknown name '" + name + "'",
                    "one of " + join(known) + (kind == "mechanisms" ? ", or a mechanism's file" : ""),
                    nearest_name(name, known));
}

/// Some catalogue has an entry of that name.
bool known(const Json& catalogues, const std::string& name) {
  return std::ranges::any_of(catalogues, [&name](const Json& entries) {
    return std::ranges::any_of(entries, [&name](const Json& entry) { return entry["name"] == name; });
  });
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
  const std::string expected = "one of " + join(known) + ", the name of an entry, or a mechanism's file";
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
    const auto described = [&session](const std::string& file) {
      return mechanism_json(*find_mechanism(session.catalogues, file), session.catalogues);
    };
    if (kind == "mechanisms" && !known(all, name) && may_be_file(name))
      found[kind] = described(name);
    else if (all.contains(kind))
      found[kind] = find_entry(all[kind], kind, name);
    else if (name.empty() && !known(all, kind) && may_be_file(kind))
      found["mechanisms"] = described(kind);
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
  add_option(command, "KIND", arguments.kind,
             "mechanisms, objectives, constraints or optimisers (default: all); or a name or a mechanism's file");
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
