// The sections of a study file, one function each, in the order in which read_study_toml calls them. Each reads its
// part of the document's root table and adds to what is known of the problem.
#pragma once

#include <functional>
#include <string>

#include "engine/config/config_value.hpp"
#include "engine/config/mechanism_file.hpp"
#include "engine/config/study.hpp"
#include "engine/config/tables.hpp"

namespace pkm {

/// What the sections build up together.
struct StudyDraft {
  const Catalogues& catalogues;
  /// What is in the file of a mechanism that [mechanism] names.
  std::function<SourceText(const ConfigValue& file)> description;
  Study study;
  ProblemParts parts;
  std::vector<LimbParameter> limb_parameters = {};  ///< that the study names, or the command line
  std::vector<StudyChanges> changes = {};           ///< the text's own, then what the command line says now
  ImpliedConstraints implied = ImpliedConstraints::added;

  const MechanismInfo& info() const { return parts.mechanism->info(); }
};

/// [[override]]
void read_overrides(const ConfigValue& root, StudyDraft& draft);
/// What they say of fixed parameters; of limits.
void override_parameters(const ConfigValue& root, StudyDraft& draft);
void override_limits(StudyDraft& draft);
/// [mechanism]: type or file, masses, fixed parameters.
void read_mechanism(const ConfigValue& root, StudyDraft& draft);
/// [[drive_train]]: gears, screws, rotors and losses between motors and joints, which the mechanism has from there on.
void read_drive_trains(const ConfigValue& root, StudyDraft& draft);
/// [variables]
void read_variables(const ConfigValue& root, StudyDraft& draft);
/// [baseline]
void read_baseline(const ConfigValue& root, StudyDraft& draft);
/// [workspace]: method, grid or accuracy, fixed coordinate, limits.
void read_workspace(const ConfigValue& root, StudyDraft& draft);
/// Cells and accuracy of a survey by the plan's method where a study names none.
void set_usual(const MechanismInfo& info, WorkspacePlan& plan);
/// The [[constraint]]s that cut the workspace: they complete the survey plan, so they come before what uses it.
void read_pose_constraints(const ConfigValue& root, StudyDraft& draft);
/// [[obstacle]]: what stands fixed in the base, of which links keep clear.
void read_obstacles(const ConfigValue& root, StudyDraft& draft);
/// [[region]]: named parts of the workspace with surveys of their own, under the study's limits of a pose.
void read_regions(const ConfigValue& root, StudyDraft& draft);
/// [[motion]]
void read_motions(const ConfigValue& root, StudyDraft& draft);
/// [[objective]], the other [[constraint]]s and [[report]], and the constraints that their motions imply
void read_quantities(const ConfigValue& root, StudyDraft& draft);
/// [[reference]]
void read_references(const ConfigValue& root, StudyDraft& draft);
/// [[stage]]
void read_stages(const ConfigValue& root, StudyDraft& draft);

/// The options with kUnitOfEntry replaced by `unit`.
std::vector<OptionSpec> with_entry_unit(std::vector<OptionSpec> specs, const std::string& unit);
/// Refuses keys that are neither in `keys` nor the name of one of `specs`.
void allow_options(const ConfigValue& table, std::vector<std::string> keys, const std::vector<OptionSpec>& specs);

}  // namespace pkm
