// Where a structure changes along a coordinate, guessed from what vanishes there: an arc between two corners, a part
// between two breaks, the distance of two ends. Its size falls to 0 in proportion to the distance from the change, or
// to the root of that.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "engine/generic/columns/ends.hpp"

namespace pkm::generic {

/// Something that bounds the feasible set, and where it is.
struct Mark {
  std::uint64_t key;   ///< the same where the structure is
  std::uint64_t of;    ///< two of the same, if they have the same key, meet like a root
  double t, s = 0;     ///< s: of sections alone
  bool bounds = true;  ///< else it is there, but no part of the structure
};
using Marks = std::vector<Mark>;

class ChangeGuess {
 public:
  /// Begins anew. @param go_on  what meets in the change goes on beyond it, as no part of the structure
  void start(bool go_on);
  /// What is there at a place, on the lower or the upper side of the change.
  /// @param structure  0: nothing
  /// @param distance   (mark, other): how far a mark here is from what a mark of the other side lies on; infinity: it
  ///                   lies there, or nobody knows
  template <class Distance>
  void see(double at, bool is_upper, Structure structure, const Marks& marks, const Distance& distance) {
    if (!take(is_upper, structure, marks)) return;
    double size = distance_of_two();
    for (const Mark& mark : changed_marks_[is_upper])
      for (const Mark& other : changed_marks_[!is_upper])
        if (mark.bounds) size = nearer(size, distance(mark, other));
    if (size < kUnknown) add(sides_[is_upper], {at, size});
  }
  /// What has one sign on the lower side and the other on the upper one.
  void see_size(double at, bool is_upper, double size);
  /// A place between two, where to look next. @param near  how well the change is to be known
  double next(double low, double high, double near);

 private:
  struct Point {
    double at, size;
  };
  struct Side {
    Structure structure = 0;
    Marks marks;
    bool is_known = false;
    std::array<Point, 3> points;  ///< the last ones
    int count = 0;
  };

  static constexpr double kUnknown = std::numeric_limits<double>::infinity();

  bool take(bool is_upper, Structure structure, const Marks& marks);
  void compare();
  bool has_changed(const Mark& mark) const;
  double distance_of_two();
  double nearer(double size, double other);
  void add(Side& side, Point point);
  std::optional<double> zero_between(double low, double high, bool is_upper);

  std::array<Side, 2> sides_;
  std::vector<std::uint64_t> changed_;              ///< keys that one side has and the other has not, or not as often
  std::array<Marks, 2> changed_marks_;              ///< of the sides: those with such keys
  std::array<std::vector<std::uint64_t>, 2> keys_;  ///< of the sides, in order
  bool go_on_ = false, is_root_ = false, is_signed_ = false, is_upper_ = false;
  std::optional<double> last_;  ///< guess
  double leap_ = 0;             ///< away from it
  int guesses_ = 0;
};

}  // namespace pkm::generic
