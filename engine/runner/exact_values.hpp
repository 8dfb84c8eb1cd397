// Evaluates designs of a voxel study by the exact method (columns), if the mechanism supports it.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/unsupported.hpp"
#include "engine/problem/design_problem.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

class ExactValues {
 public:
  static constexpr const char* kNoValues = "no exact values of the ";  ///< beginning of the notes of evaluate()

  /// @param parts  problem of the voxel study; must outlive this object
  explicit ExactValues(const ProblemParts& parts);

  /// Evaluates one design. std::nullopt if there are no exact values.
  /// @param name   name of the design in notes
  /// @param notes  receives the reason if there are no exact values, but only if the mechanism supports the exact
  /// method
  std::optional<DesignRecord> evaluate(const char* name, std::span<const double> parameters,
                                       std::vector<std::string>& notes) const;

 private:
  /// Checks whether the box of the study contains all reachable poses. If it does not, columns may extend beyond the
  /// box.
  /// @return the ranges of the reachable poses as text if they exceed the box; empty if they do not, or if columns are
  /// restricted to the box
  Unsupported poses_beyond_box(std::span<const double> parameters) const;
  /// Sets values to NaN that depend on a region evaluated on voxels, because these values are not exact.
  void discard_voxel_values(const std::vector<NamedQuantity>& quantities, std::vector<double>& values) const;

  const ProblemParts& parts_;
  std::unique_ptr<const DesignProblem> problem_;
};

}  // namespace pkm
