// The pieces of an outer coordinate on which sections keep their formulas.
//
// The measure of a section is smooth in the outer coordinate while its structure stays the same. Breaks with a closed
// form are listed first; the structure's signature is then sampled between them, and each change that is seen is
// followed to the last bits. Breaks move with the design: a closed form carries its derivative along, the others have
// that of an implicit function, which is the mechanism's to tell. Where the measure jumps, the break must have a closed
// form.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "engine/math/quadrature.hpp"

namespace pkm {

/// A break: where, and on which sides the measure behaves like a square root.
template <class S>
struct Break {
  S at;
  bool root_below = false;
  bool root_above = false;
};

/// Where f(p, t(p)) = 0 with its derivatives by the design p, those of an implicit function: t' = -f' / (df/dt).
/// @param f     there; its value does not count
/// @param by_t  df/dt; where it is 0 nothing says how t moves
template <class S>
S moving_zero(double t, const S& f, double by_t) {
  return std::fabs(by_t) > 0 ? S(t - (f - value_of(f)) / by_t) : S(t);
}

/// Fills `pieces` with those parts between the first and the last break on which sections are not empty.
/// @param breaks      both ends of the outer coordinate and known breaks, in order
/// @param near        breaks nearer than this are one
/// @param roots_join  whether a piece goes on beyond a break with a root where the signature does not change
/// @param changes     changes(low, high, split) returns the signature below `high`, false for an empty section, and
///                    calls split(break, signature below it) wherever it changes between, in order
template <class Signature, class S, class Changes>
void find_pieces(const std::vector<Break<S>>& breaks, double near, bool roots_join, const Changes& changes,
                 std::vector<Piece<S>>& pieces) {
  pieces.clear();
  if (breaks.empty()) return;
  Signature before{};  // of the piece before
  Break<S> from = breaks.front();
  const auto split = [&](const Break<S>& to, const Signature& now) {
    const bool joins = !pieces.empty() && now == before && value_of(pieces.back().upper) == value_of(from.at) &&
                       (roots_join || !(from.root_below || from.root_above));
    if (now && joins) {
      pieces.back().upper = to.at;
      pieces.back().root_upper = to.root_below;
    } else if (now) {
      pieces.push_back({from.at, to.at, from.root_above, to.root_below});
    }
    before = now;
    from = to;
  };
  for (std::size_t i = 1; i < breaks.size(); ++i) {
    const Break<S>& to = breaks[i];
    const double low = value_of(from.at), high = value_of(to.at);
    if (high - low < near) {
      from.root_above = from.root_above || to.root_above;
      if (!pieces.empty() && value_of(pieces.back().upper) == low)
        pieces.back().root_upper = pieces.back().root_upper || to.root_below;
      continue;
    }
    split(to, changes(low, high, split));
  }
}

/// The same where nothing but the signature tells where it changes: it is sampled, and halving does the rest.
/// @param breaks     in any order; sorted
/// @param signature  of the section at a value of the outer coordinate, 0: empty
/// @param moving     gives a break that was found its derivatives
/// @param samples    of the signature over the whole range
template <class S, class Signature, class Moving>
void find_pieces(std::vector<Break<S>>& breaks, const Signature& signature, const Moving& moving, int samples,
                 std::vector<Piece<S>>& pieces) {
  pieces.clear();
  if (breaks.empty()) return;
  std::sort(breaks.begin(), breaks.end(),
            [](const Break<S>& a, const Break<S>& b) { return value_of(a.at) < value_of(b.at); });
  const double whole = value_of(breaks.back().at) - value_of(breaks.front().at);
  if (!(whole > 0)) return;
  const auto changes = [&](double low, double high, const auto& split) {
    const double length = high - low;
    const int steps = std::max(1, static_cast<int>(std::ceil(samples * length / whole)));
    const double inset = std::min(0.25 * length, 1e-7 * whole);  // off the breaks, where rounding decides
    double at = low + inset;
    std::uint64_t now = signature(at);
    for (int k = 1; k <= steps; ++k) {
      const double next = k == steps ? high - inset : low + length * (k / static_cast<double>(steps));
      const std::uint64_t then = signature(next);
      for (int more = 0; more < 8 && now != then; ++more) {  // several breaks may lie between two samples
        double same = at, other = next;
        while (other - same > 1e-15 * (whole + std::fabs(other))) {
          const double middle = 0.5 * (same + other);
          (signature(middle) == now ? same : other) = middle;
        }
        split(Break<S>{moving(other), true, true}, now);
        at = other;
        now = signature(at);
      }
      at = next;
      now = then;
    }
    return now;
  };
  find_pieces<std::uint64_t>(breaks, 1e-13 * whole, true, changes, pieces);
}

}  // namespace pkm
