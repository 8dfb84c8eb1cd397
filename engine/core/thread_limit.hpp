// Maximum number of threads that --threads and OMP_NUM_THREADS accept.
#pragma once

namespace pkm {

inline constexpr int kMaxThreads = 1024;

}  // namespace pkm
