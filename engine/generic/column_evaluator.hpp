// Workspace analysis by columns for mechanism files.
#pragma once

#include <memory>

#include "engine/generic/evaluation.hpp"
#include "engine/mechanism/plan.hpp"
#include "engine/mechanism/workspace_evaluator.hpp"

namespace pkm::generic {

/// Throws std::invalid_argument, with a sentence, if columns cannot serve the plan.
std::unique_ptr<const WorkspaceEvaluator> prepare_columns(const Mechanism& mechanism, const Evaluation& evaluation,
                                                          const WorkspacePlan& plan, const ColumnOptions& columns,
                                                          const FieldRequest& request);

/// Why the default analysis of the mechanism has no columns; empty if it has.
std::string why_no_columns(const Mechanism& mechanism, const Evaluation& evaluation);

}  // namespace pkm::generic
