// Where, when and by whom a study is run, as text for its file.
#pragma once

#include <string>

namespace pkm {

/// "AMD EPYC"
std::string describe_processor();

/// "AMD EPYC, 2 cores, avx2, Linux 6.1.0 x86_64"; avx2 is the instruction set that kernels use.
std::string describe_machine();

/// "2 threads", "4 ranks x 16 threads".
/// @param threads  of this rank
/// @param of_all  threads of all ranks
std::string describe_team(int threads, int of_all);

/// "node1, node2": where the ranks are.
std::string describe_hosts();

/// Now, ISO 8601 in UTC: "2026-01-31T12:00:00Z".
std::string utc_now();

}  // namespace pkm
