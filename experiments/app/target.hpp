// What the commands that look at one design have in common: MECHANISM|STUDY.toml or --from F.h5, --set and --json.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/report/chosen_design.hpp"

namespace CLI {
class App;
}

namespace pkm {

struct DesignArguments {
  std::string target;            ///< a mechanism's name or the path of a study
  std::vector<std::string> set;  ///< lists of name=value
  std::string masses;            ///< a mass model; "": the study's, else the mechanism's default
  std::string from;              ///< instead of `target`: a study file
  DesignChoice choice;           ///< which of the file's designs
  bool json = false;
};

/// Declares the arguments above; what is parsed goes to `arguments`, which must outlive `command`.
void add_design_arguments(CLI::App& command, DesignArguments& arguments);

/// Declares --baseline, --generation, --individual, --front and --stage.
void add_choice_options(CLI::App& command, DesignChoice& choice);
/// The first of them that is given; null: none.
const char* given_option(const DesignChoice& choice);

/// Declares a list option such as --at: name=value, separated by commas, repeatable.
void add_list_option(CLI::App& command, const std::string& option, std::vector<std::string>& lists,
                     const std::string& meaning, bool required);

struct ModeArguments {
  std::string mode;    ///< "": the default
  std::string branch;  ///< sign required of the mechanism's branch; "": what the mode says
};

/// Declares --mode and --branch.
void add_mode_options(CLI::App& command, ModeArguments& arguments);
/// The mode asked for, as the mechanism calls it. Refuses one that it does not have.
std::string known_mode(const MechanismInfo& info, const ModeArguments& arguments);

/// The ability of a mechanism that a command needs. Throws ConfigError, naming both, where it has it not.
template <class Ability>
const Ability& needed(const Ability* ability, const std::string& command, const std::string& what,
                      const MechanismInfo& info) {
  if (!ability) throw ConfigError({}, command + " needs " + what + ", and mechanism " + info.name + " has none");
  return *ability;
}

/// One design of a mechanism, and the study that it comes from, if it does.
struct Target {
  std::shared_ptr<const Mechanism> mechanism;
  std::optional<Study> study;
  LimitSpec limits;  ///< the study's; none for a bare mechanism
  /// The study's baseline, else its parameters, else the mechanism's defaults; then what --set names.
  std::vector<double> parameters;
  std::string words;      ///< where they come from: "the baseline"
  std::string file_name;  ///< the same for names of files: "baseline"

  const MechanismInfo& info() const { return mechanism->info(); }
};

/// Throws ConfigError when there is no such mechanism or study, or --set describes no mechanism.
Target find_target(const Catalogues& catalogues, const DesignArguments& arguments);

}  // namespace pkm
