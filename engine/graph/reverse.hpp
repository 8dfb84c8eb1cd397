// Derivatives of a program's outputs by all of its inputs at once: adjoints, which go through the steps backwards.
#pragma once

#include "engine/graph/program.hpp"

namespace pkm::graph {

/// Moves the adjoints of what a stage computes on to what it is computed from; those of the stage's steps become 0.
/// Where an operation has no finite slope, nothing is moved, as derivative scalars have it.
/// @param registers  as the stage left them
/// @param adjoints   by register; those of the stage's inputs are added to
void run_backwards(const Program& program, std::size_t stage, std::span<const double> registers,
                   std::span<double> adjoints);

}  // namespace pkm::graph
