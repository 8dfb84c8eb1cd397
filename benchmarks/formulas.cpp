// Cost of an expression: parsing, evaluation and gradient.
#include <benchmark/benchmark.h>

#include "engine/expression/formula.hpp"
#include "engine/math/dual.hpp"

namespace pkm::benchmarks {
namespace {

const std::vector<std::string> kNames = {"volume", "b", "l_u", "l_d"};
const char* const kText = "volume / (pi * b * (l_u + l_d))";

template <class S>
void value(benchmark::State& state) {
  const Formula formula(kText, kNames);
  std::vector<S> values;
  for (const double x : {0.55, 0.8, 0.6, 0.55}) values.push_back(S(x));
  if constexpr (!std::is_same_v<S, double>)
    for (int i = 0; i < 4; ++i) values[static_cast<std::size_t>(i)].v[i] = 1;
  std::vector<S> stack;
  for (auto _ : state) {
    S found = formula.value(std::span<const S>(values), stack);
    benchmark::DoNotOptimize(found);
  }
}
BENCHMARK(value<double>)->Name("formula/value");
BENCHMARK(value<Dual4>)->Name("formula/value_and_gradient");

void read(benchmark::State& state) {
  for (auto _ : state) {
    Formula formula(kText, kNames);
    benchmark::DoNotOptimize(formula);
  }
}
BENCHMARK(read)->Name("formula/read")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pkm::benchmarks
