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

/// How much a register that a stage computes changes with the stage's inputs, which move as one.
/// @param by  overwritten: by register, how much it changes with what was computed before the stage
double slope_along(const Program& program, std::size_t stage, std::uint32_t of, std::span<const double> registers,
                   std::vector<double>& by);

}  // namespace pkm::graph
