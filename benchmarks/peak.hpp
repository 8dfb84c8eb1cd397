// Measured peak performance of the processor's floating-point units.
#pragma once

namespace pkm::benchmarks {

/// Peak performance of one thread [1/s]: fused multiply-adds of doubles, two operations each, with the widest vector
/// instructions of the processor. Measured once, in about 20 ms.
double peak_flops();

/// Times of a division and a square root [s], per number, with the same vector instructions. Both occupy the same unit
/// of the processor, so that a kernel takes at least the sum of these times.
struct DivisionAndRootTimes {
  double division, root;
};
DivisionAndRootTimes division_and_root_times();

}  // namespace pkm::benchmarks
