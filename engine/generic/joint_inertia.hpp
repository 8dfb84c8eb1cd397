// SIMD evaluation of the joint-space inertia matrix and of the coupling indices, for a batch of poses.
#pragma once

#include <cstddef>

#include "engine/expression/batch_stage.hpp"

namespace pkm::generic {

/// Arguments and results of find_joint_inertia(). A plain struct, so that kernels share no inline functions with files
/// that are compiled for another instruction set.
struct InertiaKernelData {
  const expression::Operand *J, *M_X;  ///< operands of the elements of J and M_X: n x n, row-major
  const double *registers, *rows;      ///< values of the operands: single numbers, and rows with one number per pose
  std::size_t n, count;                ///< number of joints; number of poses in the batch, a multiple of kLanes
  const double* rotors;                ///< n numbers that are added to the diagonal of M_q, by joint
  double* M_q;                         ///< receives M_q: n x n rows of expression::kRow numbers, one number per pose
  double* indices;                     ///< receives the coupling indices: n rows, one number per pose
  /// Receives for each pose 1 if its results are valid; 0 if the pose must be evaluated alone in scalar arithmetic,
  /// because it is nearly singular or a value is infinite.
  double* found;
};

/// Computes M_q and the coupling indices of all poses. The results have the same bits as those of joint_inertia() and
/// coupling_indices() for each pose.
template <InstructionSet set>
void find_joint_inertia(const InertiaKernelData& data);

}  // namespace pkm::generic
