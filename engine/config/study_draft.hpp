// Readers of the tables of a study, one function for each, in the order in which read_study_toml calls them. Each reads
// its tables from the document's root table and adds to the draft. study_keys.hpp describes the keys.
#pragma once

#include <functional>
#include <string>

#include "engine/config/choices.hpp"
#include "engine/config/config_value.hpp"
#include "engine/config/mechanism_file.hpp"
#include "engine/config/study.hpp"
#include "engine/config/tables.hpp"

namespace pkm {

/// The study as far as it has been read; each reader adds to it.
struct StudyDraft {
  const Catalogues& catalogues;
  /// Reads the mechanism file that [mechanism] names.
  std::function<SourceText(const ConfigValue& file)> description;
  Study study;
  ProblemParts parts;
  /// Parameters of single limbs that the study or the command line names.
  std::vector<LimbParameter> limb_parameters = {};
  std::vector<StudyChanges> changes = {};  ///< [[override]]s in the text of the study, then changes by the command line
  std::vector<Catalogue> from_catalogues = {};  ///< catalogues from which variables choose rows
  ImpliedConstraints implied = ImpliedConstraints::added;
  /// Parameters of single limbs that the machine as built has in addition, because of [tolerance].
  std::vector<LimbParameter> copies = {};
  bool has_tolerances = false;  ///< the study has a table [tolerance]

  const MechanismInfo& info() const { return parts.mechanism->info(); }
};

/// Reads the tables [[override]]: changes by the command line.
void read_overrides(const ConfigValue& root, StudyDraft& draft);
/// Applies the changes of fixed parameters by [[override]] tables and by the command line.
void override_parameters(const ConfigValue& root, StudyDraft& draft);
/// Applies the changes of limits on poses by [[override]] tables and by the command line.
void override_limits(StudyDraft& draft);
/// Reads the designs in [[override]] tables and on the command line from which the first stage starts.
void override_starts(StudyDraft& draft);
/// Reads [mechanism]: type or file, masses, fixed parameters.
void read_mechanism(const ConfigValue& root, StudyDraft& draft);
/// Reads the tables [[drive_train]]: gears, screws, rotors and losses between motors and joints, which become part of
/// the mechanism.
void read_drive_trains(const ConfigValue& root, StudyDraft& draft);
/// Reads the table [variables].
void read_variables(const ConfigValue& root, StudyDraft& draft);
/// Reads the table [baseline].
void read_baseline(const ConfigValue& root, StudyDraft& draft);
/// Reads [workspace]: method, grid or accuracy, fixed coordinates, limits.
void read_workspace(const ConfigValue& root, StudyDraft& draft);
/// Sets the default number of cells or the default tolerance, depending on the method of the plan.
void set_defaults(const MechanismInfo& info, WorkspacePlan& plan);
/// Reads the [[constraint]]s that limit poses. They become part of the plan of the workspace analysis, and are
/// therefore read before all tables that use this plan.
void read_pose_constraints(const ConfigValue& root, StudyDraft& draft);
/// Reads the tables [[obstacle]]: bodies fixed to the base; the clearance limit also applies to their distance from the
/// links.
void read_obstacles(const ConfigValue& root, StudyDraft& draft);
/// Reads the tables [[region]]: named parts of the workspace with analyses of their own, under the study's limits.
void read_regions(const ConfigValue& root, StudyDraft& draft);
/// Reads the tables [[motion]].
void read_motions(const ConfigValue& root, StudyDraft& draft);
/// Reads [[objective]], [[output]] and the [[constraint]]s that do not limit poses, and adds the constraints that the
/// motions used by them imply.
void read_quantities(const ConfigValue& root, StudyDraft& draft);
/// Reads [tolerance], and adds the built machines to the problem if a quantity is a statistic over them. Called after
/// all other tables of the problem have been read.
/// @param read_problem  reads the problem of another draft from the same tables
void read_tolerances(const ConfigValue& root, const std::function<void(StudyDraft&)>& read_problem, StudyDraft& draft);
/// Reads the tables [[reference]].
void read_references(const ConfigValue& root, StudyDraft& draft);
/// Reads the tables [[stage]].
void read_stages(const ConfigValue& root, StudyDraft& draft);

/// The specifications of options with the placeholder kUnitOfEntry replaced by `unit`.
std::vector<OptionSpec> with_entry_unit(std::vector<OptionSpec> specs, const std::string& unit);
}  // namespace pkm
