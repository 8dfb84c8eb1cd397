// One step of a program over intervals, for those who choose the steps that they need.
#pragma once

#include "engine/graph/program.hpp"

namespace pkm::graph {

void run_step(const Program::Step& step, std::span<Interval> registers);

}  // namespace pkm::graph
