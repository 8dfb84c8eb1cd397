// How a design stands beside the baseline and its constraints: what every account of a study says the same way.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/problem/failures.hpp"
#include "engine/problem/verdict.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// How a value differs from the baseline's.
struct Gain {
  double percent = 0;  ///< of the baseline's size; > 0 where the value is larger
  bool worse = false;  ///< in the objective's direction
};
/// None where there is nothing to compare: the baseline's value is 0, or one is NaN.
std::optional<Gain> gain_over(double baseline, double value, Direction direction);

/// The best evaluation as the file has it, also before the study's end; none while nothing is evaluated. Without what
/// is worked out once the study has ended: volume and cells.
std::optional<DesignRecord> best_so_far(const StudyContents& contents);

/// Why a study that has ended found nothing; none: it found something, or has not ended.
/// @param problem  what it optimises; null where this program cannot read its text: less is known then
std::optional<Verdict> verdict_on(const StudyContents& contents, const DesignProblem* problem);

/// The failed evaluations of all stages, and reasons.
/// @param problem  as above; null: no reason is known
Failures failures_in(const StudyContents& contents, const DesignProblem* problem);

/// What the best evaluation is called: "best", "best so far" before the study's end, "compromise" where there are
/// several objectives; "least bad" where nothing was feasible, "as good as any" where no objective says anything.
std::string name_of_best(const StudyContents& contents);

/// A sentence for each design whose exact volume lies outside of its certain bounds.
std::vector<std::string> contradicted(const StudyContents& contents);

/// The margin that is broken most; none where all hold.
std::optional<std::size_t> most_broken(std::span<const double> margins);

}  // namespace pkm
