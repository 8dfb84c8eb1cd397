// Readers of the tables of a study, one function for each, in the order in which read_study_toml calls them. Each reads
// its tables from the document's root table and adds to the draft. study_keys.hpp describes the keys.
#pragma once

#include <functional>
#include <string>

#include "engine/config/config_value.hpp"
#include "engine/config/mechanism_file.hpp"
#include "engine/config/study.hpp"
#include "engine/config/tables.hpp"

namespace pkm {

/// Result of the readers that have been called.
struct StudyDraft {
  const Catalogues& catalogues;
  /// Reads the mechanism file that [mechanism] names.
  std::function<SourceText(const ConfigValue& file)> description;
  Study study;
  ProblemParts parts;
  std::vector<LimbParameter> limb_parameters = {};  ///< those that the study or the command line names
  std::vector<StudyChanges> changes = {};           ///< those in the text, then those of this command line
  ImpliedConstraints implied = ImpliedConstraints::added;

  const MechanismInfo& info() const { return parts.mechanism->info(); }
};

/// [[override]]: changes by the command line
void read_overrides(const ConfigValue& root, StudyDraft& draft);
/// Apply the overrides of fixed parameters, and of limits.
void override_parameters(const ConfigValue& root, StudyDraft& draft);
void override_limits(StudyDraft& draft);
/// [mechanism]: type or file, masses, fixed parameters.
void read_mechanism(const ConfigValue& root, StudyDraft& draft);
/// [[drive_train]]: gears, screws, rotors and losses between motors and joints, which become part of the mechanism.
void read_drive_trains(const ConfigValue& root, StudyDraft& draft);
/// [variables]
void read_variables(const ConfigValue& root, StudyDraft& draft);
/// [baseline]
void read_baseline(const ConfigValue& root, StudyDraft& draft);
/// [workspace]: method, grid or accuracy, fixed coordinates, limits.
void read_workspace(const ConfigValue& root, StudyDraft& draft);
/// Sets the default cells or accuracy of the method of `plan`.
void set_defaults(const MechanismInfo& info, WorkspacePlan& plan);
/// The [[constraint]]s that limit poses. They become part of the plan of the workspace analysis, and are therefore read
/// before all tables that use this plan.
void read_pose_constraints(const ConfigValue& root, StudyDraft& draft);
/// [[obstacle]]: bodies fixed to the base; the clearance limit also applies to their distance from the links.
void read_obstacles(const ConfigValue& root, StudyDraft& draft);
/// [[region]]: named parts of the workspace with analyses of their own, under the study's limits.
void read_regions(const ConfigValue& root, StudyDraft& draft);
/// [[motion]]
void read_motions(const ConfigValue& root, StudyDraft& draft);
/// [[objective]], the other [[constraint]]s and [[output]], and the constraints that their motions imply
void read_quantities(const ConfigValue& root, StudyDraft& draft);
/// [[reference]]
void read_references(const ConfigValue& root, StudyDraft& draft);
/// [[stage]]
void read_stages(const ConfigValue& root, StudyDraft& draft);

/// The options with kUnitOfEntry replaced by `unit`.
std::vector<OptionSpec> with_entry_unit(std::vector<OptionSpec> specs, const std::string& unit);
}  // namespace pkm
