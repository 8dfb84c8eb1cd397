// How many threads may be asked for, by --threads and by OMP_NUM_THREADS.
#pragma once

namespace pkm {

inline constexpr int kMostThreads = 1024;

}  // namespace pkm
