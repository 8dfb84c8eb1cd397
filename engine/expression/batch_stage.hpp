// Vectorised (SIMD) evaluation and differentiation of one stage of a program, for a batch of up to kRow input values.
//
// The innermost loop of a workspace analysis evaluates the same steps for many values of one coordinate. Here, every
// step is carried out for the whole batch before the next step follows (structure of arrays): a register of the stage
// becomes a row of kRow numbers, one per input value. Registers of earlier stages remain single numbers.
#pragma once

#include <new>
#include <span>
#include <vector>

#include "engine/core/instruction_set.hpp"
#include "engine/expression/program.hpp"

namespace pkm::expression {

inline constexpr std::size_t kRow = 64;  ///< batch size: count of numbers in a row, a multiple of kLanes

/// Allocator that aligns to cache lines, so that no SIMD load or store crosses a line boundary: this saves a quarter of
/// the time of a workspace analysis.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  static constexpr std::align_val_t kLine{64};

  CacheLineAllocator() = default;
  template <class U>
  explicit CacheLineAllocator(const CacheLineAllocator<U>&) {}
  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kLine)); }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory, kLine); }
  bool operator==(const CacheLineAllocator&) const = default;
};
using Rows = std::vector<double, CacheLineAllocator<double>>;

/// An operand of a step: a row of this stage, or a single number of an earlier stage.
struct Operand {
  std::uint32_t index = 0;  ///< if `row` is true: number of the row's slot in `rows`; otherwise number of a register
  bool row = false;         ///< true: a row with one number per input value; false: a single number
};

/// A step that solves a system of equations.
struct BatchSolve {
  std::shared_ptr<const ImplicitSystem> system;
  std::vector<Operand> from;
  std::vector<std::uint32_t> to;  ///< slots of the rows that receive the status and the unknowns
};
/// Solves the system for each of `count` values, one after the other.
void solve_batch(const BatchSolve& step, const double* registers, double* rows, std::size_t count);

/// A step of the stage. A plain struct, so that the kernels, which are compiled once per instruction set, share no
/// inline functions with other files.
struct BatchStep {
  Code code;
  Rule<double> rule;
  Rule<Dual4> derivatives;
  std::uint8_t count;
  std::uint32_t to;  ///< slot of the row that receives the result
  Operand from[kMaxArguments];
  const BatchSolve* solve = nullptr;  ///< set if code is Code::solve
};

/// Runs steps for the first `count` values of each row.
/// @param count  a multiple of kLanes, at most kRow
/// @param rows   slot k is rows[k * kRow], ..., rows[k * kRow + kRow - 1]
template <InstructionSet set>
void run_batch(std::span<const BatchStep> steps, const double* registers, double* rows, std::size_t count);

/// Adjoints of the values of a batch: of each number in a row, and of each register of the earlier stages.
struct BatchAdjoints {
  double *rows, *registers;
};

/// Propagates adjoints backwards through steps, see BatchStage::backward_sweep().
template <InstructionSet set>
void sweep_batch(std::span<const BatchStep> steps, const double* registers, const double* rows, std::size_t count,
                 const BatchAdjoints& adjoints);
/// The same for one step whose operation has no dedicated implementation, by dual numbers.
void sweep_other(const BatchStep& step, const double* registers, const double* rows, std::size_t count,
                 const BatchAdjoints& adjoints);

/// A stage prepared for batches; immutable. Rows are assigned to slots by their lifetime: a slot is reused after the
/// last step that reads its row, so that few slots are needed and they stay in the cache.
class BatchStage {
 public:
  /// @param retained  registers of the stage that the caller or a later stage reads; their slots are not reused
  BatchStage(const Program& program, std::size_t stage, std::span<const std::uint32_t> retained);

  std::size_t slots() const { return slots_; }
  /// Location of the value of a register: a row with one value per pose if it is an input or a retained register of
  /// this stage, a single number if an earlier stage has computed it.
  Operand operand(std::uint32_t program_register) const { return operands_[program_register]; }
  /// Slots of the stage's inputs, which the caller fills before run().
  const std::vector<std::uint32_t>& inputs() const { return inputs_; }

  /// Runs the stage for the first `count` values of each row.
  /// @param registers  values of the registers of the earlier stages
  /// @param rows       slot k is rows[k * kRow], ..., rows[k * kRow + kRow - 1]
  /// @param count      a multiple of kLanes, at most kRow
  void run(const double* registers, double* rows, std::size_t count) const;

  /// Backward sweep (reverse_mode.hpp) after run(): propagates the adjoints of the rows to those of the inputs' rows,
  /// and to those of registers of earlier stages, as the sum over all values. The propagated adjoints are then set to
  /// 0. Contributions that are not finite are dropped. All registers of the stage must have been retained, and no step
  /// may solve a system.
  /// @param adjoints  adjoints of the first `count` values of each row, and of each register
  void backward_sweep(const double* registers, const double* rows, std::size_t count,
                      const BatchAdjoints& adjoints) const;

 private:
  std::vector<BatchStep> steps_;
  std::vector<std::shared_ptr<const BatchSolve>> systems_;  ///< systems that the steps solve
  std::vector<Operand> operands_;                           ///< location of each register of the program, by register
  std::vector<std::uint32_t> inputs_;
  std::size_t slots_ = 0;
};

}  // namespace pkm::expression
