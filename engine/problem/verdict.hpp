// Why designs of a problem come to nothing: what is said at the end of a run that has found nothing, of a study file
// that holds nothing, and before a run of designs that were tried. One list of reasons, whoever shows it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/problem/design_problem.hpp"

namespace pkm {

/// One reason.
struct Reason {
  std::string kind;                ///< "contradiction", "constraint", "limit" (of a pose) or "failure"
  std::vector<std::string> names;  ///< what it speaks of: constraints, limits, coordinates
  std::string sentence;
};

struct Verdict {
  std::string finding;          ///< "nothing feasible", or "nothing found" where objectives say nothing
  std::string sentence;         ///< "none of 40 designs is feasible: 30 infeasible, 10 rejected"
  std::vector<Reason> reasons;  ///< as far as they are known, the most telling first
};

/// What a study asks for that no design within its bounds can keep, as far as that follows from the study alone:
/// thresholds that leave nothing between them, held coordinates and boxes out of reach, bounds of constraints out of
/// range.
std::vector<Reason> contradictions(const ProblemParts& parts);

/// What most likely is not meant, though it contradicts nothing: bounds that every design keeps, one of several values
/// that is out of reach. A sentence each.
std::vector<std::string> doubts(const ProblemParts& parts);

/// The verdict on evaluated designs; none where there are no designs, and where one is feasible, unless every feasible
/// design has an empty workspace and objectives that depend on nothing else.
/// @param problem  that they belong to, to evaluate some of them again; null: an objective of 0 counts as that of an
///                 empty workspace
std::optional<Verdict> verdict_on(const std::vector<const EvaluationTable*>& tables,
                                  const std::vector<ObjectiveInfo>& objectives, const std::vector<MarginInfo>& margins,
                                  const DesignProblem* problem);

/// The verdict in one line, for where there is no room for more: its sentence and its first reasons.
std::string one_line(const Verdict& verdict);

}  // namespace pkm
