// Diagnosis of studies without a useful design: consistency checks of the study before a run, and the reasons why no
// evaluated design is feasible or every workspace is empty. Shared by `check`, `run`, `show` and the report.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/problem/design_problem.hpp"

namespace pkm {

/// One reason why a study has no useful design, or one contradiction between its requirements.
struct Reason {
  std::string kind;                ///< "contradiction", "constraint", "limit" (of a pose) or "failure"
  std::vector<std::string> names;  ///< names of the constraints, limits or coordinates concerned
  std::string sentence;
};

/// Why a set of evaluated designs contains no useful design.
struct Diagnosis {
  std::string finding;          ///< "nothing feasible", or "nothing found": feasible designs with empty workspaces only
  std::string sentence;         ///< "none of 40 designs is feasible: 30 infeasible, 10 rejected"
  std::vector<Reason> reasons;  ///< known reasons, the most informative first
};

/// Contradictory requirements, which no design within the bounds can satisfy, as far as they follow from the study
/// alone: a lower threshold above the upper one, fixed coordinates or boxes out of reach, constraint bounds outside the
/// range of their quantity.
std::vector<Reason> contradictions(const ProblemParts& parts);

/// Requirements that are most likely mistakes, although they do not contradict each other: bounds that every design
/// satisfies, or a list of values of a fixed coordinate, of which one is out of reach. One sentence each.
std::vector<std::string> consistency_warnings(const ProblemParts& parts);

/// Diagnoses evaluated designs.
/// @param problem  the problem of the tables, used to evaluate some designs again; null: an objective value of 0 is
///                 assumed to be that of an empty workspace
/// @return nullopt if there are no designs, or if one is feasible with a non-empty workspace or an objective that does
///         not depend on the workspace
std::optional<Diagnosis> diagnose(const std::vector<const EvaluationTable*>& tables,
                                  const std::vector<ObjectiveInfo>& objectives, const std::vector<MarginInfo>& margins,
                                  const DesignProblem* problem);

/// The diagnosis as a single line: its sentence and the first reasons, at most 1000 bytes.
std::string one_line_summary(const Diagnosis& diagnosis);

}  // namespace pkm
