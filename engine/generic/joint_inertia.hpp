// The inertia that joints feel, and coupling indices, of many poses side by side.
#pragma once

#include <cstddef>

#include "engine/expression/batch_stage.hpp"

namespace pkm::generic {

/// Poses whose J and M_X are rows. Nothing but numbers, so that kernels share no code with files that are compiled for
/// another instruction set.
struct InertiaRow {
  const expression::Operand *J, *M_X;  ///< n x n, by rows
  const double *registers, *rows;
  std::size_t n, count;  ///< poses: whole lanes
  const double* rotors;  ///< n numbers, added to the diagonal of M_q
  double* M_q;           ///< n x n rows of expression::kRow
  double* indices;       ///< n rows
  double* found;         ///< 1 where they are found; 0: one by one (nearly singular, infinite)
};

/// The same bits as those of joint_inertia() and coupling_indices() of each pose.
template <InstructionSet set>
void find_joint_inertia(const InertiaRow& row);

}  // namespace pkm::generic
