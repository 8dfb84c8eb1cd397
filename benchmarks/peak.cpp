#include "benchmarks/peak.hpp"

#include <algorithm>
#include <cmath>

#include <benchmark/benchmark.h>
#if defined(__x86_64__)
#if !defined(__clang__)
#pragma GCC diagnostic ignored "-Wuninitialized"  // false alarm of GCC 12 in its own header (its bug 105593)
#endif
#include <immintrin.h>
#endif

#include "benchmarks/timing.hpp"
#include "engine/core/instruction_set.hpp"

namespace pkm::benchmarks {
namespace {

constexpr int kRounds = 200000, kChains = 16;  // independent chains, enough to hide the latency of an operation

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

// Throughput of divisions and square roots, on independent chains of vectors.
[[gnu::target("avx512f")]] void divide_512() {
  __m512d x[kChains], by = _mm512_set1_pd(1.0001);
  for (__m512d& each : x) each = by;
  for (int i = 0; i < kRounds / 16; ++i)
#pragma GCC unroll 16
    for (int k = 0; k < kChains; ++k) x[k] = _mm512_div_pd(x[k], by);
  for (const __m512d& each : x) benchmark::DoNotOptimize(each[0]);
}
[[gnu::target("avx512f")]] void root_512() {
  __m512d x[kChains];
  for (__m512d& each : x) each = _mm512_set1_pd(1.0001);
  for (int i = 0; i < kRounds / 16; ++i)
#pragma GCC unroll 16
    for (int k = 0; k < kChains; ++k) x[k] = _mm512_sqrt_pd(x[k]);
  for (const __m512d& each : x) benchmark::DoNotOptimize(each[0]);
}
[[gnu::target("avx2")]] void divide_256() {
  __m256d x[kChains], by = _mm256_set1_pd(1.0001);
  for (__m256d& each : x) each = by;
  for (int i = 0; i < kRounds / 16; ++i)
#pragma GCC unroll 16
    for (int k = 0; k < kChains; ++k) x[k] = _mm256_div_pd(x[k], by);
  for (const __m256d& each : x) benchmark::DoNotOptimize(each[0]);
}
[[gnu::target("avx2")]] void root_256() {
  __m256d x[kChains];
  for (__m256d& each : x) each = _mm256_set1_pd(1.0001);
  for (int i = 0; i < kRounds / 16; ++i)
#pragma GCC unroll 16
    for (int k = 0; k < kChains; ++k) x[k] = _mm256_sqrt_pd(x[k]);
  for (const __m256d& each : x) benchmark::DoNotOptimize(each[0]);
}
#endif
void multiply_add_scalar() {
  double sum[kChains];
  for (double& s : sum) s = 0.5;
  for (int i = 0; i < kRounds; ++i)
    for (int k = 0; k < kChains; ++k) sum[k] = sum[k] * 0.5 + 0.5;
  for (double& s : sum) benchmark::DoNotOptimize(s);
}

void divide_scalar() {
  double x[kChains], by = 1.0001;
  benchmark::DoNotOptimize(by);
  for (double& each : x) each = by;
  for (int i = 0; i < kRounds / 16; ++i)
    for (double& each : x) each = each / by;
  for (double& each : x) benchmark::DoNotOptimize(each);
}
void root_scalar() {
  double x[kChains];
  for (double& each : x) each = 1.0001;
  for (int i = 0; i < kRounds / 16; ++i)
    for (double& each : x) each = std::sqrt(each);
  for (double& each : x) benchmark::DoNotOptimize(each);
}

double min_time(void (*work)()) {
  double best = 1e9;
  for (int i = 0; i < 10; ++i) best = std::min(best, seconds_of(work));
  return best;
}

}  // namespace

double peak_flops() {
  static const double peak = [] {
    void (*work)() = multiply_add_scalar;
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
    return 2.0 * kRounds * kChains * lanes / min_time(work);
  }();
  return peak;
}

DivisionAndRootTimes division_and_root_times() {
  static const DivisionAndRootTimes slow = [] {
    void (*divide)() = divide_scalar;
    void (*root)() = root_scalar;
    double lanes = 1;
#if defined(__x86_64__)
    if (widest_instruction_set() == InstructionSet::avx512) {
      divide = divide_512;
      root = root_512;
      lanes = 8;
    } else if (widest_instruction_set() == InstructionSet::avx2) {
      divide = divide_256;
      root = root_256;
      lanes = 4;
    }
#endif
    const double numbers = kRounds / 16 * kChains * lanes;
    return DivisionAndRootTimes{min_time(divide) / numbers, min_time(root) / numbers};
  }();
  return slow;
}

void report_peak(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(peak_flops());
  state.counters["GFLOP_per_s"] = peak_flops() * 1e-9;
  state.counters["division_ns"] = division_and_root_times().division * 1e9;
  state.counters["root_ns"] = division_and_root_times().root * 1e9;
}
BENCHMARK(report_peak)->Name("peak/fused_multiply_add");

}  // namespace pkm::benchmarks
