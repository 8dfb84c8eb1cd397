// Worker ranks, i.e. all MPI ranks but rank 0, of a run on several ranks (engine/core/ranks.hpp).
//
// All ranks run the same stages redundantly on identical tables; only the evaluations are distributed. Rank 0 alone
// reads, locks and writes the study file, prints messages, and decides after each generation whether to continue.
#pragma once

#include <string>

#include "engine/config/study.hpp"
#include "engine/runner/run_outcome.hpp"

namespace pkm {

/// Main loop of a worker rank (an MPI rank other than 0): participates in the runs that rank 0 starts, without printing
/// or writing anything.
/// @return the exit code received from rank 0 at the end of the program
int run_worker_rank(const Catalogues& catalogues, const ProgramVersion& program);

/// The message that rank 0 broadcasts to start a run on the worker ranks. It contains program version, arguments,
/// options and study file. "" if there are no worker ranks.
std::string run_message(const StudyContents& contents, const RunOptions& options);

/// Ends the worker ranks (all MPI ranks other than 0). Rank 0 calls it at the end of the program.
void stop_worker_ranks(int exit_code);

}  // namespace pkm
