#include "engine/generic/columns/sign_changes.hpp"

#include <bit>
#include <cmath>

#include "engine/core/stop.hpp"
#include "engine/math/roots.hpp"
#include "engine/math/satisfied.hpp"

namespace pkm::generic {
namespace {

// Intervals are not bisected if their width, relative to the whole range, is at most this.
constexpr double kNarrow = 1e-9;

class Search {
 public:
  Search(const expression::Program& program, std::size_t stage, std::span<const WithDerivative> constraints,
         std::span<double> registers, SignChangeScratch& scratch)
      : program_(program), stage_(stage), constraints_(constraints), registers_(registers), s_(scratch) {
    s_.registers.resize(registers.size());
    for (std::size_t i = 0; i < registers.size(); ++i) s_.registers[i] = Interval(registers[i]);
  }

  void run(double from, double to, long max_evaluations) {
    const double narrow = kNarrow * (to - from);
    s_.parts.assign(1, {from, to, constraints_.size() < 64 ? bit(constraints_.size()) - 1 : ~Signs{0}});
    // Breadth-first order: if the limit of evaluations ends the search, every part of the range has been examined.
    while (!s_.parts.empty()) {
      s_.halves.clear();
      for (SignChangeScratch::Part part : s_.parts) {
        check_stop();
        part.undecided = examine(part);
        if (part.undecided == 0) continue;
        const double middle = 0.5 * (part.from + part.to);
        const bool is_exhausted = s_.evaluations >= max_evaluations;
        // An interval that is a few ulp wide, or has a NaN bound, has no midpoint.
        if (is_exhausted || part.to - part.from <= narrow || !(part.from < middle && middle < part.to)) {
          // A sign change at the end of the domain of a constraint is located only to the width of the interval.
          if (add_changes(part, part.undecided, !is_exhausted) < std::popcount(part.undecided) || is_exhausted)
            s_.undecided += part.to - part.from;
          continue;
        }
        s_.halves.push_back({part.from, middle, part.undecided});
        s_.halves.push_back({middle, part.to, part.undecided});
      }
      s_.parts.swap(s_.halves);
    }
  }

 private:
  template <class S>
  void evaluate(const S& at, std::span<S> registers) const {
    for (const auto& input : program_.stages()[stage_].inputs) registers[input.to] = at;
    program_.run<S>(stage_, registers);
  }

  /// Evaluates the undecided constraints on an interval, and adds a sign change for each one that is monotonic there
  /// and changes its sign.
  /// @return the set of constraints that remain undecided: without a certified sign, and not monotonic
  Signs examine(const SignChangeScratch::Part& part) {
    ++s_.evaluations;
    evaluate<Interval>({part.from, part.to}, s_.registers);
    Signs monotonic = 0, undecided = 0;
    for (Signs rest = part.undecided; rest != 0; rest &= rest - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(rest));
      const Interval &f = s_.registers[constraints_[k].value], &slope = s_.registers[constraints_[k].derivative];
      if (f.is_certified_satisfied() || f.is_certified_violated()) continue;
      const bool has_one =
          f.is_defined() && f.is_continuous() && slope.is_defined() && (slope.lower > 0 || slope.upper < 0);
      (has_one ? monotonic : undecided) |= bit(k);
    }
    add_changes(part, monotonic, true);
    return undecided;
  }

  /// For each constraint of the set `of` that has different signs at the two ends of an interval, adds a sign change.
  /// @param refines  true: locate the sign change by root refinement; false: place it in the middle of the interval
  /// @return number of sign changes that were added
  int add_changes(const SignChangeScratch::Part& part, Signs of, bool refines) {
    int count = 0;
    for (; of != 0; of &= of - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(of));
      const auto value_at = [&](double x) {
        evaluate<double>(x, registers_);
        return ValueAndDerivative{registers_[constraints_[k].value], registers_[constraints_[k].derivative]};
      };
      const bool below = is_satisfied(value_at(part.from).value);
      if (below == is_satisfied(value_at(part.to).value)) continue;
      double at = 0.5 * (part.from + part.to);
      const double tolerance = 1e-16 * (std::fabs(part.from) + std::fabs(part.to));
      if (refines)
        at = refine_root_newton(
            value_at, part.from, part.to, below, at,
            [&](const ValueAndDerivative&, double x, double next) { return std::fabs(next - x) <= tolerance; });
      s_.found.push_back({at, k, below});
      ++count;
    }
    return count;
  }

  const expression::Program& program_;
  std::size_t stage_;
  std::span<const WithDerivative> constraints_;
  std::span<double> registers_;
  SignChangeScratch& s_;
};

}  // namespace

void find_sign_changes(const expression::Program& program, std::size_t stage,
                       std::span<const WithDerivative> constraints, double from, double to, long max_evaluations,
                       std::span<double> registers, SignChangeScratch& scratch) {
  scratch.found.clear();
  scratch.undecided = 0;
  scratch.evaluations = 0;
  if (!constraints.empty()) Search(program, stage, constraints, registers, scratch).run(from, to, max_evaluations);
}

}  // namespace pkm::generic
