// Locates a critical value of an outer coordinate, bracketed by two slices of different type. At the critical value one
// feature degenerates: an arc, an interval or the distance of two endpoints shrinks to zero, linearly or like a square
// root. Its size is extrapolated to zero (secant method); bisection is the fallback.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "engine/generic/columns/endpoints.hpp"

namespace pkm::generic {

/// A feature of the boundary of a slice: a vertex of a planar slice or an endpoint of a column, with its position.
struct BoundaryFeature {
  std::uint64_t key;  ///< identifies the feature; slices of the same type have features with the same keys
  /// Constraint surface on which the feature lies. The distance of two features of one surface shrinks to zero like a
  /// square root.
  std::uint64_t of;
  double t, s = 0;  ///< coordinates of the feature in the slice: t, and in planar slices s
  /// false: the feature is a root of a constraint that does not bound the slice here, because other constraints are
  /// violated.
  bool bounds = true;
};
using BoundaryFeatures = std::vector<BoundaryFeature>;

class CriticalValueSolver {
 public:
  /// Discards all samples.
  /// @param features_persist  true: beyond the critical value, the two features that meet there still exist, but do not
  ///                          bound the slice
  void reset(bool features_persist);
  /// Adds a sample: the slice at a value `at` of the coordinate, below or above the critical value.
  /// @param type      type of the slice; 0: empty
  /// @param distance  distance(feature, other): distance of `feature` from the surfaces that intersect at `other`, a
  ///                  feature of the sample on the opposite side; infinity if it is zero or unknown
  template <class Distance>
  void add_sample(double at, bool is_upper, SliceType type, const BoundaryFeatures& features,
                  const Distance& distance) {
    if (!record(is_upper, type, features)) return;
    double size = distance_of_two();
    for (const BoundaryFeature& feature : changed_features_[is_upper])
      for (const BoundaryFeature& other : changed_features_[!is_upper])
        if (feature.bounds) size = nearer(size, distance(feature, other));
    if (size < kUnknown) add(sides_[is_upper], {at, size});
  }
  /// Adds a sample of a function of the coordinate that changes its sign at the critical value.
  /// @param size  value of the function
  void add_size(double at, bool is_upper, double size);
  /// Value of the coordinate in (low, high) at which the next sample should be taken.
  /// @param tolerance  accuracy required of the critical value, in the unit of the coordinate
  double next_sample(double low, double high, double tolerance);

 private:
  /// A sample: the size of the degenerating feature at a value `at` of the coordinate.
  struct Point {
    double at, size;
  };
  struct Side {
    SliceType type = 0;
    BoundaryFeatures features;
    bool is_known = false;
    std::array<Point, 3> points;  ///< last samples on one side of the critical value; `count` of them are in use
    int count = 0;
  };

  static constexpr double kUnknown = std::numeric_limits<double>::infinity();

  bool record(bool is_upper, SliceType type, const BoundaryFeatures& features);
  void compare();
  bool has_changed(const BoundaryFeature& feature) const;
  double distance_of_two();
  double nearer(double size, double other);
  void add(Side& side, Point point);
  std::optional<double> zero_between(double low, double high, bool is_upper);

  std::array<Side, 2> sides_;
  /// Keys of boundary features that occur in different numbers below and above the critical value.
  std::vector<std::uint64_t> changed_;
  /// Features with the keys in changed_, in the last sample below [0] and above [1] the critical value.
  std::array<BoundaryFeatures, 2> changed_features_;
  /// Keys, in ascending order, of the features that bound the slice in the last sample below [0] and above [1] the
  /// critical value.
  std::array<std::vector<std::uint64_t>, 2> keys_;
  bool features_persist_ = false, is_root_ = false, is_signed_ = false, is_upper_ = false;
  /// Extrapolated critical value of the previous call of next_sample(); std::nullopt if there is none.
  std::optional<double> last_;
  double offset_ = 0;  ///< distance of the next sample from the extrapolated critical value
  int extrapolations_ = 0;
};

}  // namespace pkm::generic
