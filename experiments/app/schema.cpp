// `pkmopt schema`: prints the JSON Schema of studies, mechanism files, motion files, task files or motor files.

#include <iostream>

#include "engine/config/json_schema.hpp"
#include "engine/config/key_reference.hpp"
#include "engine/core/catalogue.hpp"
#include "experiments/app/commands.hpp"

namespace pkm {
namespace {

struct SchemaArguments {
  std::string kind = "study";
  bool markdown = false;
};

struct SchemaKind {
  const char* name;
  std::string (*schema)(const Catalogues&);
};

constexpr SchemaKind kSchemaKinds[] = {{"study", study_schema},
                                       {"mechanism", [](const Catalogues&) { return mechanism_schema(); }},
                                       {"motion", [](const Catalogues&) { return motion_schema(); }},
                                       {"task", task_schema},
                                       {"motors", [](const Catalogues&) { return motor_schema(); }}};

void print_schema(const SchemaArguments& arguments, const Session& session) {
  if (arguments.markdown) {
    std::cout << keys_markdown();
    return;
  }
  const SchemaKind* const kind = find_named(kSchemaKinds, arguments.kind);
  if (!kind)
    throw ConfigError({"", 0, "schema"}, "'" + arguments.kind + "'", "one of " + join(names_of(kSchemaKinds)),
                      nearest_name(arguments.kind, names_of(kSchemaKinds)));
  std::cout << kind->schema(session.catalogues);
}

}  // namespace

void add_schema(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_command<SchemaArguments>(
      app, "schema", "Print the JSON Schema of studies or other TOML files, for editors.",
      "An editor that uses Taplo (Even Better TOML) completes and checks the keys of a file whose first line is\n"
      "#:schema ./pkmopt.schema.json\n"
      "Example: pkmopt schema > pkmopt.schema.json && pkmopt schema mechanism > pkmopt-mechanism.schema.json",
      [&session](const SchemaArguments& given) { print_schema(given, session); });
  add_option(command, "FORMAT", arguments.kind, "Kind of file: study (default), mechanism, motion, task or motors");
  command.add_flag("--markdown", arguments.markdown,
                   "Print all keys of all kinds of files in Markdown, as in docs/reference/keys.md");
}

}  // namespace pkm
