// A stage of a program for many values of its input side by side: a row.
#pragma once

#include <new>
#include <span>
#include <vector>

#include "engine/core/instruction_set.hpp"
#include "engine/graph/program.hpp"

namespace pkm::graph {

inline constexpr std::size_t kRow = 64;  ///< values of a row, whole lanes

/// Begins what it allocates with a cache line, which lanes then do not straddle: a quarter of a survey's time.
template <class T>
struct CacheLines {
  using value_type = T;
  static constexpr std::align_val_t kLine{64};

  CacheLines() = default;
  template <class U>
  explicit CacheLines(const CacheLines<U>&) {}
  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kLine)); }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory, kLine); }
  bool operator==(const CacheLines&) const = default;
};
using Rows = std::vector<double, CacheLines<double>>;

/// An operand: a row of this stage, or one number of the stages before.
struct Operand {
  std::uint32_t index = 0;  ///< of its slot, or of its register
  bool row = false;
};

/// Nothing but numbers, so that kernels share no code with files that are compiled for another instruction set.
struct RowStep {
  Code code;
  Rule<double> rule;
  std::uint8_t count;
  std::uint32_t to;  ///< slot
  Operand from[kMostArguments];
};

/// Runs steps over `count` values, whole lanes. Slot k is rows[k kRow], ...
template <InstructionSet set>
void run_rows(std::span<const RowStep> steps, const double* registers, double* rows, std::size_t count);

/// Immutable. Slots are used again as soon as nothing reads them, so that rows stay near the processor.
class RowStage {
 public:
  /// @param kept  registers whose rows are read after the stage, or by those behind it
  RowStage(const Program& program, std::size_t stage, std::span<const std::uint32_t> kept);

  std::size_t slots() const { return slots_; }
  /// Where the row of a kept register or of an input is; a number of an earlier stage is none.
  Operand operand(std::uint32_t program_register) const { return operands_[program_register]; }
  /// Slots of the stage's inputs, to be filled in before.
  const std::vector<std::uint32_t>& inputs() const { return inputs_; }

  void run(const double* registers, double* rows, std::size_t count) const;

 private:
  std::vector<RowStep> steps_;
  std::vector<Operand> operands_;  ///< by register
  std::vector<std::uint32_t> inputs_;
  std::size_t slots_ = 0;
};

}  // namespace pkm::graph
