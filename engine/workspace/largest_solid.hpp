// The largest box, cylinder or sphere in the workspace of a design. It is found on a voxel grid, then refined to the
// tolerance: a semi-infinite program, solved by exchange of the critical points of its boundary with sequential
// quadratic programming (R. Hettich, K. O. Kortanek, "Semi-infinite programming", SIAM Review 35, 1993; J. Nocedal,
// S. J. Wright, "Numerical Optimization", 2nd edition, chapter 18).
//
// The result is a local maximum near the best solid on the grid. As far as sampled, no margin is negative in it:
// margins are tested at samples of the whole solid and at the local minima that start from them.
#pragma once

#include <deque>
#include <mutex>

#include "engine/mechanism/abilities/bounds.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "engine/workspace/solid_margins.hpp"
#include "engine/workspace/solid_on_grid.hpp"

namespace pkm {

/// A point where the boundary of the solid touches that of the workspace.
struct Contact {
  std::string constraint;  ///< "limb1 reaches", or "box, x max": a face of the search box
  Pose<double> pose;
  /// Derivative of log(volume) with respect to the constraint's value; 0: the constraint is redundant at the contact.
  double multiplier = 0;
  std::size_t margin = 0;  ///< index of the constraint
  UnitPoint unit{};        ///< the contact as a point of the unit solid
};

struct LargestSolid {
  Solid solid;
  double volume = 0;  ///< volume of the solid; 0: no solid was found
  std::vector<Contact> contacts;
  /// Norm of the last step plus the largest violation of a constraint, relative to the size of the solid: accuracy of
  /// the dimensions.
  double residual = 0;
  /// If the solid must not contain singularities det(G) = 0: the factor by which det(G) is multiplied to obtain a
  /// margin; otherwise 0.
  double determinant = 0;
  std::size_t samples = 0;  ///< number of poses at which the constraints were tested in the final test
  bool is_regular = true;   ///< true: det(G) does not change its sign in the solid, as far as sampled, or is undefined
};

/// Finds the largest solid in the workspace of a design. Immutable and thread-safe.
class LargestSolidFinder {
 public:
  /// Throws std::invalid_argument with one sentence if the solid cannot be found in workspaces of this plan.
  /// @param mechanism   must outlive this object
  /// @param is_regular  the solid must not contain parallel singularities (det(G) = 0), where det(G) is defined
  /// @param reported    further margins that must be >= 0, beside those of the mechanism's limits
  LargestSolidFinder(const Mechanism& mechanism, const WorkspacePlan& plan, SolidSpec spec, bool is_regular,
                     std::vector<ReportMargin> reported = {});

  /// Finds the largest solid of a design. The results of the last few designs are cached.
  LargestSolid find(std::span<const double> parameters) const;
  /// The volume with derivatives by the envelope theorem, which requires unique multipliers. Constraints that are
  /// limits of quantities without a formula, det(G) and faces of a search box that depends on the design are
  /// differentiated by central differences.
  /// @param found  find() of the same parameters
  Dual4 volume(std::span<const Dual4> parameters, const LargestSolid& found) const;

  /// A solid of this kind as poses, one set for each combination of listed values of the fixed coordinates.
  std::vector<PoseSolid> pose_solids(std::span<const double> parameters, const Solid& solid) const;

  const SolidSpec& spec() const { return spec_; }
  const LimitSpec& limits() const { return plan_.limits; }
  bool is_regular() const { return is_regular_; }  ///< true: solids that contain parallel singularities are excluded
  const Sweep& sweep() const { return sweep_; }
  std::vector<std::string> dimension_names() const;

 private:
  std::vector<Pose<double>> orientations(std::span<const double> parameters) const;
  /// The margins that must be >= 0 in the solid, for one design.
  /// @param determinant  factor of det(G) in its margin; 0: det(G) is no constraint
  SolidMargins margins(std::span<const double> parameters, double determinant) const;
  /// Signs of det G at feasible poses; 0 where it is 0 or undefined.
  std::vector<std::int8_t> determinant_signs(std::span<const double> parameters, std::span<const Pose<double>> poses,
                                             const SolidMargins& margins) const;
  LargestSolid find(std::span<const double> parameters, const VoxelMap& map, bool is_regular) const;

  /// Cache of the solids that were found last, with their designs, because certificates and pages show designs that
  /// were just evaluated.
  struct Memory {
    std::mutex mutex;
    std::deque<std::pair<std::vector<double>, LargestSolid>> solids;
  };

  const Mechanism& mechanism_;
  WorkspacePlan plan_;  ///< the plan of the study, with its fixed coordinates, converted to a plan of voxels
  SolidSpec spec_;
  bool is_regular_;
  std::vector<ReportMargin> reported_;
  const Sweep& sweep_;
  std::unique_ptr<const VoxelEvaluator> voxels_;
  std::unique_ptr<const PoseSides> sides_;  ///< finds signs of det J; null: det G is computed
  SolidSamples coarse_samples_, samples_, dense_samples_;
  std::shared_ptr<Memory> memory_ = std::make_shared<Memory>();
};

}  // namespace pkm
