#include "engine/accelerators/hybrid/critical_values.hpp"

#include <algorithm>
#include <cmath>

namespace pkm::hybrid {
namespace {

/// A strip that is there on one side of a break only: its ends meet, or, if the same two edges meet at both, touch.
Event closing(const Strip& strip) {
  const StripEnd &p = strip.from, &q = strip.to;
  const bool same = (p.first == q.first && p.second == q.second) || (p.first == q.second && p.second == q.first);
  const bool touch = p.kind == StripEnd::Kind::meeting && q.kind == p.kind && same;
  return {.kind = touch ? Event::Kind::touch : Event::Kind::heights,
          .first = p,
          .second = q,
          .left = p.first,
          .right = p.second};
}

/// The event between two sections that have different structures; false: nothing is seen to meet.
bool find_event(const Sample& lower, const Sample& upper, Event& event) {
  using Kind = StripEnd::Kind;
  const Section<double>&s = lower.section, &t = upper.section;
  const Structure &below = lower.structure, &above = upper.structure;
  const auto changes = [&](const Event& candidate) {
    return (distance(s, candidate) >= 0) != (distance(t, candidate) >= 0);
  };
  const StripEnd low = end_of_z(s, Kind::lower, below.lower), high = end_of_z(s, Kind::upper, below.upper),
                 hole = end_of_z(s, Kind::hole);
  const auto take = [&](const Event& candidate) {
    event = candidate;
    return true;
  };
  if (below.lower != above.lower) return take({Event::Kind::heights, low, end_of_z(s, Kind::lower, above.lower)});
  if (below.upper != above.upper) return take({Event::Kind::heights, high, end_of_z(s, Kind::upper, above.upper)});
  for (const StripEnd& other : {high, hole})
    if (const Event closes{Event::Kind::heights, low, other}; changes(closes)) return take(closes);
  if (const Event covers{Event::Kind::heights, hole, high}; hole.z > low.z && changes(covers)) return take(covers);
  for (const StripEnd& at : {low, high, hole}) {
    if (at.z < low.z || at.z > high.z) continue;
    std::array<Edge, kSides * kCurves> edge;
    std::array<double, kSides * kCurves> in_s, in_t;
    for (std::size_t k = 0; k < edge.size(); ++k) {
      edge[k] = {static_cast<std::uint8_t>(k / kSides), static_cast<Side>(k % kSides)};
      in_s[k] = edge_at_end(s, edge[k], at);
      in_t[k] = edge_at_end(t, edge[k], at);
    }
    for (std::size_t i = 0; i < edge.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        if ((in_s[i] >= in_s[j]) == (in_t[i] >= in_t[j])) continue;
        const bool apart = edge[j].curve >= kCurveQ && edge[i].curve >= kCurveQ && edge[i].side != edge[j].side;
        if (!apart)
          // the chain's -x and x never meet but at a tip
          return take({.kind = Event::Kind::edges, .first = at, .left = edge[j], .right = edge[i]});
      }
  }
  // the shortest strip that is not there on the other side, preferably one between two edges that no strip is between
  // there; others may just end elsewhere
  bool closes = false;
  double least = std::numeric_limits<double>::infinity();
  const auto closes_from = [&](const Structure& here, const Structure& there, const auto& same) {
    for (const Strip& strip : here.strips) {
      const bool stays = std::ranges::any_of(there.strips, [&](const Strip& of) { return same(of, strip); });
      if (stays || strip.to.z - strip.from.z >= least) continue;
      least = strip.to.z - strip.from.z;
      event = closing(strip);
      closes = true;
    }
  };
  const auto same_edges = [](const Strip& p, const Strip& q) { return p.left == q.left && p.right == q.right; };
  const auto same_ends = [](const Strip& p, const Strip& q) { return alike(p, q); };
  closes_from(below, above, same_edges);
  closes_from(above, below, same_edges);
  if (closes) return true;
  closes_from(below, above, same_ends);
  closes_from(above, below, same_ends);
  return closes;
}

/// Whether an event's heights are known in a sample: where edges meet, that is where the strip is.
bool knows(const Sample& sample, const Event& event) {
  const auto has = [&](const StripEnd& end) {
    return end.kind != StripEnd::Kind::meeting || std::ranges::any_of(sample.structure.strips, [&](const Strip& s) {
             return s.from.z == end.z || s.to.z == end.z;
           });
  };
  return event.kind == Event::Kind::edges || (has(event.first) && has(event.second));
}

/// x of an edge at a height, and its first two derivatives by z, with derivatives by beta.
struct Bent {
  Dual<1> x, slope;
  double bend;
};
Bent bent(const Section<Dual<1>>& s, const Edge& edge, double z) {
  const Curve<Dual<1>>& c = s.curve[edge.curve];
  const Dual<1> root = c.root(z), slope = c.slope(z, root);
  const double sign = s.sign(edge);
  return {s.constant(edge) + root * sign, slope * sign, sign * (value_of(c.curvature()) - slope.a * slope.a) / root.a};
}

/// A step of Newton's method for the height where two edges meet, with its derivative by beta.
Dual<1> moved(const Section<Dual<1>>& s, const StripEnd& end) {
  if (end.kind != StripEnd::Kind::meeting) return height(s, end);
  const Bent first = bent(s, end.first, end.z), second = bent(s, end.second, end.z);
  return end.z - (second.x - first.x) / (second.slope.a - first.slope.a);
}

/// A step of Newton's method towards an event, in beta and the heights of meetings.
/// @return  the step in beta
double step_towards(const Section<Dual<1>>& s, Event& event) {
  if (event.kind == Event::Kind::edges) {
    const Dual<1> apart = distance(s, event);
    return -apart.a / apart.v[0];
  }
  if (event.kind == Event::Kind::heights) {
    const Dual<1> first = moved(s, event.first), second = moved(s, event.second), apart = second - first;
    const double along = -apart.a / apart.v[0];
    event.first.z = first.a + first.v[0] * along;
    event.second.z = second.a + second.v[0] * along;
    return along;
  }
  // a touch: both the distance of the edges and its slope are 0
  const Bent left = bent(s, event.left, event.first.z), right = bent(s, event.right, event.first.z);
  const Dual<1> apart = right.x - left.x, slope = right.slope - left.slope;
  const double bend = right.bend - left.bend, determinant = apart.v[0] * bend - slope.a * slope.v[0];
  event.first.z += (slope.v[0] * apart.a - apart.v[0] * slope.a) / determinant;
  return (slope.a * slope.a - bend * apart.a) / determinant;
}

/// Goes from a beta near it to an event between two beta; false: none is found.
/// @param width  of the last step: the one after it is below rounding
bool approach(const Frame<Dual<1>>& still, double lower, double upper, double width, double& beta, Event& event) {
  if (event.kind == Event::Kind::touch) event.first.z = 0.5 * (event.first.z + event.second.z);
  for (int step = 0; step < 12; ++step) {
    const double along = step_towards(section(still, Dual<1>::variable(beta, 0)), event);
    beta += along;
    if (!(beta > lower && beta < upper)) return false;
    if (std::fabs(along) < width) return true;
  }
  return false;
}

class Search {
 public:
  Search(const Frame<double>& plain, const Frame<Dual<1>>& still, BreakScratch& scratch)
      : plain_(plain), still_(still), scratch_(scratch) {
    constexpr std::size_t kSamples = 192;  // gaps may be as narrow
    const double low = plain.l.beta_min, high = plain.l.beta_max;
    scratch_.count = 0;
    whole_ = high - low;
    if (plain.empty || !(whole_ > 0)) return;
    beside_ = 1e-7 * whole_;
    used_ = 2;  // the first two are for the neighbours here
    search(low + beside_, slot(0));
    begin(low, {}, slot(0));
    for (std::size_t k = 1; k <= kSamples; ++k) {
      const Sample &before = slot((k - 1) % 2), &next = slot(k % 2);
      search(k == kSamples ? high - beside_ : low + whole_ * (static_cast<double>(k) / kSamples), slot(k % 2));
      explore(before, next, kDepth);
    }
    end(high, {});
  }

 private:
  static constexpr int kDepth = 60;

  Sample& slot(std::size_t i) {
    while (scratch_.samples.size() <= i) scratch_.samples.emplace_back();
    return scratch_.samples[i];
  }
  void search(double beta, Sample& s) {
    s.beta = beta;
    s.section = section(plain_, beta);
    find_strips(s.section, scratch_.strips, s.structure);
  }
  const Sample& sample(double beta) {
    Sample& s = slot(used_++);
    search(beta, s);
    return s;
  }

  /// A stretch begins at a break: the sample is just above.
  void begin(double at, const std::optional<Event>& event, const Sample& above) {
    open_ = !above.structure.strips.empty();
    if (!open_) return;
    if (scratch_.count == scratch_.stretches.size()) scratch_.stretches.emplace_back();
    Stretch& s = scratch_.stretches[scratch_.count++];
    s.lower = at;
    s.at_lower = event;
    s.structure = above.structure;
  }
  void end(double at, const std::optional<Event>& event) {
    if (!open_) return;
    Stretch& s = scratch_.stretches[scratch_.count - 1];
    s.upper = at;
    s.at_upper = event;
  }

  /// Finds the breaks between two samples.
  void explore(const Sample& low, const Sample& high, int depth) {
    if (alike(low.structure, high.structure)) return;
    const double length = high.beta - low.beta;
    if (!(length > 1e-10 * whole_) || depth == 0) {
      const double at = 0.5 * (low.beta + high.beta);
      end(at, {});
      begin(at, {}, high);
      return;
    }
    const std::size_t used = used_;
    Event event;
    double at;
    if (!locate(low, high, event, at)) {
      const Sample& middle = sample(0.5 * (low.beta + high.beta));
      explore(low, middle, depth - 1);
      explore(middle, high, depth - 1);
      used_ = used;
      return;
    }
    const double beside = std::fmin(beside_, 0.1 * length);
    const Sample& below = at - beside > low.beta ? sample(at - beside) : low;
    const Sample& above = at + beside < high.beta ? sample(at + beside) : high;
    explore(low, below, depth - 1);
    if (!alike(below.structure, above.structure)) {
      end(at, event);
      begin(at, event, above);
    }
    explore(above, high, depth - 1);
    used_ = used;
  }

  bool locate(const Sample& low, const Sample& high, Event& event, double& at) const {
    if (!find_event(low, high, event)) return false;
    const auto off = [&](const Sample& s) {
      return knows(s, event) ? std::fabs(distance(s.section, event)) : std::numeric_limits<double>::infinity();
    };
    at = (off(low) < off(high) ? low : high).beta;
    return approach(still_, low.beta, high.beta, 1e-9 * whole_, at, event);
  }

  const Frame<double>& plain_;
  const Frame<Dual<1>>& still_;
  BreakScratch& scratch_;
  double whole_ = 0, beside_ = 0;
  std::size_t used_ = 0;
  bool open_ = false;
};

}  // namespace

void find_stretches(const Frame<double>& plain, const Frame<Dual<1>>& still, BreakScratch& scratch) {
  Search(plain, still, scratch);
}

}  // namespace pkm::hybrid
