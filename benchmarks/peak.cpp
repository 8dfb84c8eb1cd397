#include "benchmarks/peak.hpp"

#include <algorithm>

#include <benchmark/benchmark.h>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "benchmarks/timing.hpp"
#include "engine/core/instruction_set.hpp"

namespace pkm::benchmarks {
namespace {

constexpr int kRounds = 200000, kChains = 16;  // as many sums side by side as hide the latency of each

#if defined(__x86_64__)
[[gnu::target("avx512f")]] void multiply_add_512() {
  __m512d sum[kChains], factor = _mm512_set1_pd(0.5);
  for (__m512d& s : sum) s = factor;
  for (int i = 0; i < kRounds; ++i)
#pragma GCC unroll 16
    for (int k = 0; k < kChains; ++k) sum[k] = _mm512_fmadd_pd(sum[k], factor, factor);
  for (const __m512d& s : sum) benchmark::DoNotOptimize(s[0] + s[1] + s[2] + s[3] + s[4] + s[5] + s[6] + s[7]);
}
[[gnu::target("avx2,fma")]] void multiply_add_256() {
  __m256d sum[kChains / 2], factor = _mm256_set1_pd(0.5);
  for (__m256d& s : sum) s = factor;
  for (int i = 0; i < 2 * kRounds; ++i)
#pragma GCC unroll 16
    for (int k = 0; k < kChains / 2; ++k) sum[k] = _mm256_fmadd_pd(sum[k], factor, factor);
  for (const __m256d& s : sum) benchmark::DoNotOptimize(s[0] + s[1] + s[2] + s[3]);
}
#endif
void multiply_add_plainly() {
  double sum[kChains];
  for (double& s : sum) s = 0.5;
  for (int i = 0; i < kRounds; ++i)
    for (int k = 0; k < kChains; ++k) sum[k] = sum[k] * 0.5 + 0.5;
  for (double& s : sum) benchmark::DoNotOptimize(s);
}

}  // namespace

double peak_flops() {
  static const double peak = [] {
    void (*work)() = multiply_add_plainly;
    double lanes = 1;
#if defined(__x86_64__)
    if (widest_instruction_set() == InstructionSet::avx512) {
      work = multiply_add_512;
      lanes = 8;
    } else if (__builtin_cpu_supports("fma") && widest_instruction_set() == InstructionSet::avx2) {
      work = multiply_add_256;
      lanes = 4;
    }
#endif
    double best = 1e9;
    for (int i = 0; i < 10; ++i) best = std::min(best, seconds_of(work));
    return 2.0 * kRounds * kChains * lanes / best;
  }();
  return peak;
}

void report_peak(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(peak_flops());
  state.counters["GFLOP_per_s"] = peak_flops() * 1e-9;
}
BENCHMARK(report_peak)->Name("peak/fused_multiply_add");

}  // namespace pkm::benchmarks
