// Checks, for all studies of the experiments, that evaluating a design does not allocate memory once the scratch memory
// has grown to its final size. Replaces operator new to count allocations.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>
#include <set>

#include "constraints/all.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/config/study.hpp"
#include "engine/math/random.hpp"
#include "engine/optimisers/optimiser.hpp"
#include "objectives/all.hpp"

namespace {

std::atomic<std::int64_t> allocations = 0;

void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  const std::size_t whole = (std::max<std::size_t>(size, 1) + alignment - 1) / alignment * alignment;
  if (void* memory = std::aligned_alloc(alignment, whole)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return counted(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
// Not inlined: GCC would otherwise warn that memory from operator new is released by free().
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { operator delete(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { operator delete(memory); }

namespace pkm {
namespace {

/// Studies whose evaluations do not allocate. Drive forces and pose reports of the generic engine do, and so do
/// motions, obstacles, discontinuities of columns, which limits of quantities can cause, the search for the component
/// of a home pose, and statistics over built machines.
std::vector<std::string> experiments() {
  const std::set<std::string> excluded = {"motions", "mechanisms", "motors", "obstacles", "quantities", "connectivity",
                                          "tasks",   "tolerances", "cables", "frames",    "chains"};  // folders
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(PKM_EXPERIMENTS)) {
    if (entry.path().extension() != ".toml" || excluded.contains(entry.path().parent_path().filename().string()))
      continue;
    std::ifstream file(entry.path());
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    if (text.find("type = \"peak-") == std::string::npos) paths.push_back(entry.path());
  }
  std::ranges::sort(paths);
  return paths;
}

class Allocations : public testing::TestWithParam<std::string> {};

TEST_P(Allocations, NoneInAnEvaluation) {
  const Catalogues all{all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()};
  const Study study = load_study_toml(GetParam(), all);
  const Problem& problem = *study.problem;
  constexpr std::size_t kDesigns = 10;
  EvaluationTable table(problem.shape());
  table.extend(kDesigns);
  for (std::size_t row = 0; row < kDesigns; ++row) {
    Stream stream(1, 0, static_cast<std::uint32_t>(row), Stream::Use::start);
    const auto design = table.design(row);
    for (std::size_t i = 0; i < design.size(); ++i) design[i] = problem.space().from_unit(i, stream.u01());
  }
  Scratch scratch;
  const auto evaluate_all = [&] {
    for (std::size_t row = 0; row < kDesigns; ++row)
      problem.evaluate(static_cast<const EvaluationTable&>(table).design(row), scratch, table.slot(row));
  };
  evaluate_all();
  const std::int64_t before = allocations;
  evaluate_all();
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(before, 0);  // the counter works
}

INSTANTIATE_TEST_SUITE_P(Experiments, Allocations, testing::ValuesIn(experiments()), [](const auto& experiment) {
  const std::filesystem::path path = experiment.param;
  std::string name = path.parent_path().filename().string() + "_" + path.stem().string();
  std::ranges::replace_if(
      name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
});

}  // namespace
}  // namespace pkm
