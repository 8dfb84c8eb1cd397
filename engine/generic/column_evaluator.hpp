// Workspace analysis by columns for mechanism files.
#pragma once

#include <memory>

#include "engine/generic/evaluation.hpp"
#include "engine/mechanism/plan.hpp"
#include "engine/mechanism/workspace_evaluator.hpp"

namespace pkm::generic {

/// Makes the evaluator of columns for a plan. Throws std::invalid_argument with a message if columns do not support the
/// plan.
/// @param evaluation  must outlive the evaluator
std::unique_ptr<const WorkspaceEvaluator> prepare_columns(const Evaluation& evaluation, const WorkspacePlan& plan,
                                                          const ColumnOptions& columns, const FieldRequest& request);

}  // namespace pkm::generic
