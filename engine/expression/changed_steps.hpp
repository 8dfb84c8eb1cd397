// Incremental interval evaluation of the steps of a program that depend on changed inputs.
#pragma once

#include "engine/expression/program.hpp"

namespace pkm::expression {

/// A set of at most 8 inputs, one bit each.
using InputSet = std::uint8_t;
/// The inputs that the registers of a program depend on, and when these inputs changed.
struct Dependence {
  std::span<const InputSet> sets;          ///< by register: the inputs that it depends on
  std::span<const std::uint64_t> changed;  ///< by set of inputs: the last version in which one of them changed
};

/// Runs those steps that depend on inputs that have changed since they ran.
/// @param version   number of the inputs' version
/// @param computed  by register: version of the inputs for which the register was computed last; updated
void run_changed_steps(std::span<const Program::Step> steps, std::uint64_t version, const Dependence& dependence,
                       std::span<std::uint64_t> computed, std::span<Interval> registers);

}  // namespace pkm::expression
