// Reverse-mode automatic differentiation of programs: derivatives of an output with respect to all inputs, in one
// backward sweep.
//
// The adjoint of a register is the derivative of the output with respect to that register. Starting from the adjoint 1
// of the output, the steps are visited in reverse order, and each adds its adjoint times its partial derivatives to the
// adjoints of its arguments.
//
// Reference: Griewank, Walther, "Evaluating Derivatives", 2nd ed., SIAM 2008, section 3.2.
#pragma once

#include "engine/expression/program.hpp"

namespace pkm::expression {

/// Backward sweep through one stage: propagates the adjoints of the registers that the stage computes to the adjoints
/// of its inputs and of the registers of earlier stages. The propagated adjoints are then set to 0. Contributions that
/// are not finite are dropped.
/// @param registers  values after the stage was run
/// @param adjoints   adjoint of each register; contributions are added
void backward_sweep(const Program& program, std::size_t stage, std::span<const double> registers,
                    std::span<double> adjoints);

/// Partial derivatives of an operation with respect to its arguments.
/// @param rule   the rule of the operation for dual numbers
/// @param x      values of the arguments
/// @param count  their number, at most kMaxArguments
std::array<double, kMaxArguments> partial_derivatives(Rule<Dual4> rule, const double* x, std::size_t count);

/// The derivative of the register `of`, which a stage computes, with respect to the input of this stage; for several
/// inputs, the sum of the partial derivatives.
/// @param by  receives the derivatives of `of` with respect to the registers of the earlier stages, indexed by
///            register; overwritten
double stage_derivative(const Program& program, std::size_t stage, std::uint32_t of, std::span<const double> registers,
                        std::vector<double>& by);

}  // namespace pkm::expression
