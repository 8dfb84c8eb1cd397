// Hybrid robot: exact volume, and weighted samples, by quadrature over beta of closed-form x-z sections.
#pragma once

#include <algorithm>
#include <type_traits>

#include "engine/math/pieces.hpp"
#include "engine/mechanisms/hybrid_strips.hpp"

namespace pkm::hybrid {

/// A section of a design without derivatives.
struct Sample {
  double beta = 0;
  Section<double> section;
  Structure structure;
  long asked = 0;  ///< when, last
};

/// The last samples that were asked for.
class Samples {
 public:
  void clear() {
    for (Sample& sample : sample_) sample.asked = 0;
  }
  /// It stays until three others have been asked for since.
  const Sample& at(const Frame<double>& f, double beta) {
    const auto known = [&](const Sample& sample) { return sample.asked > 0 && sample.beta == beta; };
    auto sample = std::ranges::find_if(sample_, known);
    if (sample == sample_.end()) {
      sample = std::ranges::min_element(sample_, {}, &Sample::asked);
      sample->beta = beta;
      sample->section = section(f, beta);
      find_strips(sample->section, scratch_, sample->structure);
    }
    sample->asked = ++now_;
    return *sample;
  }

 private:
  std::array<Sample, 4> sample_;
  StripScratch scratch_;
  long now_ = 0;
};

/// What is known of a piece of beta.
struct Followed {
  Structure structure;  ///< at the last beta asked for
  long asked = 0;
  bool keeps = true;  ///< its structure is the same wherever it was searched for
};

/// Storage that surveys reuse.
template <class S>
struct ColumnScratch {
  std::vector<Break<S>> breaks;
  std::vector<Piece<S>> pieces;
  std::vector<Followed> followed;  ///< per piece
  std::vector<Integral<S>> integrals;
  Samples samples;
  StripScratch strips;
  Structure structure;
};

/// Fills scratch.structure. Within a piece the structure is followed from one beta to the next; it is searched for at
/// the first of them and in the middle of every 15 nodes, and always once it is another one there.
template <class S>
void find_structure(const Section<double>& s, double beta, ColumnScratch<S>& scratch) {
  const auto piece = std::ranges::find_if(
      scratch.pieces, [&](const Piece<S>& p) { return value_of(p.lower) < beta && beta < value_of(p.upper); });
  Followed* known = piece == scratch.pieces.end()
                        ? nullptr
                        : &scratch.followed[static_cast<std::size_t>(piece - scratch.pieces.begin())];
  constexpr long kNodes = KronrodRule::kNodes;
  const bool search = !known || !known->keeps || known->asked == 0 || known->asked % kNodes == kNodes / 2;
  if (known) ++known->asked;
  if (!search && follow_strips(s, known->structure)) {
    scratch.structure = known->structure;
    return;
  }
  find_strips(s, scratch.strips, scratch.structure);
  if (!known) return;
  known->keeps = known->keeps && (known->asked == 1 || scratch.structure.signature == known->structure.signature);
  known->structure = scratch.structure;
}

/// The section at a beta, its strips in scratch.structure.
template <class S>
Section<S> section_of(const Frame<S>& f, const S& beta, ColumnScratch<S>& scratch) {
  Section<S> s = section(f, beta);
  if constexpr (std::is_same_v<S, double>)
    find_structure(s, beta, scratch);
  else
    find_structure(values(s), value_of(beta), scratch);
  return s;
}

/// What happens to a section at a break: two heights meet, or two edges at a height.
struct Event {
  StripEnd first, second;
  bool across = false;  ///< `left` and `right` meet at `first`; `second` means nothing
  Edge left, right;
};

/// The curve that begins or ends at an end of z, where its root is 0; kCurves: none.
inline std::size_t tip(const StripEnd& end) {
  if (end.kind == StripEnd::Kind::hole) return kCurveH;
  if (end.kind == StripEnd::Kind::meeting) return kCurves;
  if (end.index == kEndP1 || end.index == kEndP2) return kCurveP;
  if (end.index == kEndL && end.kind == StripEnd::Kind::upper) return kCurveL;
  return end.index == kEndQ && end.kind == StripEnd::Kind::lower ? std::size_t{kCurveQ} : std::size_t{kCurves};
}

/// x of an edge at an end of z, where a root of the section may begin.
template <class S>
S edge_at_end(const Section<S>& s, const Edge& edge, const StripEnd& end) {
  return edge.curve == tip(end) ? S(0.0) : edge_at(s, edge, height(s, end));
}

/// How far the two are apart: 0 at the break.
template <class S>
S distance(const Section<S>& s, const Event& event) {
  if (event.across) return edge_at_end(s, event.right, event.first) - edge_at_end(s, event.left, event.first);
  return height(s, event.second) - height(s, event.first);
}

/// The event between two sections that have different structures; false: nothing is seen to meet.
/// @param least  a strip that begins or ends between them is shorter [m]
inline bool find_event(const Sample& lower, const Sample& upper, double least, Event& event) {
  using Kind = StripEnd::Kind;
  const Section<double>&s = lower.section, &t = upper.section;
  const Structure &below = lower.structure, &above = upper.structure;
  const auto end = [&](Kind kind, std::size_t index) {
    const double z = kind == Kind::lower ? s.lower[index] : kind == Kind::upper ? s.upper[index] : s.hole_end;
    return StripEnd{z, kind, static_cast<std::uint8_t>(index), {}, {}};
  };
  const auto changes = [&](const Event& candidate) {
    return (distance(s, candidate) >= 0) != (distance(t, candidate) >= 0);
  };
  const StripEnd low = end(Kind::lower, below.lower), high = end(Kind::upper, below.upper), hole = end(Kind::hole, 0);
  const auto take = [&](const Event& candidate) {
    event = candidate;
    return true;
  };
  if (below.lower != above.lower) return take({low, end(Kind::lower, above.lower), false, {}, {}});
  if (below.upper != above.upper) return take({high, end(Kind::upper, above.upper), false, {}, {}});
  for (const StripEnd& other : {high, hole})
    if (const Event closes{low, other, false, {}, {}}; changes(closes)) return take(closes);
  if (const Event covers{hole, high, false, {}, {}}; hole.z > low.z && changes(covers)) return take(covers);
  for (const StripEnd& at : {low, high, hole}) {
    if (at.z < low.z || at.z > high.z) continue;
    std::array<Edge, 2 * kCurves> edge;
    std::array<double, 2 * kCurves> in_s, in_t;
    for (std::size_t k = 0; k < edge.size(); ++k) {
      edge[k] = {static_cast<std::uint8_t>(k / 2), static_cast<std::uint8_t>(k % 2)};
      in_s[k] = edge_at_end(s, edge[k], at);
      in_t[k] = edge_at_end(t, edge[k], at);
    }
    for (std::size_t i = 0; i < edge.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        if ((in_s[i] >= in_s[j]) == (in_t[i] >= in_t[j])) continue;
        const bool apart = edge[j].curve >= kCurveQ && edge[i].curve >= kCurveQ && edge[i].side != edge[j].side;
        if (!apart) return take({at, {}, true, edge[j], edge[i]});  // the chain's -x and x never meet but at a tip
      }
  }
  bool closes = false;
  const auto closes_from = [&](const Structure& here, const Structure& there) {
    for (const Strip& strip : here.strips) {
      const bool stays = std::ranges::any_of(there.strips, [&](const Strip& of) { return alike(of, strip); });
      if (stays || strip.to.z - strip.from.z >= least) continue;
      least = strip.to.z - strip.from.z;
      event = {strip.from, strip.to, false, {}, {}};
      closes = true;
    }
  };
  closes_from(below, above);
  closes_from(above, below);
  return closes;
}

/// Whether an event's heights are known in a sample: where edges meet, that is where the strip is.
inline bool knows(const Sample& sample, const Event& event) {
  const auto has = [&](const StripEnd& end) {
    return end.kind != StripEnd::Kind::meeting || std::ranges::any_of(sample.structure.strips, [&](const Strip& s) {
             return s.from.z == end.z || s.to.z == end.z;
           });
  };
  return has(event.first) && (event.across || has(event.second));
}

/// Newton step towards an event. Where the same two edges meet twice, the heights' distance goes like a square root.
inline double newton_step(const Event& event, const Dual<1>& apart) {
  const StripEnd &p = event.first, &q = event.second;
  const bool same = (p.first == q.first && p.second == q.second) || (p.first == q.second && p.second == q.first);
  const bool touch = !event.across && p.kind == StripEnd::Kind::meeting && q.kind == p.kind && same;
  return -apart.a / apart.v[0] * (touch ? 0.5 : 1);
}

/// A break of the structure with its derivatives. With a and b the two that meet there, a(p, beta(p)) = b(p, beta(p))
/// gives beta' = -(d(a - b)/dp) / (d(a - b)/dbeta). Which they are, and that quotient, show a little beside the break;
/// a Newton step ends at it.
/// @param still         the same design with derivatives by beta only
/// @param below, above  samples on both sides
template <class S>
S moving_break(const Frame<S>& f, const Frame<Dual<1>>& still, double at, const Sample& below, const Sample& above) {
  Event event;
  const double near = 1e-3 * below.section.upper[below.structure.upper];
  if (!find_event(below, above, near, event)) return S(at);
  // from the sample that is further off: what is next to nothing has few digits
  const auto off = [&](const Sample& s) { return knows(s, event) ? std::fabs(distance(s.section, event)) : -1; };
  const double beta = (off(below) < off(above) ? above : below).beta;
  const Dual<1> apart = distance(section(still, Dual<1>::variable(beta, 0)), event);
  const double step = newton_step(event, apart);
  if (!(std::fabs(step) <= 4 * (above.beta - below.beta))) return S(at);
  if constexpr (std::is_same_v<S, double>) {
    return beta + step;
  } else {
    const S by_design = distance(section(f, S(beta)), event);
    return S(beta + step) - (by_design - value_of(by_design)) / apart.v[0];
  }
}

/// Fills scratch.pieces. Every decision depends on values only.
/// @param plain, still  the same design without derivatives
template <class S>
void find_outer_pieces(const Frame<S>& f, const Frame<double>& plain, const Frame<Dual<1>>& still,
                       ColumnScratch<S>& scratch) {
  constexpr int kSamples = 48;
  scratch.breaks.clear();
  scratch.pieces.clear();
  if (f.empty) return;
  scratch.breaks.push_back({f.l.beta_min});
  scratch.breaks.push_back({f.l.beta_max});
  scratch.samples.clear();
  const auto sample = [&](double beta) -> const Sample& { return scratch.samples.at(plain, beta); };
  constexpr double kWidth = 1e-10;
  const double beside = 50 * kWidth * (plain.l.beta_max - plain.l.beta_min);
  const auto moving = [&](double, double at) {
    const Sample& below = sample(at - beside);
    return moving_break(f, still, at, below, sample(at + beside));
  };
  constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
  const auto guess = [&](double low, double high) {
    const Sample &below = sample(low), &above = sample(high);
    Event event;
    if (!find_event(below, above, plain.z_high, event)) return kNowhere;
    const bool in_below = knows(below, event), in_above = knows(above, event);
    if (!in_below && !in_above) return kNowhere;
    const bool nearer = std::fabs(distance(above.section, event)) < std::fabs(distance(below.section, event));
    const double from = in_above && (nearer || !in_below) ? high : low;
    const double step = newton_step(event, distance(section(still, Dual<1>::variable(from, 0)), event));
    // a long step that passes the break by a little ends where nothing more is known of it
    const double margin = std::fabs(step) > 1e-4 * (high - low) ? 0.02 * (high - low) : 0;
    return std::isfinite(step) ? std::clamp(from + step, low + margin, high - margin) : kNowhere;
  };
  find_pieces(
      scratch.breaks, [&](double beta) { return sample(beta).structure.signature; }, moving, guess, kSamples,
      scratch.pieces, kWidth);
  scratch.followed.resize(scratch.pieces.size());
  for (Followed& piece : scratch.followed) piece.asked = 0, piece.keeps = true;
}

/// Area of the section at a beta [m^2].
template <class S>
S area_at(const Frame<S>& f, const S& beta, ColumnScratch<S>& scratch) {
  const Section<S> s = section_of(f, beta, scratch);
  return area(s, scratch.structure);
}

/// What rounding leaves of the integral of area_at over the pieces [m^2 rad].
template <class S>
double roundoff(const Frame<S>& f, const std::vector<Piece<S>>& pieces) {
  if (pieces.empty()) return 0;
  double size = value_of(max(f.g.L1, max(f.g.L2, f.g.L3)));  // of the terms that the area is a difference of
  for (std::size_t i = 0; i < 3; ++i) size += std::fabs(value_of(f.lo[i])) + std::fabs(value_of(f.hi[i]));
  return 4e-16 * size * value_of(f.z_high) * (value_of(pieces.back().upper) - value_of(pieces.front().lower));
}

/// Calls visit(z, length, weight) at the nodes of `rule` over z on every strip of the section: the exact length of the
/// column of x there.
template <class S, class Visit>
void visit_columns(const Frame<S>& f, const S& beta, const GaussRule& rule, ColumnScratch<S>& scratch,
                   const Visit& visit) {
  const Section<S> s = section_of(f, beta, scratch);
  for (const Strip& strip : scratch.structure.strips) {
    const Piece<S> piece{height(s, strip.from), height(s, strip.to), true, true};
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const auto [z, jacobian] = map_node(piece, rule.node[i]);
      visit(z, S(edge_at(s, strip.right, z) - edge_at(s, strip.left, z)), S(jacobian * rule.weight[i]));
    }
  }
}

}  // namespace pkm::hybrid
