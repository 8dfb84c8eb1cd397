#include "engine/generic/corner_curves/decomposition.hpp"

#include <algorithm>

#include "engine/generic/corner_curves/events.hpp"

namespace pkm::generic::corner_curves {
namespace {

// In intervals of tau that are shorter, the signs of functions are not reliable.
constexpr double kShort = 1e-7;

/// Divides the ranges of tau in which curves cross, at the events, into ranges of constant weight.
class RangeBuilder {
 public:
  RangeBuilder(const std::vector<BoundaryCurve>& curves, std::size_t count, const SliceFormula& formula,
               const NecessaryConstraints& necessary, Decomposition& result, DecompositionScratch& scratch)
      : curves_(curves), count_(count), formula_(formula), necessary_(necessary), out_(result), s_(scratch) {}

  void run() {
    out_.ranges.clear();
    out_.unbalanced = 0;
    for (std::size_t p = 0; p < s_.pair_count; ++p) add_ranges(s_.pairs[p]);
    check_balance();
  }

 private:
  using Pair = DecompositionScratch::Pair;

  int pair_of(std::size_t i, std::size_t j) const { return s_.pair_of[i * curves_.size() + j]; }

  void add_ranges(Pair& pair) {
    std::ranges::sort(pair.events, {}, &DecompositionScratch::Event::at);
    if (pair.has_conic) {
      for (std::size_t k = 0; k < pair.path_count; ++k) {
        const Subinterval<double>& range = out_.paths[pair.first_path + k].range;
        add_ranges_of(pair, static_cast<std::int8_t>(k + 1), static_cast<int>(pair.first_path + k), range);
      }
      return;
    }
    std::ranges::sort(pair.ends, {}, &Root::at);
    double low = -1;
    bool root_at_low = false;
    for (std::size_t e = 0; e <= pair.ends.size(); ++e) {
      const bool is_last = e == pair.ends.size();
      const double high = is_last ? 1 : pair.ends[e].at;
      const double width = std::max({kTiny, e > 0 ? pair.ends[e - 1].width : 0, is_last ? 0 : pair.ends[e].width});
      if (high - low > width) add_ranges_between(pair, {low, high, root_at_low, !is_last});
      low = high;
      root_at_low = true;
    }
  }

  /// Set of the curves whose sign at the crossings of curves i and j can change without an event: their crossings with
  /// i or with j are infeasible, so that no events were determined for them.
  Signs unknown_signs(std::size_t i, std::size_t j) const {
    Signs unknown = 0;
    for (std::size_t k = 0; k < count_; ++k)
      if (k != i && k != j && (pair_of(i, k) == kInfeasible || pair_of(j, k) == kInfeasible)) unknown |= bit(k);
    return unknown;
  }

  /// Adds the active ranges, in which a crossing is a vertex of the slice, of the crossings of two circles or lines
  /// between two consecutive roots of their discriminant.
  /// @param between  the two roots; between them the curves cross for all tau or for none
  void add_ranges_between(const Pair& pair, Subinterval<double> between) {
    const std::size_t i = pair.first, j = pair.second;
    if (pair.has_branches) {
      const Place place = sample_place(between.lower, between.upper);
      if (!has_crossing(curve_at(curves_[i], place), curve_at(curves_[j], place))) return;
    }
    between.sqrt_at_lower = between.sqrt_at_lower && pair.has_branches;
    between.sqrt_at_upper = between.sqrt_at_upper && pair.has_branches;
    const bool is_cut = curves_[j].kind == BoundaryCurve::Kind::cut;
    for (const std::int8_t branch : {std::int8_t{1}, std::int8_t{-1}})
      if (branch > 0 || (!is_cut && pair.has_branches)) add_ranges_of(pair, branch, -1, between);
  }

  Vector crossing_of(const CurveAt& first, const CurveAt& second, std::int8_t branch, int path, double tau) const {
    return path < 0 ? crossing(first, second, branch)
                    : out_.paths[static_cast<std::size_t>(path)].at(tau, first, second);
  }

  /// Adds the active ranges of one crossing: those ranges of tau in which it is a vertex of the slice.
  /// @param branch   branch of the crossing, or number of the path of a pair with a conic
  /// @param path     index of this path; -1: the pair has no conic
  void add_ranges_of(const Pair& pair, std::int8_t branch, int path, const Subinterval<double>& between) {
    const std::size_t i = pair.first, j = pair.second;
    const bool is_cut = curves_[j].kind == BoundaryCurve::Kind::cut;
    const auto [low, high, root_at_low, root_at_high] = between;
    // stale: curves whose sign has to be evaluated again; constant: curves whose sign does not change
    Signs signs = 0, stale = ~Signs{0}, constant = bit(i) | bit(j);
    for (const auto& each : pair.constants)
      if (each.branch == 0 || each.branch == branch) {
        constant |= bit(each.third);
        signs = each.outside ? signs | bit(each.third) : signs & ~bit(each.third);
      }
    const Signs unknown = unknown_signs(i, j);
    ActiveRange range{pair.first, pair.second, branch, 0, path, low, low, root_at_low, false};
    const auto finish = [&](double at, bool root) {
      range.high = at;
      range.root_at_high = root;
      if (range.weight != 0 && range.high > range.low) out_.ranges.push_back(range);
      range.low = at;
      range.root_at_low = false;
    };
    double from = low, width = 0;
    bool is_divided = false;
    const auto sample = [&](double to) {
      const Place place = sample_place(from, to);
      const CurveAt first = curve_at(curves_[i], place), second = curve_at(curves_[j], place);
      const Vector p = crossing_of(first, second, branch, path, place.tau);
      stale = (stale | unknown) & ~constant;
      // In a short interval a sign may be a rounding error: evaluate it again in the next interval.
      const Signs evaluated_again = to - from < kShort ? stale : 0;
      // Evaluate the signs of necessary constraints first, because most crossings violate one of them.
      const Signs known = ~(stale | bit(i) | bit(j));
      bool is_violated = necessary_.is_violated(signs, known);
      for (const Signs which : {necessary_.inside | necessary_.outside, ~Signs{0}})
        for (std::size_t k = 0; k < count_ && !is_violated; ++k) {
          if ((which & stale & bit(k)) == 0) continue;
          stale &= ~bit(k);
          const double h = curve_at(curves_[k], place).h(p);
          signs = h > 0 ? signs | bit(k) : signs & ~bit(k);
          is_violated = necessary_.violation(k, h) > 0;
        }
      stale |= evaluated_again;
      const int weight = is_violated ? 0
                         : is_cut    ? weight_of_cut(i, signs)
                                     : weight_of(i, j, signs, determinant(first.gradient(p), second.gradient(p)));
      if (weight != range.weight || is_divided) {
        finish(from, false);
        range.weight = static_cast<std::int8_t>(weight);
      }
      is_divided = false;
    };
    for (const auto& event : pair.events) {
      if (event.at <= low || event.at >= high || (event.branches != 0 && event.branches != branch)) continue;
      // Take no sample close to an undecided interval.
      if (event.at - from > std::max({kTiny, width, event.width})) {
        sample(event.at);
        from = event.at;
        width = 0;
      }
      width = std::max(width, event.width);
      if (event.third < count_)
        stale |= bit(event.third);
      else
        is_divided = true;
    }
    if (high - from > std::fmax(kTiny, width)) sample(high);
    if (high - from > kShort) {
      const Signs followed = ~(stale | unknown | constant) & (bit(count_) - 1);
      const Place place = sample_place(from, high);
      const Vector p = crossing_of(curve_at(curves_[i], place), curve_at(curves_[j], place), branch, path, place.tau);
      if (!are_signs(p, place, followed, signs)) out_.unbalanced += high - low;
    }
    finish(high, root_at_high);
  }

  /// Whether the curves' signs `signs`, updated at all events, agree with the signs of the curves' functions at a
  /// crossing p at one value of tau (`place`); if not, an event was missed.
  /// @param which  set of the curves whose signs are compared
  bool are_signs(const Vector& p, const Place& place, Signs which, Signs signs) const {
    constexpr double kUncertain = 1e-9;
    for (std::size_t k = 0; k < count_; ++k) {
      if ((which & bit(k)) == 0) continue;
      const double h = curve_at(curves_[k], place).h(p);
      if (std::fabs(h) > kUncertain && (h > 0) != ((signs & bit(k)) != 0)) return false;
    }
    return true;
  }

  int weight_of(std::size_t i, std::size_t j, Signs signs, double orientation) const {
    signs &= ~(bit(i) | bit(j));
    const int sum = static_cast<int>(formula_.holds(signs | bit(i) | bit(j))) -
                    static_cast<int>(formula_.holds(signs | bit(i))) -
                    static_cast<int>(formula_.holds(signs | bit(j))) + static_cast<int>(formula_.holds(signs));
    if (sum == 0) return 0;
    return orientation > 0 ? sum : -sum;
  }
  int weight_of_cut(std::size_t i, Signs signs) const {
    signs &= ~bit(i);
    return static_cast<int>(formula_.holds(signs)) - static_cast<int>(formula_.holds(signs | bit(i)));
  }

  void check_balance() {
    s_.balance.clear();
    for (const ActiveRange& range : out_.ranges) {
      if (curves_[range.second].kind == BoundaryCurve::Kind::cut) continue;
      for (const auto& [curve, sign] : {std::pair{range.first, 1}, {range.second, -1}}) {
        s_.balance.push_back({range.low, curve, sign * range.weight});
        s_.balance.push_back({range.high, curve, -sign * range.weight});
      }
    }
    std::ranges::sort(
        s_.balance, [](const auto& a, const auto& b) { return a.curve != b.curve ? a.curve < b.curve : a.at < b.at; });
    int sum = 0;
    for (std::size_t k = 0; k + 1 < s_.balance.size(); ++k) {
      if (k > 0 && s_.balance[k].curve != s_.balance[k - 1].curve) sum = 0;
      sum += s_.balance[k].change;
      if (sum != 0 && s_.balance[k + 1].curve == s_.balance[k].curve)
        out_.unbalanced += s_.balance[k + 1].at - s_.balance[k].at;
    }
  }

  const std::vector<BoundaryCurve>& curves_;
  std::size_t count_;  ///< number of curves, not counting cuts
  const SliceFormula& formula_;
  const NecessaryConstraints& necessary_;
  Decomposition& out_;
  DecompositionScratch& s_;
};

}  // namespace

bool decompose(std::vector<BoundaryCurve>& curves, const SliceFormula& formula, Decomposition& result,
               DecompositionScratch& scratch) {
  if (curves.empty()) return false;
  const std::size_t count = curves.size();
  const NecessaryConstraints necessary(formula);
  if (!find_events(curves, count, formula, necessary, result, scratch)) return false;
  RangeBuilder(curves, count, formula, necessary, result, scratch).run();
  return true;
}

}  // namespace pkm::generic::corner_curves
