// Interval evaluation and interval automatic differentiation (forward mode) of formulas, for the proof checker. The
// differentiation rules are its own: it shares only the formula parser and the interval type with pkmopt.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "engine/expression/graph.hpp"
#include "engine/math/interval.hpp"

namespace pkm::checker {

inline constexpr std::size_t kMaxAxes = 3;

/// Enclosures of a value and of its partial derivatives by the axes.
struct Jet {
  Interval value{0.0};
  std::array<Interval, kMaxAxes> by{Interval(0.0), Interval(0.0), Interval(0.0)};
};

/// True if an interval is exactly this number and defined everywhere. times(), plus(), minus() and over() simplify
/// operations with exact 0 and 1, which keeps enclosures of derivatives tight.
inline bool is(const Interval& x, double number) { return x.lower == number && x.upper == number && x.is_defined(); }
inline Interval times(const Interval& x, const Interval& y) {
  if (is(x, 0) || is(y, 0)) return Interval(0.0);
  return is(x, 1) ? y : is(y, 1) ? x : x * y;
}
inline Interval plus(const Interval& x, const Interval& y) { return is(x, 0) ? y : is(y, 0) ? x : x + y; }
inline Interval minus(const Interval& x, const Interval& y) { return is(y, 0) ? x : is(x, 0) ? -y : x - y; }
inline Interval over(const Interval& x, const Interval& y) { return is(x, 0) ? x : x / y; }

/// Value of an operation for the arguments x, y, z, and its derivative by the chain rule: dx, dy are the derivatives of
/// the arguments, f is the value.
struct Rule {
  std::function<Interval(const Interval& x, const Interval& y, const Interval& z)> value;
  std::function<Interval(const Interval& f, const Interval& x, const Interval& y, const Interval& dx,
                         const Interval& dy)>
      derivative;
};

inline const std::map<std::string, Rule>& rules() {
  using I = const Interval&;
  const Interval one(1.0);
  const auto zero = [](I, I, I, I, I) { return Interval(0.0); };
  static const std::map<std::string, Rule> all = {
      {"+", {[](I x, I y, I) { return x + y; }, [](I, I, I, I dx, I dy) { return plus(dx, dy); }}},
      {"-", {[](I x, I y, I) { return x - y; }, [](I, I, I, I dx, I dy) { return minus(dx, dy); }}},
      {"*",
       {[](I x, I y, I) { return x * y; }, [](I, I x, I y, I dx, I dy) { return plus(times(dx, y), times(x, dy)); }}},
      {"/",
       {[](I x, I y, I) { return x / y; }, [](I f, I, I y, I dx, I dy) { return over(minus(dx, times(f, dy)), y); }}},
      {"^",
       {[](I x, I y, I) { return pow(x, y); },
        [one](I f, I x, I y, I dx, I dy) {
          const Interval by_base = is(dx, 0) ? dx : times(times(y, pow(x, minus(y, one))), dx);
          return plus(by_base, is(dy, 0) ? dy : times(f, times(dy, log(x))));
        }}},
      {"negative", {[](I x, I, I) { return -x; }, [](I, I, I, I dx, I) { return -dx; }}},
      {"sqrt",
       {[](I x, I, I) { return sqrt(x); }, [](I f, I, I, I dx, I) { return over(dx, times(f, Interval(2.0))); }}},
      {"abs",
       {[](I x, I, I) { return magnitude(x); },
        // x or -x on the whole box, even if it is 0 at an end
        [](I, I x, I, I dx, I) { return x.lower >= 0   ? dx
                                        : x.upper <= 0 ? -dx
                                                       : times(sign(x), dx); }}},
      {"sign", {[](I x, I, I) { return sign(x); }, zero}},
      {"min",
       {[](I x, I y, I) { return min(x, y); },
        [](I, I x, I y, I dx, I dy) { return choose(less_or_equal(x, y), dx, dy); }}},
      {"max",
       {[](I x, I y, I) { return max(x, y); },
        [](I, I x, I y, I dx, I dy) { return choose(less_or_equal(y, x), dx, dy); }}},
      {"sin", {[](I x, I, I) { return sin(x); }, [](I, I x, I, I dx, I) { return times(cos(x), dx); }}},
      {"cos", {[](I x, I, I) { return cos(x); }, [](I, I x, I, I dx, I) { return -times(sin(x), dx); }}},
      {"tan", {[](I x, I, I) { return tan(x); }, [one](I f, I, I, I dx, I) { return times(square(f) + one, dx); }}},
      {"asin",
       {[](I x, I, I) { return asin(x); }, [one](I, I x, I, I dx, I) { return over(dx, sqrt(one - square(x))); }}},
      {"acos",
       {[](I x, I, I) { return acos(x); }, [one](I, I x, I, I dx, I) { return -over(dx, sqrt(one - square(x))); }}},
      {"atan", {[](I x, I, I) { return atan(x); }, [one](I, I x, I, I dx, I) { return over(dx, square(x) + one); }}},
      {"atan2",
       {[](I x, I y, I) { return atan2(x, y); },
        [](I, I x, I y, I dx, I dy) { return over(minus(times(y, dx), times(x, dy)), square(x) + square(y)); }}},
      {"sinh", {[](I x, I, I) { return sinh(x); }, [](I, I x, I, I dx, I) { return times(cosh(x), dx); }}},
      {"cosh", {[](I x, I, I) { return cosh(x); }, [](I, I x, I, I dx, I) { return times(sinh(x), dx); }}},
      {"tanh", {[](I x, I, I) { return tanh(x); }, [one](I f, I, I, I dx, I) { return times(one - square(f), dx); }}},
      {"exp", {[](I x, I, I) { return exp(x); }, [](I f, I, I, I dx, I) { return times(f, dx); }}},
      {"log", {[](I x, I, I) { return log(x); }, [](I, I x, I, I dx, I) { return over(dx, x); }}},
      {"log10",
       {[](I x, I, I) { return log10(x); },
        [](I, I x, I, I dx, I) { return over(dx, times(x, log(Interval(10.0)))); }}},
      {"turn", {[](I x, I, I) { return wrapped(x); }, [](I, I, I, I dx, I) { return dx; }}},
      {"<", {[](I x, I y, I) { return less(x, y); }, zero}},
      {"<=", {[](I x, I y, I) { return less_or_equal(x, y); }, zero}},
      {">", {[](I x, I y, I) { return less(y, x); }, zero}},
      {">=", {[](I x, I y, I) { return less_or_equal(y, x); }, zero}},
      {"==", {[](I x, I y, I) { return equal(x, y); }, zero}},
      {"!=", {[](I x, I y, I) { return Interval(1.0) - equal(x, y); }, zero}},
      {"||", {[](I x, I y, I) { return max(truth(x), truth(y)); }, zero}},
      {"&&", {[](I x, I y, I) { return min(truth(x), truth(y)); }, zero}},
      {"?", {[](I x, I y, I z) { return choose(x, y, z); }, zero}},  // Evaluation differentiates its branches
  };
  return all;
}

/// A formula compiled to steps in topological order.
class Evaluation {
 public:
  Evaluation(const expression::Graph& graph, expression::Node root) {
    std::map<expression::Node, std::size_t> indices;
    for (const expression::Node node : graph.reachable({&root, 1})) {
      const expression::Entry& entry = graph[node];
      Step step{.input = entry.input, .number = entry.number};
      for (const expression::Node operand : entry.operands()) step.from[step.count++] = indices.at(operand);
      if (entry.operation) {
        const bool negative = entry.operation == &expression::negation();
        step.rule = &rules().at(negative ? "negative" : entry.operation->name);
        step.is_choice = entry.operation == &expression::choice();
        step.is_square = entry.operation->name == "*" && step.from[0] == step.from[1];
      }
      indices.emplace(node, steps_.size());
      steps_.push_back(step);
    }
    jets_.resize(steps_.size());
  }

  /// Enclosure of the value. @param inputs  of the graph, the axes first
  Interval value(const std::vector<Interval>& inputs) {
    for (std::size_t i = 0; i < steps_.size(); ++i) jets_[i].value = value_of(steps_[i], inputs);
    return jets_.back().value;
  }
  /// Which partial derivatives are proven to exist on the whole box: none, only that by the last axis, or all.
  enum class Known { nothing, along_last, all };
  /// Encloses value and derivatives by the first `axes` inputs. @return which derivatives in `jet` are valid
  Known differentiate(const std::vector<Interval>& inputs, std::size_t axes, Jet& jet) {
    value(inputs);
    for (std::size_t i = 0; i < steps_.size(); ++i)
      for (std::size_t axis = 0; axis < axes; ++axis) jets_[i].by[axis] = derivative_of(i, axis);
    jet = jets_.back();
    const auto is_known = [&jet](std::size_t axis) { return jet.by[axis].is_defined() && !jet.by[axis].is_empty(); };
    if (!jet.value.is_continuous() || !is_known(axes - 1)) return Known::nothing;
    for (std::size_t axis = 0; axis + 1 < axes; ++axis)
      if (!is_known(axis)) return Known::along_last;
    return Known::all;
  }

 private:
  struct Step {
    std::int32_t input = -1;
    double number = 0;
    const Rule* rule = nullptr;
    std::array<std::size_t, 3> from{};
    std::size_t count = 0;
    bool is_choice = false, is_square = false;
  };

  Interval value_of(const Step& step, const std::vector<Interval>& inputs) const {
    if (!step.rule) return step.input < 0 ? Interval(step.number) : inputs[static_cast<std::size_t>(step.input)];
    const Interval& x = jets_[step.from[0]].value;
    return step.is_square ? square(x) : step.rule->value(x, jets_[step.from[1]].value, jets_[step.from[2]].value);
  }
  /// Derivative of step i by an axis, from those of its arguments.
  Interval derivative_of(std::size_t i, std::size_t axis) const {
    const Step& step = steps_[i];
    if (!step.rule) return Interval(step.input == static_cast<std::int32_t>(axis) ? 1.0 : 0.0);
    const Jet &x = jets_[step.from[0]], &y = jets_[step.from[1]], &z = jets_[step.from[2]];
    bool is_constant = true;
    for (std::size_t k = 0; k < step.count; ++k) is_constant = is_constant && is(jets_[step.from[k]].by[axis], 0);
    if (is_constant) return Interval(0.0);
    if (step.is_choice) return choose(x.value, y.by[axis], z.by[axis]);
    const Interval dy = step.count > 1 ? y.by[axis] : Interval(0.0);
    return step.rule->derivative(jets_[i].value, x.value, y.value, x.by[axis], dy);
  }

  std::vector<Step> steps_;
  std::vector<Jet> jets_;
};

}  // namespace pkm::checker
