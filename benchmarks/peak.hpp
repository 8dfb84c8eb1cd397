// What this machine's floating-point units can do at most, measured.
#pragma once

namespace pkm::benchmarks {

/// Operations per second [1/s] of one thread doing nothing but fused multiply-adds of doubles, two operations each, on
/// the widest vectors that the processor has. Measured once, in some 20 ms.
double peak_flops();

/// Seconds that a division and a square root take, per number, on the same vectors. They occupy one unit of the
/// processor that does nothing else meanwhile, so however many of them a kernel needs, this is the least it takes.
struct SlowOperations {
  double division, root;
};
SlowOperations slow_operations();

}  // namespace pkm::benchmarks
