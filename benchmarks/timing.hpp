// Two ways of doing the same thing, timed in turns within one run.
//
// Machines are noisy and change their speed over minutes, so a ratio of two benchmarks says little. Taking turns lets
// both ways see the same machine: their ratio is good to about one per cent although each time alone may not be.
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

/// The work ten times in a row, as generations follow one another: threads of a team stay awake in between.
template <class Work>
auto ten_times(const Work& work) {
  return [&work] {
    for (int i = 0; i < 10; ++i) work();
  };
}

/// Total times [s] of two ways that took turns.
struct Duel {
  double first = 0, second = 0;
  double ratio() const { return first / second; }
};

/// Runs a benchmark's loop; each iteration does both ways once. Reports the time of both per call as counters.
template <class First, class Second>
Duel take_turns(benchmark::State& state, const char* first_name, const First& first, const char* second_name,
                const Second& second) {
  Duel duel;
  for (auto _ : state) {
    duel.first += seconds_of(first);
    duel.second += seconds_of(second);
  }
  const auto rounds = static_cast<double>(state.iterations());
  state.counters[first_name] = duel.first / rounds;
  state.counters[second_name] = duel.second / rounds;
  return duel;
}

}  // namespace pkm::benchmarks
