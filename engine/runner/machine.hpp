// Provenance of a run as text for the study file: processor, system, threads, hosts and time.
#pragma once

#include <string>

namespace pkm {

/// Model name of the processor, for example "AMD EPYC".
std::string describe_processor();

/// Text such as "AMD EPYC, 2 cores, avx2, Linux 6.1.0 x86_64", where avx2 is the instruction set of the vectorised
/// kernels.
std::string describe_machine();

/// Text such as "2 threads" or "4 ranks x 16 threads".
/// @param threads        number of threads of this MPI rank
/// @param total_threads  number of threads of all ranks together
std::string describe_team(int threads, int total_threads);

/// Names of the hosts of all MPI ranks, for example "node1, node2".
std::string describe_hosts();

/// Current time in the form of ISO 8601 in UTC, for example "2026-01-31T12:00:00Z".
std::string utc_now();

}  // namespace pkm
