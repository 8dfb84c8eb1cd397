// Steps of a program over intervals, for those who choose the steps that they need.
#pragma once

#include "engine/graph/program.hpp"

namespace pkm::graph {

/// Runs the steps that have not been computed since `now`. @param since  by register: when it was
void run_steps(std::span<const Program::Step> steps, std::uint64_t now, std::span<std::uint64_t> since,
               std::span<Interval> registers);

}  // namespace pkm::graph
