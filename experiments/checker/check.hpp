// Independent checker, by interval arithmetic, of proofs of volume bounds that `pkmopt certify --proof` wrote. It
// shares only the formula parser and the interval type with pkmopt. The format of proofs is described in README.md.
#pragma once

#include <algorithm>
#include <bitset>
#include <charconv>
#include <stdexcept>
#include <system_error>

#include "engine/expression/formula_lexer.hpp"
#include "engine/expression/formula_parser.hpp"
#include "experiments/checker/evaluate.hpp"

namespace pkm::checker {

inline constexpr std::size_t kMaxConditions = 128;
inline constexpr std::int64_t kSteps = std::int64_t{1} << 30;  // grid steps over the range of the last axis

/// The proof is wrong. Every other exception means that it could not be checked.
struct InvalidProof : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// An interval of the last axis, over the current box of the outer axes.
struct Segment {
  std::int64_t from, to;             ///< in grid steps
  std::bitset<kMaxConditions> open;  ///< undecided conditions; all others hold
};

class Check {
 public:
  explicit Check(std::string text) : text_(std::move(text)) {}

  /// Returns the message of acceptance. Throws InvalidProof.
  std::string run() {
    read_head();
    inputs_.insert(inputs_.begin(), ranges_.size(), Interval(0.0));
    std::bitset<kMaxConditions> open;
    for (std::size_t k = 0; k < conditions_.size(); ++k) open.set(k);
    check_box(ranges_, {{0, kSteps, open}}, Interval(0.0), 0);
    if (line() != "end") refuse("'end' is expected after the boxes");
    if (position_ != text_.size()) refuse("unexpected text after 'end'");
    if (!(total_.lower >= lower_)) refuse("the lower bound is not proven: found " + number(total_.lower));
    if (!(total_.upper <= upper_)) refuse("the upper bound is not proven: found " + number(total_.upper));
    return "accepted: the volume is between " + number(lower_) + " and " + number(upper_) + ", by " +
           std::to_string(boxes_) + " boxes\n";
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw InvalidProof("line " + std::to_string(line_) + ": " + why);
  }
  static std::string number(double x) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, x).ptr};
  }
  /// The next line.
  std::string line() {
    const std::size_t end = text_.find('\n', position_);
    if (end == std::string::npos) refuse("the proof ends too early");
    std::string found = text_.substr(position_, end - position_);
    position_ = end + 1;
    ++line_;
    return found;
  }
  /// Removes the first word of a line.
  std::string word(std::string& rest) const {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    const std::string found = rest.substr(0, end);
    rest.erase(0, std::min(end + 1, rest.size()));
    if (found.empty()) refuse("a word is missing");
    return found;
  }
  double real(std::string& rest) const {
    const std::string text = word(rest);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
      refuse("'" + text + "' is not a finite number");
    return value;
  }
  void expect_end(const std::string& rest) const {
    if (!rest.empty()) refuse("found '" + rest + "'; expected the end of the line");
  }
  void add_name(const std::string& name, expression::Node node) {
    if (!expression::may_be_name(name) || names_.find(name)) refuse("'" + name + "' is not a valid new name");
    names_.add(name);
    nodes_.push_back(node);
  }
  expression::Node named(const std::string& name) const {
    const auto index = names_.find(name);
    if (!index) refuse("'" + name + "' is undefined");
    return nodes_[*index];
  }
  expression::Node formula(const std::string& text) {
    try {
      return expression::read_formula(graph_, text, names_, nodes_);
    } catch (const std::invalid_argument& reason) {
      refuse(reason.what());
    }
  }

  /// Reads the statement: everything before the boxes.
  void read_head() {
    if (line() != "pkmopt proof 1") refuse("'pkmopt proof 1' is expected");
    std::vector<expression::Node> roots;
    bool has_volume = false;
    for (std::string rest = line(); rest != "boxes"; rest = line()) {
      if (rest.starts_with('#')) continue;
      const std::string kind = word(rest);
      if (kind == "volume" && !has_volume) {
        lower_ = real(rest);
        upper_ = real(rest);
        expect_end(rest);
        has_volume = true;
      } else if (kind == "axis" && ranges_.size() < kMaxAxes && inputs_.empty() && roots.empty()) {
        add_name(word(rest), graph_.input(ranges_.size()));
        const double from = real(rest), to = real(rest);
        expect_end(rest);
        if (!(from < to)) refuse("the range is empty");
        // positions from + (to - from) * fraction must be finite
        if (!std::isfinite(to - from)) refuse("the range is too long: to - from overflows");
        ranges_.push_back({from, to});
      } else if (kind == "given") {
        const std::string name = word(rest);
        const double from = real(rest), to = real(rest);
        if (!(from <= to)) refuse("the range is empty");
        add_name(name, graph_.input(ranges_.size() + inputs_.size()));
        inputs_.push_back({from, to});
      } else if (kind == "let") {
        const std::string name = word(rest);
        if (word(rest) != "=") refuse("'=' is expected");
        add_name(name, formula(rest));
      } else if (kind == "turn") {
        const std::string name = word(rest);
        const expression::Node angle = named(word(rest));
        expect_end(rest);
        add_name(name, graph_.apply(expression::angle_wrapping(), std::array{angle}));
      } else if (kind == "condition" && roots.size() < kMaxConditions) {
        roots.push_back(named(word(rest)));
      } else {
        refuse("unexpected '" + kind + "'");
      }
    }
    if (!has_volume || ranges_.empty() || roots.empty()) refuse("a volume, axis or condition is missing");
    // a constant that overflowed stands for an unknown real number
    for (const expression::Node node : graph_.reachable(roots))
      if (graph_[node].is_number() && !std::isfinite(graph_[node].number))
        refuse("a constant formula has no finite value");
    for (const expression::Node root : roots) conditions_.emplace_back(graph_, root);
  }

  /// The next character of the steps of a box.
  char letter() {
    if (position_ >= text_.size()) refuse("the proof ends too early");
    return text_[position_++];
  }
  /// The next integer of the steps, in [from, to].
  std::int64_t integer(std::int64_t from, std::int64_t to, char end = ' ') {
    std::int64_t value = 0;
    const char *const first = text_.data() + position_, *const last = text_.data() + text_.size();
    const auto [after, error] = std::from_chars(first, last, value);
    if (error != std::errc{} || after == last || *after != end) refuse("an integer is expected");
    if (value < from || value > to) refuse(std::to_string(value) + " is out of range");
    position_ += static_cast<std::size_t>(after - first) + 1;
    return value;
  }
  /// Reads the index of an open condition.
  std::size_t open_condition(const Segment& segment) {
    const auto k = static_cast<std::size_t>(integer(0, static_cast<std::int64_t>(conditions_.size()) - 1));
    if (!segment.open[k]) refuse("condition " + std::to_string(k) + " is not open");
    return k;
  }

  using Ranges = std::vector<std::array<double, 2>>;  ///< [from, to] of each axis

  /// Position of a grid point on the last axis.
  double position(std::int64_t step) const {
    const auto& [from, to] = ranges_.back();
    return step == kSteps ? to : from + (to - from) * (static_cast<double>(step) / static_cast<double>(kSteps));
  }
  Interval length(const Segment& segment) const {
    return Interval(position(segment.to)) - Interval(position(segment.from));
  }

  /// The root along the last axis of a condition that is monotonic in it, over the whole box.
  struct Root {
    bool increases;      ///< the condition holds above the root
    Interval enclosure;  ///< of the root at every point of the box
    Interval mean;       ///< of the mean of the root over the box
  };
  /// Encloses the root of a condition by the mean value theorem about z = `guess` (interval Newton step). If all
  /// derivatives exist, it is expanded about the centre of the box, which encloses the mean to second order.
  Root root_of(std::size_t k, std::int64_t guess) {
    const std::size_t z = ranges_.size() - 1;
    Jet jet;
    const auto known = conditions_[k].differentiate(inputs_, z + 1, jet);
    if (known == Evaluation::Known::nothing || jet.by[z].holds(0))
      refuse("condition " + std::to_string(k) + " is not proven to be monotonic");
    const std::vector<Interval> box = inputs_;
    inputs_[z] = Interval(position(guess));
    if (known == Evaluation::Known::along_last) {  // without expansion about the centre
      const Interval root = inputs_[z] - conditions_[k].value(inputs_) / jet.by[z];
      inputs_ = box;
      return {jet.by[z].lower > 0, root, root};
    }
    for (std::size_t axis = 0; axis < z; ++axis) inputs_[axis] = Interval(box[axis].middle());
    const std::vector<Interval> centre = inputs_;
    const Interval over_centre = centre[z] - conditions_[k].value(inputs_) / jet.by[z];
    Interval variation(0.0), spread(0.0);
    for (std::size_t axis = 0; axis < z; ++axis) {
      const Interval gradient = jet.by[axis] / jet.by[z];
      const Interval low(box[axis].lower), high(box[axis].upper), half(0.5);
      const Interval offset = (low + high) * half - centre[axis];  // of the exact centre from the rounded one
      const Interval width = (Interval(gradient.upper) - Interval(gradient.lower)) * half;
      variation = variation + gradient * (box[axis] - centre[axis]);
      spread = spread + width * (high - low) * Interval(0.25) + magnitude(gradient) * magnitude(offset);
    }
    inputs_ = box;
    return {jet.by[z].lower > 0, over_centre - variation, over_centre + Interval(-spread.upper, spread.upper)};
  }

  /// Checks the steps of a box of the outer axes, and recursively those of its halves.
  /// @param segments  those that are open in the parent box
  /// @param inside    length of the segments on which all conditions hold already
  void check_box(const Ranges& sides, std::vector<Segment> segments, Interval inside, std::size_t depth) {
    if (depth > 200) refuse("the boxes are bisected too often");
    Interval area(1.0), open_length(0.0);
    for (std::size_t axis = 0; axis + 1 < sides.size(); ++axis) {
      inputs_[axis] = {sides[axis][0], sides[axis][1]};
      area = area * (Interval(sides[axis][1]) - Interval(sides[axis][0]));
    }
    std::vector<Segment> left = merged(segments), open;
    std::reverse(left.begin(), left.end());
    while (!left.empty()) {
      const Segment segment = left.back();
      left.pop_back();
      check_segment(segment, left, open, inside, open_length);
    }
    const char kind = letter();
    if (kind == '.') {
      if (letter() != '\n') refuse("expected the end of the line");
      ++line_;
      ++boxes_;
      const Interval volume = area * (inside + open_length);
      total_ += Interval(std::max(volume.lower, 0.0), volume.upper);
      return;
    }
    if (kind != '/') refuse("'.' or '/' is expected");
    if (sides.size() < 2) refuse("there is no outer axis to bisect");
    const auto axis = static_cast<std::size_t>(integer(0, static_cast<std::int64_t>(sides.size()) - 2, '\n'));
    ++line_;
    const auto [from, to] = sides[axis];
    const double middle = 0.5 * (from + to);
    if (!(from < middle && middle < to)) refuse("the box is too small to bisect");
    for (const auto& half : {std::array{from, middle}, std::array{middle, to}}) {
      Ranges child = sides;
      child[axis] = half;
      check_box(child, open, inside, depth + 1);
    }
  }

  /// Merges adjacent segments with the same open conditions.
  static std::vector<Segment> merged(const std::vector<Segment>& segments) {
    std::vector<Segment> all;
    for (const Segment& segment : segments)
      if (!all.empty() && all.back().to == segment.from && all.back().open == segment.open)
        all.back().to = segment.to;
      else
        all.push_back(segment);
    return all;
  }

  /// Checks the steps of a segment until it is decided, split or left open.
  /// @param left  stack of the segments still to be checked
  void check_segment(Segment segment, std::vector<Segment>& left, std::vector<Segment>& open, Interval& inside,
                     Interval& open_length) {
    const auto push = [&left](std::int64_t from, std::int64_t to, const std::bitset<kMaxConditions>& conditions) {
      if (from < to) left.push_back({from, to, conditions});
    };
    const std::size_t z = ranges_.size() - 1;
    inputs_[z] = {position(segment.from), position(segment.to)};
    while (segment.open.any()) {
      const char kind = letter();
      if (kind == 'h' || kind == 'x') {
        const std::size_t k = open_condition(segment);
        const Interval value = conditions_[k].value(inputs_);
        if (!(kind == 'h' ? value.is_certified_satisfied() : value.is_certified_violated()))
          refuse("condition " + std::to_string(k) + " is not proven to " + (kind == 'h' ? "hold" : "fail"));
        if (kind == 'x') return;
        segment.open.reset(k);
      } else if (kind == 't') {
        const std::size_t k = open_condition(segment);
        const std::int64_t low = integer(segment.from, segment.to), high = integer(low, segment.to);
        const Root root = root_of(k, integer(segment.from, segment.to));
        if ((low > segment.from && !(root.enclosure.lower >= position(low))) ||
            (high < segment.to && !(root.enclosure.upper <= position(high))) || root.enclosure.is_empty())
          refuse("the root of condition " + std::to_string(k) + " may lie outside the given range");
        auto others = segment.open;
        others.reset(k);
        if (root.increases) push(high, segment.to, others);
        push(low, high, segment.open);
        if (!root.increases) push(segment.from, low, others);
        return;
      } else if (kind == 's') {
        const std::int64_t low = integer(segment.from, segment.to), high = integer(low, segment.to);
        for (const auto& [from, to] : {std::pair(high, segment.to), {low, high}, {segment.from, low}})
          push(from, to, segment.open);
        return;
      } else if (kind == 'n' || kind == 'r') {
        Interval feasible(0, length(segment).upper);
        if (kind == 'r') feasible = mean_length(segment, feasible);
        open_length += feasible;
        open.push_back(segment);
        return;
      } else {
        refuse(std::string("'") + kind + "' is not a step");
      }
    }
    inside += length(segment);
  }

  /// Mean over the box of the feasible length of a segment with one open condition, whose root lies in the segment.
  Interval mean_length(const Segment& segment, const Interval& bounds) {
    if (segment.open.count() != 1) refuse("more than one condition is open");
    std::size_t k = 0;
    while (!segment.open[k]) ++k;
    const Root root = root_of(k, integer(segment.from, segment.to));
    const Interval from(position(segment.from)), to(position(segment.to));
    if (!(root.enclosure.lower >= from.lower && root.enclosure.upper <= to.upper)) refuse("the root may lie outside");
    return intersection(root.increases ? to - root.mean : root.mean - from, bounds);
  }

  const std::string text_;
  std::size_t position_ = 0, line_ = 0, boxes_ = 0;  ///< position in the text, its line, number of leaf boxes
  double lower_ = 0, upper_ = 0;                     ///< claimed bounds of the volume
  expression::Graph graph_;
  expression::Names names_;
  std::vector<expression::Node> nodes_;
  std::vector<Interval> inputs_;  ///< of the graph: axes, then the given values
  Ranges ranges_;
  std::vector<Evaluation> conditions_;
  Interval total_{0.0};  ///< proven volume
};

}  // namespace pkm::checker
