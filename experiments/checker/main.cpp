// `pkmopt-check-proof FILE`: checks the proof of a volume's bounds that `pkmopt certify --proof` wrote, by interval
// arithmetic. It shares the reader of formulas and the intervals with the program, nothing else; README.md has the
// format.

#include <algorithm>
#include <bitset>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <iostream>
#include <memory>
#include <system_error>

#include "engine/graph/formula_reader.hpp"
#include "engine/graph/formula_words.hpp"
#include "experiments/checker/evaluate.hpp"

namespace pkm::checker {
namespace {

constexpr std::size_t kMostConditions = 128;
constexpr std::int64_t kSteps = std::int64_t{1} << 30;  // of heights along the last axis

/// Why a proof is wrong. Every other exception means that it could not be checked.
struct Refusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Segment {
  std::int64_t from, to;
  std::bitset<kMostConditions> open;
};

class Check {
 public:
  explicit Check(std::string text) : text_(std::move(text)) {}

  std::string run() {
    read_head();
    inputs_.insert(inputs_.begin(), ranges_.size(), Interval(0.0));
    std::bitset<kMostConditions> open;
    for (std::size_t k = 0; k < conditions_.size(); ++k) open.set(k);
    check_box(ranges_, {{0, kSteps, open}}, Interval(0.0), 0);
    if (line() != "end") refuse("'end' is expected after the boxes");
    if (place_ != text_.size()) refuse("there is something after 'end'");
    if (!(total_.lower >= lower_)) refuse("the volume proved is " + number(total_.lower) + " at least, which is less");
    if (!(total_.upper <= upper_)) refuse("the volume proved is " + number(total_.upper) + " at most, which is more");
    return "accepted: the volume is between " + number(lower_) + " and " + number(upper_) + ", by " +
           std::to_string(boxes_) + " boxes\n";
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw Refusal("line " + std::to_string(line_) + ": " + why);
  }
  static std::string number(double x) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, x).ptr};
  }
  std::string line() {
    const std::size_t end = text_.find('\n', place_);
    if (end == std::string::npos) refuse("the proof ends too early");
    std::string found = text_.substr(place_, end - place_);
    place_ = end + 1;
    ++line_;
    return found;
  }
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
      refuse("'" + text + "' is no number");
    return value;
  }
  void expect_end(const std::string& rest) const {
    if (!rest.empty()) refuse("the line end is expected, not '" + rest + "'");
  }
  void add_name(const std::string& name, graph::Node node) {
    if (!graph::may_be_name(name) || names_.find(name)) refuse("'" + name + "' is no new name");
    names_.add(name);
    nodes_.push_back(node);
  }
  graph::Node named(const std::string& name) const {
    const auto position = names_.find(name);
    if (!position) refuse("'" + name + "' is not known");
    return nodes_[*position];
  }
  graph::Node formula(const std::string& text) {
    try {
      return graph::read_formula(graph_, text, names_, nodes_);
    } catch (const std::invalid_argument& reason) {
      refuse(reason.what());
    }
  }

  void read_head() {
    if (line() != "pkmopt proof 1") refuse("'pkmopt proof 1' is expected");
    std::vector<graph::Node> roots;
    bool has_volume = false;
    for (std::string rest = line(); rest != "boxes"; rest = line()) {
      if (rest.starts_with('#')) continue;
      const std::string kind = word(rest);
      if (kind == "volume" && !has_volume) {
        lower_ = real(rest);
        upper_ = real(rest);
        expect_end(rest);
        has_volume = true;
      } else if (kind == "axis" && ranges_.size() < kMostAxes && inputs_.empty() && roots.empty()) {
        add_name(word(rest), graph_.input(ranges_.size()));
        const double from = real(rest), to = real(rest);
        expect_end(rest);
        if (!(from < to)) refuse("the range is empty");
        // Heights are from + (to - from) * share, so that they are finite and between both, too.
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
        const graph::Node angle = named(word(rest));
        expect_end(rest);
        add_name(name, graph_.apply(graph::turn(), std::array{angle}));
      } else if (kind == "condition" && roots.size() < kMostConditions) {
        roots.push_back(named(word(rest)));
      } else {
        refuse("'" + kind + "' is not expected here");
      }
    }
    if (!has_volume || ranges_.empty() || roots.empty()) refuse("volume, axes and conditions are expected");
    // A number that overflowed stands for a real number, which nothing is known about.
    for (const graph::Node node : graph_.reachable(roots))
      if (graph_[node].is_number() && !std::isfinite(graph_[node].number))
        refuse("a formula of numbers alone has no finite value");
    for (const graph::Node root : roots) conditions_.emplace_back(graph_, root);
  }

  /// Of the steps of a box.
  char letter() {
    if (place_ >= text_.size()) refuse("the proof ends too early");
    return text_[place_++];
  }
  std::int64_t whole(std::int64_t from, std::int64_t to, char end = ' ') {
    std::int64_t value = 0;
    const char *const first = text_.data() + place_, *const last = text_.data() + text_.size();
    const auto [behind, error] = std::from_chars(first, last, value);
    if (error != std::errc{} || behind == last || *behind != end) refuse("a whole number is expected");
    if (value < from || value > to) refuse(std::to_string(value) + " is out of range");
    place_ += static_cast<std::size_t>(behind - first) + 1;
    return value;
  }
  std::size_t open_condition(const Segment& segment) {
    const auto k = static_cast<std::size_t>(whole(0, static_cast<std::int64_t>(conditions_.size()) - 1));
    if (!segment.open[k]) refuse("condition " + std::to_string(k) + " is not open");
    return k;
  }

  using Sides = std::vector<std::array<double, 2>>;

  double height(std::int64_t step) const {
    const auto& [from, to] = ranges_.back();
    return step == kSteps ? to : from + (to - from) * (static_cast<double>(step) / static_cast<double>(kSteps));
  }
  Interval length(const Segment& segment) const {
    return Interval(height(segment.to)) - Interval(height(segment.from));
  }

  struct Root {
    bool rises;
    Interval zone, mean;
  };
  /// Where a condition that rises or falls all over the box has its root, by the mean value theorem.
  Root root_of(std::size_t k, std::int64_t guess) {
    const std::size_t z = ranges_.size() - 1;
    Jet jet;
    const auto known = conditions_[k].slope(inputs_, z + 1, jet);
    if (known == Evaluation::Known::nothing || jet.by[z].holds(0))
      refuse("condition " + std::to_string(k) + " does not rise or fall for certain");
    const std::vector<Interval> box = inputs_;
    inputs_[z] = Interval(height(guess));
    if (known == Evaluation::Known::along_last) {  // over every place of the box by itself
      const Interval zone = inputs_[z] - conditions_[k].value(inputs_) / jet.by[z];
      inputs_ = box;
      return {jet.by[z].lower > 0, zone, zone};
    }
    for (std::size_t axis = 0; axis < z; ++axis) inputs_[axis] = Interval(box[axis].middle());
    const std::vector<Interval> centre = inputs_;
    const Interval over_centre = centre[z] - conditions_[k].value(inputs_) / jet.by[z];
    Interval away(0.0), spread(0.0);
    for (std::size_t axis = 0; axis < z; ++axis) {
      const Interval gradient = jet.by[axis] / jet.by[z];
      const Interval low(box[axis].lower), high(box[axis].upper), half(0.5);
      const Interval off = (low + high) * half - centre[axis];
      const Interval wide = (Interval(gradient.upper) - Interval(gradient.lower)) * half;
      away = away + gradient * (box[axis] - centre[axis]);
      spread = spread + wide * (high - low) * Interval(0.25) + magnitude(gradient) * magnitude(off);
    }
    inputs_ = box;
    return {jet.by[z].lower > 0, over_centre - away, over_centre + Interval(-spread.upper, spread.upper)};
  }

  /// The steps of one box, and those of the boxes that it is halved into.
  void check_box(const Sides& sides, std::vector<Segment> segments, Interval inside, std::size_t depth) {
    if (depth > 200) refuse("the boxes are halved too often");
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
      if (letter() != '\n') refuse("a line end is expected");
      ++line_;
      ++boxes_;
      const Interval volume = area * (inside + open_length);
      total_ += Interval(std::max(volume.lower, 0.0), volume.upper);
      return;
    }
    if (kind != '/') refuse("'.' or '/' is expected");
    if (sides.size() < 2) refuse("there is no side to halve");
    const auto axis = static_cast<std::size_t>(whole(0, static_cast<std::int64_t>(sides.size()) - 2, '\n'));
    ++line_;
    const auto [from, to] = sides[axis];
    const double middle = 0.5 * (from + to);
    if (!(from < middle && middle < to)) refuse("the box cannot be halved");
    for (const auto& half : {std::array{from, middle}, std::array{middle, to}}) {
      Sides halved = sides;
      halved[axis] = half;
      check_box(halved, open, inside, depth + 1);
    }
  }

  static std::vector<Segment> merged(const std::vector<Segment>& segments) {
    std::vector<Segment> all;
    for (const Segment& segment : segments)
      if (!all.empty() && all.back().to == segment.from && all.back().open == segment.open)
        all.back().to = segment.to;
      else
        all.push_back(segment);
    return all;
  }

  void check_segment(Segment segment, std::vector<Segment>& left, std::vector<Segment>& open, Interval& inside,
                     Interval& open_length) {
    const auto push = [&left](std::int64_t from, std::int64_t to, const std::bitset<kMostConditions>& conditions) {
      if (from < to) left.push_back({from, to, conditions});
    };
    const std::size_t z = ranges_.size() - 1;
    inputs_[z] = {height(segment.from), height(segment.to)};
    while (segment.open.any()) {
      const char kind = letter();
      if (kind == 'h' || kind == 'x') {
        const std::size_t k = open_condition(segment);
        const Interval value = conditions_[k].value(inputs_);
        if (!(kind == 'h' ? value.surely_holds() : value.surely_fails()))
          refuse("condition " + std::to_string(k) + " does not certainly " + (kind == 'h' ? "hold" : "fail"));
        if (kind == 'x') return;
        segment.open.reset(k);
      } else if (kind == 't') {
        const std::size_t k = open_condition(segment);
        const std::int64_t low = whole(segment.from, segment.to), high = whole(low, segment.to);
        const Root root = root_of(k, whole(segment.from, segment.to));
        if ((low > segment.from && !(root.zone.lower >= height(low))) ||
            (high < segment.to && !(root.zone.upper <= height(high))) || root.zone.is_empty())
          refuse("the root of condition " + std::to_string(k) + " may lie outside");
        auto others = segment.open;
        others.reset(k);
        if (root.rises) push(high, segment.to, others);
        push(low, high, segment.open);
        if (!root.rises) push(segment.from, low, others);
        return;
      } else if (kind == 's') {
        const std::int64_t low = whole(segment.from, segment.to), high = whole(low, segment.to);
        for (const auto& [from, to] : {std::pair(high, segment.to), {low, high}, {segment.from, low}})
          push(from, to, segment.open);
        return;
      } else if (kind == 'n' || kind == 'r') {
        Interval share(0, length(segment).upper);
        if (kind == 'r') share = share_of_root(segment, share);
        open_length += share;
        open.push_back(segment);
        return;
      } else {
        refuse(std::string("'") + kind + "' is no step");
      }
    }
    inside += length(segment);
  }

  Interval share_of_root(const Segment& segment, const Interval& whole_share) {
    if (segment.open.count() != 1) refuse("more than one condition is open");
    std::size_t k = 0;
    while (!segment.open[k]) ++k;
    const Root root = root_of(k, whole(segment.from, segment.to));
    const Interval from(height(segment.from)), to(height(segment.to));
    if (!(root.zone.lower >= from.lower && root.zone.upper <= to.upper)) refuse("the root may lie outside");
    return intersection(root.rises ? to - root.mean : root.mean - from, whole_share);
  }

  const std::string text_;
  std::size_t place_ = 0, line_ = 0, boxes_ = 0;
  double lower_ = 0, upper_ = 0;
  graph::Graph graph_;
  graph::Names names_;
  std::vector<graph::Node> nodes_;
  std::vector<Interval> inputs_;  ///< of the graph: axes, then what is given
  Sides ranges_;
  std::vector<Evaluation> conditions_;
  Interval total_{0.0};
};

/// All of a file; throws std::system_error where it cannot be read.
std::string text_of(const char* path) {
  const auto fail = [] { throw std::system_error(errno, std::generic_category()); };
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path, "rb"), std::fclose);
  if (!file) fail();
  std::string text;
  char buffer[1 << 16];
  while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, file.get())) text.append(buffer, count);
  if (std::ferror(file.get())) fail();
  return text;
}

constexpr const char* kUsage = "usage: pkmopt-check-proof FILE\n";
constexpr const char* kHelp =
    "\nCheck a proof that 'pkmopt certify --proof FILE' wrote.\n"
    "\n"
    "  --help      Print this text\n"
    "  --version   Print the version\n"
    "\n"
    "Exit code: 0 accepted, 1 refused, 2 not checked (no such file, out of memory, output not written, ..).\n";

/// Writes to stdout. @return the exit code: 2 where it cannot be written
int print(const std::string& text) {
  std::cout << text << std::flush;
  if (std::cout) return 0;
  std::cerr << "not checked: the output cannot be written\n";
  return 2;
}

int check(int count, char** words) {
  const std::string word = count == 2 ? words[1] : "";
  if (word == "--help" || word == "-h") return print(std::string(kUsage) + kHelp);
  if (word == "--version") return print("pkmopt-check-proof " PKM_CHECKER_VERSION "\n");
  if (word.empty() || word.starts_with('-')) {
    std::cerr << kUsage;
    return 2;
  }
  try {
    return print(Check(text_of(words[1])).run());
  } catch (const Refusal& reason) {
    std::cerr << "refused: " << reason.what() << '\n';
    return 1;
  } catch (const std::bad_alloc&) {
    std::cerr << "not checked: out of memory\n";
  } catch (const std::system_error& reason) {
    std::cerr << "not checked: " << words[1] << ": " << reason.code().message() << '\n';
  } catch (const std::exception& reason) {
    std::cerr << "not checked: internal error: " << reason.what() << '\n';
  }
  return 2;
}

}  // namespace
}  // namespace pkm::checker

int main(int count, char** words) { return pkm::checker::check(count, words); }
