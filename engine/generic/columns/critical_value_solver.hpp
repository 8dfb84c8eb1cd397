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
  std::uint64_t key;   ///< identical in all slices of one type
  std::uint64_t of;    ///< constraint surface; the distance of two features of a surface vanishes like a square root
  double t, s = 0;     ///< position; s: in planar slices only
  bool bounds = true;  ///< false: a redundant root, not part of the boundary
};
using BoundaryFeatures = std::vector<BoundaryFeature>;

class CriticalValueSolver {
 public:
  /// Discards all samples. @param features_persist  the merging features exist beyond the critical value as redundant
  /// roots
  void reset(bool features_persist);
  /// Adds a sample below or above the critical value.
  /// @param type      type of the slice; 0: empty
  /// @param distance  distance(feature, other): distance of a feature from the surfaces through `other`, on the other
  ///                  side; infinity if it is zero or unknown
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
  /// Adds a sample of a function that changes its sign at the critical value.
  void add_size(double at, bool is_upper, double size);
  /// Abscissa in (low, high) of the next sample.
  /// @param tolerance  absolute accuracy required of the critical value
  double next_sample(double low, double high, double tolerance);

 private:
  /// A sample: size of the degenerating feature at a value of the coordinate.
  struct Point {
    double at, size;
  };
  struct Side {
    SliceType type = 0;
    BoundaryFeatures features;
    bool is_known = false;
    std::array<Point, 3> points;  ///< the last samples
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
  std::vector<std::uint64_t> changed_;                ///< keys whose numbers of occurrences differ between the sides
  std::array<BoundaryFeatures, 2> changed_features_;  ///< features of the sides with such keys
  std::array<std::vector<std::uint64_t>, 2> keys_;    ///< keys of the sides, in order
  bool features_persist_ = false, is_root_ = false, is_signed_ = false, is_upper_ = false;
  std::optional<double> last_;  ///< previous extrapolation
  double offset_ = 0;           ///< width of the bracket around it
  int extrapolations_ = 0;
};

}  // namespace pkm::generic
