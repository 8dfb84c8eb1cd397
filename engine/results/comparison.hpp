// Comparison of the best design with the baseline and with its constraints, shared by terminal, JSON and HTML output.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/problem/diagnosis.hpp"
#include "engine/problem/failures.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// Difference of an objective value from the baseline's value.
struct Gain {
  double percent = 0;  ///< 100 (value - baseline) / |baseline|
  bool worse = false;  ///< true: the value is worse than that of the baseline, in the objective's direction
};
/// @return std::nullopt if the baseline's value is 0 or one of the values is NaN
std::optional<Gain> gain_over(double baseline, double value, Direction direction);

/// The best evaluation recorded so far; the study need not have ended. Volume and cells are not set: they are
/// computed only when a study ends.
/// @return std::nullopt if nothing has been evaluated
std::optional<DesignRecord> best_so_far(const StudyContents& contents);

/// Explains why a finished study has found no useful design (no feasible one, or empty workspaces only).
/// @param problem  the study's problem, used to evaluate designs again; null if this program cannot read the study's
///                 text: the diagnosis is then less detailed
/// @return std::nullopt if the study has found a useful design, or has not finished
std::optional<Diagnosis> diagnose(const StudyContents& contents, const DesignProblem* problem);

/// Counts the failed evaluations of all stages and finds the reasons of some of them.
/// @param problem  the study's problem, used to evaluate designs again; null: no reasons are found
Failures collect_failures(const StudyContents& contents, const DesignProblem* problem);

/// Label of the best evaluation in tables: "best"; "best so far" before the study's end; "compromise" for several
/// objectives. For a finished study without a feasible design: "least infeasible"; if designs are feasible but every
/// workspace is empty: "empty workspace".
std::string best_design_label(const StudyContents& contents);

/// For each final design whose exact volume lies outside its certified bounds, one sentence; such a contradiction
/// indicates a numerical error.
std::vector<std::string> contradicted(const StudyContents& contents);

/// Index of the most negative margin, i.e. of the most violated constraint; std::nullopt if all are satisfied.
std::optional<std::size_t> most_violated(std::span<const double> margins);

}  // namespace pkm
