// Where and when a study runs, as text for its file.
#pragma once

#include <string>

namespace pkm {

/// "AMD EPYC"
std::string describe_processor();

/// "AMD EPYC, 2 cores, avx2, Linux 6.1.0 x86_64"; avx2 is the instruction set that kernels use.
std::string describe_machine();

/// Now, ISO 8601 in UTC: "2026-01-31T12:00:00Z".
std::string utc_now();

}  // namespace pkm
