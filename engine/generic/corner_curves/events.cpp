#include "engine/generic/corner_curves/events.hpp"

#include <algorithm>
#include <functional>
#include <span>

#include "engine/generic/corner_curves/coincidence.hpp"
#include "engine/math/portable.hpp"

namespace pkm::generic::corner_curves {
namespace {

// Two curves count as parallel if the relative distance of their centres, or the sine of the angle between them, is at
// most this.
constexpr double kParallel = 1e-13;
constexpr double kUnresolved = 1e-9;  // maximum relative interpolation error of a discriminant or concurrence function

class EventFinder {
 public:
  EventFinder(std::vector<BoundaryCurve>& curves, std::size_t count, const SliceFormula& formula,
              const NecessaryConstraints& necessary, Decomposition& result, DecompositionScratch& scratch)
      : curves_(curves), count_(count), formula_(formula), necessary_(necessary), out_(result), s_(scratch) {}

  bool run() {
    out_.paths.clear();
    out_.undecided = 0;
    out_.functions = 0;
    s_.pair_count = 0;
    s_.meetings.clear();
    for (std::size_t i = 0; i < count_; ++i)
      if (curves_[i].is_conic()) conics_ |= bit(i);
    add_cuts();
    s_.pair_of.assign(curves_.size() * curves_.size(), kNone);
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t j = i + 1; j < count_; ++j)
        if (!add_pair(i, j)) return false;
      if (cut_of_[i] != 0 && !add_pair(i, cut_of_[i])) return false;
    }
    if (!add_triples() || (conics_ != 0 && !add_conic_events())) return false;
    add_meetings();
    align_undecided_roots();
    return true;
  }

 private:
  using Pair = DecompositionScratch::Pair;

  bool is_conic(std::size_t i) const { return (conics_ & bit(i)) != 0; }
  int& pair_of(std::size_t i, std::size_t j) { return s_.pair_of[i * curves_.size() + j]; }

  /// Appends to curves_ a cut for each circle: the line from its centre to the point at which its angle is 0. The
  /// direction of this line is chosen such that at as few sample values of tau as possible the circle bounds the
  /// feasible part there.
  void add_cuts() {
    constexpr std::size_t kDirections = 7, kSampleNodes = 5;
    for (std::size_t i = 0; i < count_; ++i) {
      cut_of_[i] = 0;
      if (!curves_[i].is_circle()) continue;
      std::size_t best = 0, fewest = kSampleNodes + 1;
      for (std::size_t d = 0; d < kDirections && fewest > 0; ++d) {
        const auto [sine, cosine] = direction(d);
        std::size_t active = 0;
        for (std::size_t k = 0; k < kSampleNodes; ++k) {
          const std::size_t n = (2 * k + 1) * kNodes / (2 * kSampleNodes);
          const double radius = std::sqrt(std::fmax(0, curves_[i].values[2][n]));
          const Vector p{curves_[i].values[0][n] + radius * cosine, curves_[i].values[1][n] + radius * sine};
          const Signs signs = signs_at_node(n, p);
          active += formula_.holds(signs | bit(i)) != formula_.holds(signs & ~bit(i));
        }
        if (active < fewest) {
          fewest = active;
          best = d;
        }
      }
      const auto [sine, cosine] = direction(best);
      BoundaryCurve cut;
      cut.kind = BoundaryCurve::Kind::cut;
      for (std::size_t n = 0; n < kNodes; ++n) {
        cut.values[0][n] = sine;
        cut.values[1][n] = -cosine;
        cut.values[2][n] = cosine * curves_[i].values[1][n] - sine * curves_[i].values[0][n];
      }
      cut.interpolate(1);
      cut_of_[i] = curves_.size();
      curves_.push_back(cut);
    }
  }
  static SinCosOf<double> direction(std::size_t d) {
    return portable::sincos(0.3711 + 0.8976 * static_cast<double>(d));
  }
  Signs signs_at_node(std::size_t n, const Vector& p) const {
    Signs signs = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      const auto& [u, w, c] = curves_[k].values;
      if (CurveAt{curves_[k].is_circle(), u[n], w[n], c[n]}.h(p) > 0) signs |= bit(k);
    }
    return signs;
  }

  /// Interpolates a function of tau and finds its roots. @return false if the interpolation error is too large
  bool find_roots(const Sampled& function, std::vector<Root>& roots) {
    roots.clear();
    ++out_.functions;
    double largest = 0;
    for (const double value : function.values) largest = std::max(largest, std::fabs(value));
    Samples series;
    to_coefficients(function.values, series);
    const double error = interpolation_error(series, function.rounding);
    isolate_roots(series, error, roots);
    if (!roots.empty() && error - function.rounding > kUnresolved * largest) return false;
    for (const Root& root : roots) out_.undecided += root.width;
    return true;
  }
  static bool is_zero(const Sampled& function) {
    return std::ranges::all_of(function.values,
                               [&](double value) { return std::fabs(value) <= kZero * function.rounding; });
  }

  bool add_pair(std::size_t i, std::size_t j) {
    if (s_.pair_count == s_.pairs.size()) s_.pairs.emplace_back();
    Pair& pair = s_.pairs[s_.pair_count];
    pair.first = static_cast<std::uint8_t>(i);
    pair.second = static_cast<std::uint8_t>(j);
    pair.has_branches = curves_[i].is_circle() || curves_[j].is_circle();
    pair.has_conic = is_conic(i) || (j < count_ && is_conic(j));
    pair.events.clear();
    pair.constants.clear();
    if (pair.has_conic) return add_pair_with_conic(pair);
    if (is_parallel(i, j)) return add_parallel(i, j);
    discriminant(curves_[i], curves_[j], pair.discriminant);
    if (is_zero(pair.discriminant)) {
      pair_of(i, j) = pair_of(j, i) = kTangent;
      return true;
    }
    if (!find_roots(pair.discriminant, pair.ends)) return false;
    if (pair.has_branches && pair.ends.empty() && pair.discriminant.values[0] < 0) return true;
    if (is_infeasible(pair)) {
      pair_of(i, j) = pair_of(j, i) = kInfeasible;
      return true;
    }
    pair_of(i, j) = pair_of(j, i) = static_cast<int>(s_.pair_count++);
    return true;
  }

  /// Follows the crossings of a conic with another curve, and adds the events on them, i.e. the values of tau at which
  /// a third curve passes through a crossing.
  bool add_pair_with_conic(Pair& pair) {
    const std::size_t i = pair.first, j = pair.second;
    const bool is_first = is_conic(i);
    const BoundaryCurve &conic = curves_[is_first ? i : j], &other = curves_[is_first ? j : i];
    conic_discriminant(conic, other, pair.discriminant);
    if (is_zero(pair.discriminant) || !find_roots(pair.discriminant, pair.ends)) return false;
    for (Root& end : pair.ends)
      if (end.width == 0) end.at = refine_contact(conic, other, end.at);
    std::ranges::sort(pair.ends, {}, &Root::at);
    pair.first_path = out_.paths.size();
    const bool is_followed = visit_ranges(
        pair, [&](const Subinterval<double>& range) { return follow_crossings(conic, other, range, out_.paths); });
    if (!is_followed) return false;
    std::size_t kept = pair.first_path;
    for (std::size_t p = pair.first_path; p < out_.paths.size(); ++p) {
      const std::size_t events = pair.events.size();
      const std::size_t number = kept - pair.first_path + 1;
      bool is_feasible = true;
      if (number > 100 || !add_path_events(pair, out_.paths[p], static_cast<std::int8_t>(number), is_feasible))
        return false;
      if (is_feasible)
        out_.paths[kept++] = out_.paths[p];
      else
        pair.events.resize(events);
    }
    out_.paths.resize(kept);
    pair.path_count = kept - pair.first_path;
    if (pair.path_count > 0) pair_of(i, j) = pair_of(j, i) = static_cast<int>(s_.pair_count++);
    return true;
  }

  /// Calls visit(range) for the ranges between consecutive roots of the discriminant of a pair, each with a square root
  /// at one end at most. @return false if visit() returns false
  template <class Visit>
  static bool visit_ranges(const Pair& pair, const Visit& visit) {
    for (std::size_t e = 0; e <= pair.ends.size(); ++e) {
      const bool is_first = e == 0, is_last = e == pair.ends.size();
      const double low = is_first ? -1 : pair.ends[e - 1].at, high = is_last ? 1 : pair.ends[e].at;
      if (high - low <= std::max({kTiny, is_first ? 0 : pair.ends[e - 1].width, is_last ? 0 : pair.ends[e].width}))
        continue;
      const Subinterval<double> range{low, high, !is_first, !is_last};
      if (is_first || is_last) {
        if (!visit(range)) return false;
        continue;
      }
      for (const Subinterval<double>& half : halves(range))
        if (!visit(half)) return false;
    }
    return true;
  }

  /// Isolates the roots of h of a curve along a crossing, and adds them as events.
  /// @param values    W^2 h at the nodes of the range, with their error
  /// @param branches  branch or path of the crossing
  /// @return false if the function is not resolved, or 0 everywhere
  bool add_events_on(Pair& pair, const Subinterval<double>& range, Sampled& values, std::uint8_t third,
                     std::int8_t branches) {
    const double undecided = out_.undecided;
    if (is_zero(values) || !find_roots(values, s_.roots)) return false;
    out_.undecided = undecided;
    const auto place = [&](double s) { return map_node(range, 0.5 * (1 + std::fmin(1, std::fmax(-1, s)))).point; };
    for (const Root& root : s_.roots) {
      const double width = root.width == 0 ? 0 : place(root.at + 0.5 * root.width) - place(root.at - 0.5 * root.width);
      out_.undecided += width;
      pair.events.push_back({place(root.at), width, third, branches});
    }
    return true;
  }

  /// Adds the events on a path of a crossing, i.e. the values of tau at which a third curve passes through the
  /// crossing.
  /// @param is_feasible  set to false if a necessary constraint is violated on the whole path
  /// @return false if the events are not resolved
  bool add_path_events(Pair& pair, const CrossingPath& path, std::int8_t number, bool& is_feasible) {
    Samples tau;
    for (std::size_t n = 0; n < kNodes; ++n) tau[n] = map_node(path.range, 0.5 * (1 + chebyshev_nodes()[n])).point;
    const auto point = [&](std::size_t n) {
      return Homogeneous{path.values[0][n], path.values[1][n], path.values[2][n]};
    };
    const std::size_t i = pair.first, j = pair.second;
    const auto sample = [&](std::size_t k) {  // values W^2 h of curve k along the path
      std::array<CurveAt, kNodes> at;
      sample_curve(curves_[k], path.range, tau, at);
      for (std::size_t n = 0; n < kNodes; ++n) function_.values[n] = homogeneous_value(at[n], point(n));
      const double size = 1 + curves_[k].size[0] + curves_[k].size[1] + curves_[k].size[2];
      function_.rounding = (8 * kUnitRoundoff + path.error) * size;
    };
    // Most paths violate a necessary constraint everywhere: examine first the constraint that the middle of the path
    // violates most.
    std::size_t worst = count_;
    double largest = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      if (k == i || k == j || !necessary_.has(k)) continue;
      const double value = homogeneous_value(curves_[k].at(tau[kNodes / 2]), point(kNodes / 2));
      if (necessary_.violation(k, value) <= largest) continue;
      largest = necessary_.violation(k, value);
      worst = k;
    }
    if (worst < count_) {
      sample(worst);
      ++out_.functions;
      is_feasible = !has_no_root(function_);
      if (!is_feasible) return true;
    }
    for (std::size_t k = 0; k < curves_.size(); ++k) {
      if (k == i || k == j || (k >= count_ && cut_of_[i] != k && cut_of_[j] != k)) continue;
      sample(k);
      if (!add_events_on(pair, path.range, function_, static_cast<std::uint8_t>(k), number)) return false;
    }
    return true;
  }
  /// Whether bounds of a function exclude a root.
  static bool has_no_root(const Sampled& function) {
    Samples series;
    to_coefficients(function.values, series);
    double rest = interpolation_error(series, function.rounding);
    for (std::size_t k = 1; k < kNodes; ++k) rest += std::fabs(series[k]);
    return std::fabs(series[0]) > rest;
  }

  /// Adds events, i.e. the values of tau at which conics pass through the crossings of two circles or lines. @return
  /// false if they are not resolved
  bool add_conic_events() {
    for (std::size_t p = 0; p < s_.pair_count; ++p) {
      Pair& pair = s_.pairs[p];
      if (pair.has_conic) continue;
      const bool is_single = !pair.has_branches || curves_[pair.second].kind == BoundaryCurve::Kind::cut;
      for (std::size_t k = 0; k < count_; ++k) {
        if (!is_conic(k)) continue;
        const auto add = [&](const Subinterval<double>& range) {
          return add_conic_events(pair, k, 1, range, 0) && (is_single || add_conic_events(pair, k, -1, range, 0));
        };
        if (pair.has_branches ? !visit_ranges(pair, add) : !add({-1, 1, false, false})) return false;
      }
    }
    return true;
  }
  /// Adds events, i.e. the values of tau in a range at which a conic passes through one crossing. @return false if they
  /// are not resolved
  bool add_conic_events(Pair& pair, std::size_t conic, std::int8_t branch, const Subinterval<double>& range,
                        int halvings) {
    constexpr int kMaxHalvings = 6;
    Samples tau;
    for (std::size_t n = 0; n < kNodes; ++n) tau[n] = map_node(range, 0.5 * (1 + chebyshev_nodes()[n])).point;
    std::array<CurveAt, kNodes> f, g, h;
    sample_curve(curves_[pair.first], range, tau, f);
    sample_curve(curves_[pair.second], range, tau, g);
    if (pair.has_branches && !has_crossing(f[kNodes / 2], g[kNodes / 2])) return true;
    sample_curve(curves_[conic], range, tau, h);
    double largest = 1;
    for (std::size_t n = 0; n < kNodes; ++n) {
      Homogeneous point;
      if (pair.has_branches) {
        const Vector at = crossing(f[n], g[n], branch);
        point = {at.x, at.y, 1};
      } else {
        point = {f[n].w * g[n].c - g[n].w * f[n].c, f[n].c * g[n].u - g[n].c * f[n].u,
                 f[n].u * g[n].w - f[n].w * g[n].u};
      }
      function_.values[n] = homogeneous_value(h[n], point);
      largest = std::max(largest, point[0] * point[0] + point[1] * point[1]);
    }
    function_.rounding = (32 * kUnitRoundoff + 4 * curves_[conic].tail) * largest;
    if (add_events_on(pair, range, function_, static_cast<std::uint8_t>(conic),
                      pair.has_branches ? branch : std::int8_t{0}))
      return true;
    return halvings < kMaxHalvings && std::ranges::all_of(halves(range), [&](const Subinterval<double>& half) {
             return add_conic_events(pair, conic, branch, half, halvings + 1);
           });
  }

  /// Whether two curves are concentric circles, or parallel lines, for all tau.
  bool is_parallel(std::size_t i, std::size_t j) const {
    if (curves_[i].is_circle() != curves_[j].is_circle()) return false;
    const auto& [u, w, c] = curves_[i].values;
    const auto& [x, y, d] = curves_[j].values;
    for (std::size_t n = 0; n < kNodes; ++n) {
      const double across = curves_[i].is_circle() ? std::fabs(u[n] - x[n]) + std::fabs(w[n] - y[n])
                                                   : std::fabs(u[n] * y[n] - w[n] * x[n]);
      if (across > kParallel * (1 + std::fabs(u[n]) + std::fabs(w[n]))) return false;
    }
    return true;
  }
  /// Finds the values of tau at which two parallel curves coincide, and appends them to s_.meetings.
  /// @return false if the interpolation error is too large
  bool add_parallel(std::size_t i, std::size_t j) {
    const auto& first = curves_[i].values;
    const auto& second = curves_[j].values;
    const double sign = curves_[i].is_circle() || first[0][0] * second[0][0] + first[1][0] * second[1][0] > 0 ? 1 : -1;
    for (std::size_t n = 0; n < kNodes; ++n) function_.values[n] = first[2][n] - sign * second[2][n];
    function_.rounding = 4 * kUnitRoundoff * (curves_[i].size[2] + curves_[j].size[2] + 1);
    if (!find_roots(function_, s_.roots)) return false;
    for (const Root& root : s_.roots)
      s_.meetings.push_back({root.at, root.width, static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(j)});
    return true;
  }
  /// For each value of tau at which two parallel curves coincide, adds events: each of the two curves passes through
  /// the crossings of the other one there.
  void add_meetings() {
    for (const auto& [at, width, i, j] : s_.meetings)
      for (std::size_t k = 0; k < curves_.size(); ++k)
        for (const auto& [own, other] : {std::pair{i, j}, {j, i}})
          if (k != i && k != j && pair_of(own, k) >= 0)
            s_.pairs[static_cast<std::size_t>(pair_of(own, k))].events.push_back({at, width, other, 0});
  }

  /// If a root lies in an undecided interval, moves it to the nearest other root in this interval, so that an event has
  /// the same tau for all curves.
  void align_undecided_roots() {
    if (out_.undecided == 0) return;
    const std::span<Pair> pairs = std::span(s_.pairs).first(s_.pair_count);
    std::vector<double>& places = s_.places;
    places.clear();
    for (const Pair& pair : pairs) {
      for (const Root& end : pair.ends)
        if (end.width == 0) places.push_back(end.at);
      for (const auto& event : pair.events)
        if (event.width == 0) places.push_back(event.at);
    }
    const auto align = [&](double& at, double width) {
      if (width == 0) return;
      double nearest = width;
      const double own = at;
      for (const double place : places)
        if (std::fabs(place - own) < nearest) {
          nearest = std::fabs(place - own);
          at = place;
        }
      if (nearest == width) places.push_back(at);
    };
    for (Pair& pair : pairs) {
      for (Root& end : pair.ends) align(end.at, end.width);
      for (auto& event : pair.events) align(event.at, event.width);
    }
  }

  /// Whether a necessary constraint is violated wherever the two curves of a pair cross, so that these crossings are
  /// never vertices. If the curve of this constraint never passes through a crossing, one sample in each range of tau
  /// in which the two curves cross is sufficient to decide this.
  bool is_infeasible(Pair& pair) {
    const std::size_t i = pair.first, j = pair.second;
    const bool is_cut = curves_[j].kind == BoundaryCurve::Kind::cut;
    std::array<double, kMaxCurves> smallest;
    smallest.fill(1e9);
    std::ranges::sort(pair.ends, {}, &Root::at);
    double low = -1;
    for (std::size_t e = 0; e <= pair.ends.size(); ++e) {
      const double high = e == pair.ends.size() ? 1 : pair.ends[e].at;
      const Place place = sample_place(low, high);
      const bool is_short = high - low <= kTiny;
      low = high;
      if (is_short) continue;
      const CurveAt first = curve_at(curves_[i], place), second = curve_at(curves_[j], place);
      if (pair.has_branches && !has_crossing(first, second)) continue;
      for (const double branch : {1.0, -1.0}) {
        if (branch < 0 && (is_cut || !pair.has_branches)) break;
        const Vector p = crossing(first, second, branch);
        for (std::size_t k = 0; k < count_; ++k)
          if (necessary_.has(k) && !is_conic(k) && smallest[k] > 0)
            smallest[k] = std::min(smallest[k], necessary_.violation(k, curve_at(curves_[k], place).h(p)));
      }
    }
    std::size_t worst = count_;
    double largest = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      if (!necessary_.has(k) || is_conic(k) || k == i || k == j || smallest[k] <= largest) continue;
      largest = smallest[k];
      worst = k;
    }
    if (worst == count_) return false;
    concurrence(curves_[i], curves_[j], curves_[worst], function_);
    ++out_.functions;
    return has_no_root(function_);
  }

  bool add_triples() {
    for (std::size_t i = 0; i < count_; ++i)
      for (std::size_t j = i + 1; j < count_; ++j) {
        if (is_conic(i) || is_conic(j) || !may_meet(i, j)) continue;
        for (std::size_t k = j + 1; k < count_; ++k)
          if (!is_conic(k) && may_meet(i, k) && may_meet(j, k) && !add_triple(i, j, k)) return false;
        if (pair_of(i, j) < 0) continue;
        for (const auto& [circle, other] : {std::pair{i, j}, {j, i}})
          if (cut_of_[circle] != 0 && pair_of(circle, cut_of_[circle]) >= 0 && !add_cut_triple(circle, other))
            return false;
      }
    return true;
  }
  /// Adds an event to a pair: a third curve passes through the pair's crossing at a root of the concurrence function.
  /// @param pair   index in s_.pairs
  /// @param third  index of the third curve
  void add_event(int pair, const Root& root, std::size_t third) {
    s_.pairs[static_cast<std::size_t>(pair)].events.push_back(
        {root.at, root.width, static_cast<std::uint8_t>(third), 0});
  }
  bool may_meet(std::size_t i, std::size_t j) { return pair_of(i, j) >= 0 || pair_of(i, j) == kTangent; }
  bool add_triple(std::size_t i, std::size_t j, std::size_t k) {
    const int pairs[3] = {pair_of(i, j), pair_of(i, k), pair_of(j, k)};
    if (pairs[0] < 0 && pairs[1] < 0 && pairs[2] < 0) return true;
    concurrence(curves_[i], curves_[j], curves_[k], function_);
    const auto pair = [&](int number) { return number < 0 ? nullptr : &s_.pairs[static_cast<std::size_t>(number)]; };
    if (is_zero(function_)) {
      ++out_.functions;
      return resolve_coincidence(curves_, {i, j, k}, {pair(pairs[0]), pair(pairs[1]), pair(pairs[2])}, s_.roots);
    }
    // If two curves touch for all tau without crossing each other, they meet the third curve at the same tau, and no
    // crossing becomes a vertex or ceases to be one.
    if (pairs[0] < 0 || pairs[1] < 0 || pairs[2] < 0) return true;
    if (!find_roots(function_, s_.roots)) return false;
    for (const Root& root : s_.roots) {
      add_event(pairs[0], root, k);
      add_event(pairs[1], root, j);
      add_event(pairs[2], root, i);
    }
    return true;
  }
  bool add_cut_triple(std::size_t circle, std::size_t other) {
    const std::size_t cut = cut_of_[circle];
    concurrence(curves_[circle], curves_[cut], curves_[other], function_);
    if (is_zero(function_)) return false;
    if (!find_roots(function_, s_.roots)) return false;
    for (const Root& root : s_.roots) {
      add_event(pair_of(circle, other), root, cut);
      add_event(pair_of(circle, cut), root, other);
    }
    return true;
  }

  std::vector<BoundaryCurve>& curves_;
  std::size_t count_;  ///< number of curves, not counting cuts
  Signs conics_ = 0;   ///< set of the curves that are general conics
  const SliceFormula& formula_;
  const NecessaryConstraints& necessary_;
  Decomposition& out_;
  DecompositionScratch& s_;
  /// For each curve that is a circle, the index in curves_ of its cut; 0 for a line.
  std::array<std::size_t, kMaxCurves> cut_of_{};
  Sampled function_;
};

}  // namespace

Place sample_place(double low, double high) {
  const Samples& nodes = chebyshev_nodes();
  const double middle = 0.5 * (low + high);
  auto at = std::ranges::lower_bound(nodes, middle, std::greater<>());
  if (at == nodes.end() || (at != nodes.begin() && at[-1] - middle < middle - *at)) --at;
  if (std::fabs(*at - middle) <= 0.3 * (high - low)) return {*at, static_cast<std::size_t>(at - nodes.begin())};
  return {middle, kNodes};
}

bool find_events(std::vector<BoundaryCurve>& curves, std::size_t count, const SliceFormula& formula,
                 const NecessaryConstraints& necessary, Decomposition& result, DecompositionScratch& scratch) {
  return EventFinder(curves, count, formula, necessary, result, scratch).run();
}

}  // namespace pkm::generic::corner_curves
