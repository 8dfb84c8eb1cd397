// Incremental interval evaluation of selected steps of a program, for callers that need few of its outputs at a time.
#pragma once

#include "engine/expression/program.hpp"

namespace pkm::expression {

/// Runs those steps whose results are not up to date.
/// @param version   number of the inputs' version, increased by the caller whenever the inputs change
/// @param computed  by register: version of the inputs for which the register was computed last; updated
void run_steps(std::span<const Program::Step> steps, std::uint64_t version, std::span<std::uint64_t> computed,
               std::span<Interval> registers);

}  // namespace pkm::expression
