#include "engine/workspace/bounds/proof.hpp"

#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <unordered_map>
#include <unordered_set>

namespace pkm::bounds {
namespace {

using expression::Entry, expression::Node;

constexpr std::size_t kMaxBytes = 100'000'000;

/// The shortest decimal text that is read back as the same double. Throws std::runtime_error if it is not finite.
std::string text_of(double number) {
  if (!std::isfinite(number))
    throw std::runtime_error(
        "there is no proof: a number in it would not be finite, and pkmopt-check-proof rejects such numbers");
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

/// Writes the expression graph as a list of definitions, each of which uses earlier names only.
class Formulas {
 public:
  Formulas(const Statement& statement, std::ostream& to) : statement_(statement), to_(to) {
    std::vector<Node> roots;
    for (std::size_t k = 0; k < statement.constraints.size(); ++k) roots.push_back(statement.constraints.node(k));
    const std::vector<Node> used = statement.graph.reachable(roots);
    for (const Node node : used) {
      const Entry& entry = statement.graph[node];
      if (entry.solution)
        throw std::runtime_error(
            "there is no proof: the constraints depend on unknowns of [[solve]], for which pkmopt-check-proof has no "
            "rules");
      for (const Node operand : entry.operands()) ++uses_[operand];
      if (entry.operation == &expression::angle_wrapping()) named_.insert(entry.arguments[0]);
    }
    named_.insert(roots.begin(), roots.end());
    for (const Node node : used) write(node);
  }

  const std::string& name(Node node) const { return names_.at(node); }

 private:
  void write(Node node) {
    const Entry& entry = statement_.graph[node];
    if (entry.is_number()) {
      names_[node] = entry.number < 0 ? "(" + text_of(entry.number) + ")" : text_of(entry.number);
      if (named_.contains(node)) write_definition(node, names_[node]);
    } else if (entry.input >= 0) {
      write_input(node, static_cast<std::size_t>(entry.input));
    } else if (entry.operation == &expression::angle_wrapping()) {
      const std::string name = next_name();
      to_ << "turn " << name << ' ' << names_.at(entry.arguments[0]) << '\n';
      names_[node] = name;
    } else {
      // For readability, a short formula that is used once is inserted where it is used.
      constexpr std::size_t kMaxInserted = 120;  // maximum length of an inserted formula in characters
      const std::string text = formula(entry);
      if (uses_[node] == 1 && text.size() <= kMaxInserted && !named_.contains(node))
        names_[node] = text;
      else
        write_definition(node, text);
    }
  }
  std::string next_name() { return "n" + std::to_string(++count_); }
  void write_definition(Node node, const std::string& text) {
    names_[node] = next_name();
    to_ << "let " << names_[node] << " = " << text << '\n';
  }
  void write_input(Node node, std::size_t position) {
    for (std::size_t axis = 0; axis < statement_.axes.size(); ++axis)
      if (statement_.positions[axis] == position) {
        names_[node] = statement_.axes[axis];
        return;
      }
    names_[node] = "i" + std::to_string(position);
    const Interval& value = statement_.inputs[position];
    to_ << "given " << names_[node] << ' ' << text_of(value.lower) << ' ' << text_of(value.upper) << ' '
        << statement_.input_names[position] << '\n';
  }
  std::string formula(const Entry& entry) const {
    const auto at = [&](std::size_t i) { return names_.at(entry.arguments[i]); };
    if (entry.operation == &expression::choice()) return "(" + at(0) + " ? " + at(1) + " : " + at(2) + ")";
    if (entry.operation == &expression::negation()) return "(-" + at(0) + ")";
    const std::string& name = entry.operation->name;
    if (entry.operation->rank > 0) return "(" + at(0) + " " + name + " " + at(1) + ")";
    std::string text = name + "(" + at(0);
    for (std::size_t i = 1; i < entry.count; ++i) text += ", " + at(i);
    return text + ")";
  }

  const Statement& statement_;
  std::ostream& to_;
  std::unordered_map<Node, std::string> names_;  ///< name or text by which a node is referred to
  std::unordered_map<Node, int> uses_;
  std::unordered_set<Node> named_;  ///< nodes with a name: constraints, and arguments of angle wrapping
  std::size_t count_ = 0;
};

}  // namespace

std::string proof_text(const Statement& statement, const VolumeBounds& bounds, const ProofTree& tree) {
  if (tree.bytes() > kMaxBytes)
    throw std::runtime_error("the proof has " + std::to_string(tree.bytes() / 1'000'000) +
                             " MB; at most 100 MB are supported: increase the gap");
  // Subtract or add more than the rounding errors of a checker that adds the volumes of the boxes in another order.
  const double slack = (1e-12 + 1e-15 * static_cast<double>(bounds.boxes)) * bounds.upper;
  std::ostringstream to;
  to << "pkmopt proof 1\n# " << statement.title << "\nvolume " << text_of(std::max(0.0, bounds.lower - slack)) << ' '
     << text_of(bounds.upper + slack) << '\n';
  for (std::size_t axis = 0; axis < statement.axes.size(); ++axis)
    to << "axis " << statement.axes[axis] << ' ' << text_of(statement.ranges[axis][0]) << ' '
       << text_of(statement.ranges[axis][1]) << '\n';
  const Formulas formulas(statement, to);
  for (std::size_t k = 0; k < statement.constraints.size(); ++k)
    to << "condition " << formulas.name(statement.constraints.node(k)) << ' ' << statement.constraints.name(k) << '\n';
  to << "boxes\n";
  std::string text = std::move(to).str();
  text.reserve(text.size() + tree.bytes() + 4);
  tree.append_to(text);
  return text += "end\n";
}

}  // namespace pkm::bounds
