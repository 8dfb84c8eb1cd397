// `pkmopt upgrade`: replaces old names of keys in studies and mechanism files by the present ones.

#include <iostream>

#include "engine/config/text_file.hpp"
#include "engine/config/upgrade.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/storage/safe_file.hpp"
#include "experiments/app/commands.hpp"

namespace pkm {
namespace {

struct UpgradeArguments {
  std::vector<std::string> files;
  bool check = false;
};

void upgrade(const UpgradeArguments& arguments, Session& session) {
  struct File {
    std::string name;
    UpgradedText upgraded;
  };
  // All files are read before the first one is written, so that an error in one of them leaves all files unchanged.
  std::vector<File> files;
  for (const std::string& name : arguments.files)
    files.push_back({name, upgraded_file(read_text_file(name, "a study or a mechanism in TOML"), name)});
  for (const auto& [name, upgraded] : files) {
    for (const ReplacedKey& key : upgraded.replaced)
      std::cout << name << ':' << key.line << ": " << key.old_path << " is now called " << key.name << '\n';
    if (upgraded.replaced.empty()) {
      std::cout << name << ": no change needed\n";
    } else if (arguments.check) {
      session.exit_code = kFailure;
    } else {
      write_file(name, upgraded.text, Existing::replaced);
      std::cout << name << ": rewritten\n";
    }
  }
}

}  // namespace

void add_upgrade(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_command<UpgradeArguments>(
      app, "upgrade", "Replace old names of keys in studies and mechanism files by the present ones.",
      "Only the keys change; comments and layout stay. Study files (.h5) need no upgrade: their texts are upgraded\n"
      "when they are read. Exit code of --check: 1 if a file has to be upgraded.\n"
      "Example: pkmopt upgrade study.toml robot.toml",
      [&session](const UpgradeArguments& given) { upgrade(given, session); });
  add_option(command, "FILE.toml", arguments.files, "Studies and mechanism files, rewritten in place")->required();
  command.add_flag("--check", arguments.check, "Print what would change, and change nothing");
}

}  // namespace pkm
