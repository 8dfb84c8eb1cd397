// (3CRR/R)&CRU and Quadrupteron: settings shared by the workspace analyses by columns and by voxels, and their
// evaluators.
#pragma once

#include <memory>

#include "engine/accelerators/crr_cru/masses.hpp"
#include "engine/accelerators/crr_cru/yaw.hpp"
#include "engine/mechanism/workspace_evaluator.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm::crr_cru {

struct AnalysisSettings {
  Platform platform;
  MassModel mass_model;
  WorkingMode mode;  ///< working mode with which the inertia is computed; feasibility does not depend on it
  FixedCoordinate fixed;
  Limits limits;
  FieldRequest request;
  bool with_conditioning = request.has(kConditioning);

  template <class S>
  Masses<S> masses(std::span<const S> parameters) const {
    Masses<S> all = crr_cru::masses(mass_model, parameters);
    std::ranges::copy(request.rotors, all.rotors.begin());
    return all;
  }
  /// The conditioning at the yaw angle phi; it does not depend on the position of the platform.
  template <class S>
  S conditioning_at(const Geometry<S>& g, const S& phi) const {
    const auto [s, c] = sincos(phi);
    const S length = request.characteristic_length ? S(*request.characteristic_length) : characteristic_length(g);
    return conditioning(arms(g, s, c), length);
  }
  /// Adds one sample of the conditioning, with the given weight, that represents all feasible positions at the yaw
  /// angle phi.
  template <class S>
  void add_conditioning(const Geometry<S>& g, const S& phi, const S& weight, WorkspaceResult<S>& workspace) const {
    if (!(value_of(weight) > 0)) return;
    workspace.weight.push_back(weight);
    workspace.find(kConditioning)->push_back(conditioning_at(g, phi));
  }
};

std::unique_ptr<const WorkspaceEvaluator> make_evaluator(const AnalysisSettings& settings,
                                                         const ColumnOptions& columns);
std::unique_ptr<const VoxelEvaluator> make_evaluator(const AnalysisSettings& settings, const VoxelOptions& voxels);

}  // namespace pkm::crr_cru
