// The part of the ranks after the first in the runs of a program of several (engine/core/ranks.hpp).
//
// Each rank runs the same stages on the same table; only evaluations are shared out. Rank 0 alone reads, locks and
// writes the study, talks, and decides after each generation whether to go on.
#pragma once

#include <string>

#include "engine/setup/study.hpp"
#include "engine/study/run_outcome.hpp"

namespace pkm {

/// What the ranks after the first do: they take part in the runs that rank 0 begins, print and write nothing, and
/// return the exit code that it dismisses them with.
int take_part(const Catalogues& catalogues, const ProgramVersion& program);

/// What rank 0 broadcasts before a run: all that the others have to know of it. "" where there are none.
std::string invitation(const StudyContents& contents, const RunOptions& options);

/// Rank 0, at the program's end: the others end too.
void dismiss_ranks(int exit_code);

}  // namespace pkm
