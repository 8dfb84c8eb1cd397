// What a voxel study says of its designs on exact columns, where the mechanism has them and they know it.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/refusal.hpp"
#include "engine/problem/design_problem.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

class ExactValues {
 public:
  static constexpr const char* kNone = "no exact values of the ";  ///< how notes of of() begin

  /// @param parts  of the voxel study's problem; have to outlive this
  explicit ExactValues(const ProblemParts& parts);

  /// @param name  of the design in the note that says why there are none
  std::optional<DesignRecord> of(const char* name, std::span<const double> parameters,
                                 std::vector<std::string>& notes) const;

 private:
  /// Which poses a design may reach, where the box may leave some of them out that columns count.
  Refusal poses_beyond_box(std::span<const double> parameters) const;
  /// Regions keep their own surveys: what is read from one on voxels is not exact.
  void forget_voxels(const std::vector<NamedQuantity>& quantities, std::vector<double>& values) const;

  const ProblemParts& parts_;
  std::unique_ptr<const DesignProblem> problem_;
};

}  // namespace pkm
