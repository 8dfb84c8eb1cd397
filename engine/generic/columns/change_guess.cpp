#include "engine/generic/columns/change_guess.hpp"

#include <algorithm>
#include <cmath>

namespace pkm::generic {
namespace {

constexpr int kMostGuesses = 18;           // then it is halved
constexpr std::size_t kMostChanged = 100;  // keys, and marks of them: pairs are many, and bisection is as good then

}  // namespace

void ChangeGuess::start(bool go_on) {
  go_on_ = go_on;
  for (Side& side : sides_) {
    side.is_known = false;
    side.count = 0;
  }
  is_root_ = is_signed_ = false;
  last_.reset();
  leap_ = 0;
  guesses_ = 0;
}

/// What the two sides do not have in common.
void ChangeGuess::compare() {
  for (std::size_t i = 0; i < 2; ++i) {
    keys_[i].clear();
    for (const Mark& mark : sides_[i].marks)
      if (mark.bounds) keys_[i].push_back(mark.key);
    std::ranges::sort(keys_[i]);
  }
  const auto count = [&](std::size_t side, std::uint64_t key) {
    const auto [first, last] = std::equal_range(keys_[side].begin(), keys_[side].end(), key);
    return last - first;
  };
  changed_.clear();
  for (const Side& side : sides_)
    for (const Mark& mark : side.marks)
      if (mark.bounds && count(0, mark.key) != count(1, mark.key) && !has_changed(mark)) {
        changed_.push_back(mark.key);
        if (changed_.size() > kMostChanged) return;
      }
}

bool ChangeGuess::has_changed(const Mark& mark) const {
  return std::ranges::find(changed_, mark.key) != changed_.end();
}

/// Whether it is known what changes.
bool ChangeGuess::take(bool is_upper, Structure structure, const Marks& marks) {
  Side& side = sides_[is_upper];
  const bool is_other = !side.is_known || side.structure != structure;
  side.structure = structure;
  side.is_known = true;
  side.marks = marks;
  is_upper_ = is_upper;
  if (!sides_[!is_upper].is_known) return false;
  if (is_other) {
    compare();
    for (Side& each : sides_) each.count = 0;
  }
  if (changed_.size() > kMostChanged) return false;
  for (std::size_t i = 0; i < 2; ++i) {
    changed_marks_[i].clear();
    for (const Mark& mark : sides_[i].marks)
      if (has_changed(mark)) changed_marks_[i].push_back(mark);
    if (changed_marks_[i].size() > kMostChanged) return false;
  }
  return true;
}

void ChangeGuess::see_size(double at, bool is_upper, double size) {
  is_signed_ = true;
  is_upper_ = is_upper;
  add(sides_[0], {at, size});
}

/// The least distance of two of the marks that the other side has not. Of two ends it has a sign, wherever they are.
double ChangeGuess::distance_of_two() {
  const Marks& marks = changed_marks_[is_upper_];
  const bool are_two = changed_.size() == 2;
  double least = kUnknown, size = least;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const Mark& x = marks[i];
    for (std::size_t j = i + 1; j < marks.size(); ++j) {
      const Mark& y = marks[j];
      const bool bound = x.bounds && y.bounds, like_root = x.of == y.of;
      const bool may_meet =
          go_on_ ? like_root ? bound : x.key != y.key && (bound || are_two) : !like_root || x.key == y.key;
      if (!may_meet) continue;
      const double distance = std::hypot(x.t - y.t, x.s - y.s);
      if (!(distance > 0 && distance < least)) continue;
      least = distance;
      is_root_ = like_root;
      is_signed_ = go_on_ && are_two && !like_root;
      size = is_signed_ ? (x.key == changed_[0] ? 1 : -1) * (x.t - y.t) : distance;
    }
  }
  return size;
}

double ChangeGuess::nearer(double size, double other) {
  if (!(other < size)) return size;
  is_root_ = false;
  return other;
}

void ChangeGuess::add(Side& side, Point point) {
  Side& to = is_signed_ ? sides_[0] : side;
  if (to.count == 3) std::shift_left(to.points.begin(), to.points.end(), 1);
  to.points[static_cast<std::size_t>(std::min(to.count, 2))] = point;
  to.count = std::min(to.count + 1, 3);
}

/// Where what has been seen on a side vanishes.
std::optional<double> ChangeGuess::zero_between(double low, double high, bool is_upper) {
  const Side& side = sides_[is_signed_ ? 0 : is_upper];
  if (side.count < 2) return {};
  const auto through = [](const Point& p, const Point& q, bool is_root) {
    const double at_p = is_root ? p.size * p.size : p.size, at_q = is_root ? q.size * q.size : q.size;
    return q.at - at_q * (q.at - p.at) / (at_q - at_p);
  };
  const Point* const last = &side.points[static_cast<std::size_t>(side.count - 1)];
  if (side.count == 3 && !is_signed_) {
    // as which of the two it went on from the first two to the third
    const auto off = [&](bool is_root) {
      const double at = through(last[-2], last[-1], is_root), whole = at - last[-1].at, rest = at - last->at;
      const double ratio = last->size / last[-1].size;
      return std::fabs((is_root ? ratio * ratio : ratio) - rest / whole);
    };
    is_root_ = off(true) < off(false);
  }
  const double at = through(last[-1], *last, is_root_);
  if (!(at > low && at < high)) return {};
  return at;
}

double ChangeGuess::next(double low, double high, double near) {
  const double middle = 0.5 * (low + high);
  if (guesses_ >= kMostGuesses) return middle;
  bool is_upper = is_upper_;
  std::optional<double> at = zero_between(low, high, is_upper);
  if (!at) at = zero_between(low, high, is_upper = !is_upper);
  if (++guesses_ % 6 == 0) return middle;
  if (!at) {
    // What has been guessed is near an end of what is left, and something else was found beside it.
    if (!last_ || leap_ == 0) return middle;
    leap_ = std::fmax(16 * leap_, near);
    const double beyond = *last_ - low < high - *last_ ? low + leap_ : high - leap_;
    return beyond > low && beyond < high ? beyond : middle;
  }
  // On the side where it is seen, as far from the guess as that may be off; once that is near, on the other side.
  const double from = is_upper ? high : low, there = std::fabs(*at - from);
  const double off = std::fmax(last_ ? std::fmin(std::fabs(*at - *last_), 0.1 * there) : 0.1 * there, 0.5 * near);
  last_ = at;
  leap_ = off;
  const double back = is_upper == (there > 2 * off) ? off : -off;
  return std::fmax(low + 0.25 * near, std::fmin(high - 0.25 * near, *at + back));
}

}  // namespace pkm::generic
