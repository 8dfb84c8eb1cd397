// Comparison of two implementations by alternating measurements in one run.
//
// The speed of a machine changes over minutes, so that the ratio of two separate benchmarks is unreliable. Alternating
// measurements see the same machine: their ratio is accurate to about 1 %, although each time alone may not be.
#pragma once

#include <chrono>

#include <benchmark/benchmark.h>

namespace pkm::benchmarks {

template <class Work>
double seconds_of(const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Repeats the work ten times, like consecutive generations, between which the threads of a team do not sleep.
template <class Work>
auto repeat_10_times(const Work& work) {
  return [&work] {
    for (int i = 0; i < 10; ++i) work();
  };
}

/// Total times [s] of two implementations that were timed alternately.
struct PairedTimes {
  double first = 0, second = 0;
  double ratio() const { return first / second; }
};

/// Runs a benchmark's loop, whose iterations call both implementations once. Reports their times per call as counters.
template <class First, class Second>
PairedTimes time_alternately(benchmark::State& state, const char* first_name, const First& first,
                             const char* second_name, const Second& second) {
  PairedTimes times;
  for (auto _ : state) {
    times.first += seconds_of(first);
    times.second += seconds_of(second);
  }
  const auto rounds = static_cast<double>(state.iterations());
  state.counters[first_name] = times.first / rounds;
  state.counters[second_name] = times.second / rounds;
  return times;
}

}  // namespace pkm::benchmarks
