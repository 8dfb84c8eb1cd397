// What this machine's floating-point units can do at most, measured.
#pragma once

namespace pkm::benchmarks {

/// Operations per second [1/s] of one thread doing nothing but fused multiply-adds of doubles, two operations each, on
/// the widest vectors that the processor has. Measured once, in some 20 ms.
double peak_flops();

}  // namespace pkm::benchmarks
