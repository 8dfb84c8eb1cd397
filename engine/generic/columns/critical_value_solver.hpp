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
  std::uint64_t key;  ///< identifies the feature; the same in all slices of one type
  /// Constraint surface on which it lies; the distance of two features of one surface vanishes like a square root.
  std::uint64_t of;
  double t, s = 0;     ///< coordinates of the feature in the slice: t, and in planar slices s
  bool bounds = true;  ///< false: a root of a constraint that is redundant here, so that it does not bound the slice
};
using BoundaryFeatures = std::vector<BoundaryFeature>;

class CriticalValueSolver {
 public:
  /// Discards all samples.
  /// @param features_persist  true: beyond the critical value the merging features still exist, as redundant roots
  void reset(bool features_persist);
  /// Adds a sample below or above the critical value.
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
  /// Adds a sample of a function of the coordinate that has its sign change at the critical value.
  void add_size(double at, bool is_upper, double size);
  /// Abscissa in (low, high) of the next sample.
  /// @param tolerance  absolute accuracy required of the critical value
  double next_sample(double low, double high, double tolerance);

 private:
  /// A sample of the size of the degenerating feature, at a value of the coordinate.
  struct Point {
    double at, size;
  };
  struct Side {
    SliceType type = 0;
    BoundaryFeatures features;
    bool is_known = false;
    std::array<Point, 3> points;  ///< the last samples on this side, of which the first `count` are in use
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
  std::vector<std::uint64_t> changed_;  ///< keys that occur in different numbers below and above the critical value
  /// Features with these keys, below [0] and above [1] the critical value.
  std::array<BoundaryFeatures, 2> changed_features_;
  /// Keys of the features that bound the slice, below [0] and above [1], sorted.
  std::array<std::vector<std::uint64_t>, 2> keys_;
  bool features_persist_ = false, is_root_ = false, is_signed_ = false, is_upper_ = false;
  std::optional<double> last_;  ///< previous extrapolated critical value; std::nullopt if there is none
  double offset_ = 0;           ///< distance of the next sample from the extrapolated critical value
  int extrapolations_ = 0;
};

}  // namespace pkm::generic
