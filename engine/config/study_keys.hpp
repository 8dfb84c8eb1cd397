// The tables and keys of studies, motion files and motor files: descriptions for the readers, the JSON Schema and the
// reference of keys.
#pragma once

#include "engine/core/options.hpp"

namespace pkm {

/// The tables of a study, as keys of the document. [[objective]], [[constraint]], [[output]] and [[stage]] have, in
/// addition, the options of the catalogue entry that their `type` or `optimiser` names.
const TableSpec& study_keys();

// The keys of [[constraint]]s besides the options of their catalogue entries: of a constraint that limits poses; of any
// other constraint with a margin; and of an objective that `min` or `max` makes a constraint.
const TableSpec& pose_constraint_keys();
const TableSpec& margin_constraint_keys();
const TableSpec& bounded_objective_keys();

/// Keys of [workspace], [[region]] and [[drive_train]].
const TableSpec& workspace_keys();
const TableSpec& region_keys();
const TableSpec& drive_train_keys();

/// Keys of a [[motion]] of a study, and of a motion file, which has neither `name` nor `follow`.
const TableSpec& motion_keys();
const TableSpec& motion_file_keys();
/// The tables of a task file.
const TableSpec& task_keys();
/// Keys of a [[motor]], and the tables of a motor file.
const TableSpec& motor_keys();
const TableSpec& motor_file_keys();

}  // namespace pkm
